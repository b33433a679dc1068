// Two small bodies in any motion: the search ends at its limit, and nothing that it proves apart
// crosses at a time in between.
#include "build/tree_build.hpp"
#include "bytes.hpp"
#include "in_motion/contact_sweep.hpp"
#include "primitives/predicates.hpp"

#include <array>
#include <memory>
#include <numbers>

namespace {

using fuzz::require;

constexpr std::uint64_t kMostPops = 1500;
constexpr int kSamples = 24;
using Point = std::array<long double, 3>;
using Surface = std::vector<std::array<Point, 3>>;

struct Body {
    std::vector<obb::Vec3> vertices;
    std::vector<obb::Corners> corners;
    std::unique_ptr<obb::TreeBuilder> tree;
    obb::Pose pose;
    obb::Screw screw;

    Body(fuzz::Bytes& bytes, std::uint32_t kind) {
        const std::uint32_t count = 1 + bytes.below(6);
        for (std::uint32_t i = 0; i < count; ++i) {
            corners.push_back({3 * i, 3 * i + 1, 3 * i + 2});
            for (int k = 0; k < 3; ++k) {
                vertices.push_back(kind == 0 ? bytes.moderate_point() : bytes.point(kind == 1));
            }
        }
        const auto shape = bytes.take<std::uint8_t>();
        const obb::BuildOptions options{static_cast<obb::Fit>(shape % 3),
                                        static_cast<obb::Split>(shape / 4 % 3),
                                        1U + shape / 16 % 3};
        tree = std::make_unique<obb::TreeBuilder>(vertices, corners, options, false, 1U);
        while (!tree->advance(1000)) {
        }
        pose = (shape & 64) != 0 ? obb::Pose{} : bytes.pose();
        screw = (shape & 128) != 0 ? obb::Screw{} : bytes.screw();
    }

    [[nodiscard]] obb::Triangle placed(std::size_t row) const {
        const obb::Corners& c = corners[row];
        const obb::Triangle t{vertices[c[0]], vertices[c[1]], vertices[c[2]]};
        return pose.is_identity() ? t : obb::posed(pose, t);
    }
};

Point minus(const Point& p, const Point& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }
Point crossed(const Point& p, const Point& q) {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
long double dotted(const Point& p, const Point& q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

// x(t) = K + t V + R(t W) (x(0) - K), by the formula of Rodrigues.
Point moved(const obb::Screw& screw, const obb::Vec3& at, long double time) {
    const Point w{screw.angular_velocity.x, screw.angular_velocity.y, screw.angular_velocity.z};
    const long double speed = std::sqrt(dotted(w, w));
    Point y;
    for (std::size_t k = 0; k < 3; ++k) {
        y[k] = static_cast<long double>(at[k]) - screw.pivot[k];
    }
    if (speed > 0) {
        const Point axis{w[0] / speed, w[1] / speed, w[2] / speed};
        const long double c = std::cos(speed * time), s = std::sin(speed * time);
        const Point across = crossed(axis, y);
        const long double along = dotted(axis, y) * (1 - c);
        for (std::size_t k = 0; k < 3; ++k) {
            y[k] = c * y[k] + s * across[k] + along * axis[k];
        }
    }
    for (std::size_t k = 0; k < 3; ++k) {
        y[k] += screw.pivot[k] + time * screw.linear_velocity[k];
    }
    return y;
}

Surface at(const Body& body, long double time) {
    Surface surface;
    for (std::size_t i = 0; i < body.corners.size(); ++i) {
        const obb::Triangle t = body.placed(i);
        surface.push_back({moved(body.screw, t[0], time), moved(body.screw, t[1], time),
                           moved(body.screw, t[2], time)});
    }
    return surface;
}

// Whether the edge from p to q surely goes through the triangle, whatever was rounded.
bool pierces(const Point& p, const Point& q, const std::array<Point, 3>& t, long double margin) {
    const auto volume = [](const Point& a, const Point& b, const Point& c, const Point& d) {
        return dotted(crossed(minus(b, a), minus(c, a)), minus(d, a));
    };
    const long double above = volume(t[0], t[1], t[2], p), below = volume(t[0], t[1], t[2], q);
    if (!((above > margin && below < -margin) || (above < -margin && below > margin))) {
        return false;
    }
    const long double x = volume(p, q, t[0], t[1]), y = volume(p, q, t[1], t[2]),
                      z = volume(p, q, t[2], t[0]);
    return (x > margin && y > margin && z > margin) || (x < -margin && y < -margin && z < -margin);
}

bool surely_cross(const Body& a, const Body& b, long double time) {
    const Surface here = at(a, time), there = at(b, time);
    long double reach = 0, turned = 1;
    for (const Surface* surface : {&here, &there}) {
        for (const auto& triangle : *surface) {
            for (const Point& p : triangle) {
                reach = std::max({reach, std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
            }
        }
    }
    for (const Body* body : {&a, &b}) {
        const obb::Screw& s = body->screw;
        reach = std::max<long double>(reach, obb::norm_inf(s.pivot) +
                                                 time * obb::norm_inf(s.linear_velocity));
        turned += time * obb::norm_1(s.angular_velocity);
    }
    const long double margin = 1e-16L * turned * reach * reach * reach;
    for (const auto& s : here) {
        for (const auto& t : there) {
            for (std::size_t k = 0; k < 3; ++k) {
                if (pierces(s[k], s[(k + 1) % 3], t, margin) ||
                    pierces(t[k], t[(k + 1) % 3], s, margin)) {
                    return true;
                }
            }
        }
    }
    return false;
}

obb::SweepAnswer ask(const Body& a, const Body& b, double duration, const obb::Limits& limits) {
    const obb::Placement placement{a.pose, b.pose};
    const obb::SweepQuestion question{a.screw, b.screw, duration, 1e-9 * duration};
    const obb::TreeView tree_a = a.tree->view(), tree_b = b.tree->view();
    obb::SweepRow row(tree_a, tree_b, placement, question, limits, nullptr);
    while (!row.advance()) {
    }
    require(row.answer().counts.pops <= limits.max_pops, "a question ends at its limit");
    return row.answer();
}

// Until when they are proven apart; negative where nothing is said.
double apart_until(const obb::SweepAnswer& answer, double duration) {
    switch (answer.status) {
    case obb::SweepStatus::kSeparated:
        return std::numeric_limits<double>::infinity();
    case obb::SweepStatus::kContact:
    case obb::SweepStatus::kUnresolved:
        require(answer.low >= 0 && answer.low <= duration, "a bound lies within the duration");
        return answer.low;
    default:
        return -1;
    }
}

bool is_proven(const obb::SweepAnswer& answer) {
    return answer.status == obb::SweepStatus::kTrianglesAtStart ||
           (answer.status == obb::SweepStatus::kContact &&
            answer.evidence == obb::Evidence::kIntersecting);
}

void check_answer(const Body& a, const Body& b, double duration, const obb::SweepAnswer& answer) {
    if (answer.status == obb::SweepStatus::kTrianglesAtStart) {
        require(obb::triangles_intersect(a.placed(static_cast<std::size_t>(answer.triangle_a)),
                                         b.placed(static_cast<std::size_t>(answer.triangle_b))),
                "the triangles named meet at the start");
    }
    const double apart = apart_until(answer, duration);
    for (int k = 0; k <= kSamples; ++k) {
        const long double time = duration * static_cast<long double>(k) / kSamples;
        if (time >= apart || time > duration) {
            break;
        }
        require(!surely_cross(a, b, time), "nothing crosses while proven apart");
    }
}

// Every pair's own contact, in order; on a common screw where `is_screw` asks for that at once.
void check_each(const Body& a, const Body& b, double duration, bool is_screw) {
    obb::ContactQueryOptions options;
    if (is_screw) {
        options.box_tests_before_screw = 0;
    }
    options.duration = duration;
    options.time_tolerance = 1e-9 * duration;
    options.each_pair = true;
    const obb::TreeView tree_a = a.tree->view(), tree_b = b.tree->view();
    obb::ContactQuery query(tree_a, a.pose, a.screw, tree_b, b.pose, b.screw, options);
    std::size_t count = 0;
    double last = 0;
    for (bool is_done = false; !is_done && query.counts().pops < kMostPops;) {
        is_done = query.advance(kMostPops - query.counts().pops);
        while (const auto contact = query.take()) {
            require(contact->low >= last, "contacts come in order of time");
            require(contact->low <= contact->high && contact->high <= duration,
                    "a contact's bracket lies within the duration");
            if (contact->high > 0) { // of those at the start, another question tells the place
                static_cast<void>(query.place(*contact));
            }
            last = contact->low;
            ++count;
        }
    }
    require(count <= a.corners.size() * b.corners.size(), "a pair has one first contact");
}

// Bodies on one screw, as seen from each other: the first contact by images is held to the samples,
// and to what steps say.
void check_screw(const Body& a, const Body& b, double duration, const obb::Limits& limits) {
    obb::ContactQueryOptions options{
        .duration = duration, .time_tolerance = 1e-9 * duration, .limits = limits};
    std::array<std::optional<obb::Contact>, 2> found;
    std::array<double, 2> low{};
    bool are_done = true;
    for (const std::size_t way : {0, 1}) { // images, steps
        options.box_tests_before_screw = way == 0 ? 0 : ~std::uint64_t{0};
        const obb::TreeView tree_a = a.tree->view(), tree_b = b.tree->view();
        obb::ContactQuery query(tree_a, a.pose, a.screw, tree_b, b.pose, b.screw, options);
        bool is_done = false;
        while (!is_done && query.counts().pops < kMostPops) {
            is_done = query.advance(kMostPops - query.counts().pops);
        }
        are_done = are_done && is_done && !query.has_given_up();
        found[way] = query.contact();
        low[way] = query.lower_bound();
    }
    for (const std::size_t way : {0, 1}) {
        const auto& proven = found[1 - way];
        require(!proven || proven->evidence != obb::Evidence::kIntersecting ||
                    low[way] <= proven->high,
                "no way proves apart what the other proves to meet");
    }
    require(!are_done || found[0].has_value() == found[1].has_value() ||
                (found[0] ? found[0] : found[1])->evidence != obb::Evidence::kIntersecting,
            "images and steps agree");
    for (int k = 0; k <= kSamples; ++k) {
        const long double time = duration * static_cast<long double>(k) / kSamples;
        if (time >= low[0] || time > duration) {
            break;
        }
        require(!surely_cross(a, b, time), "nothing crosses while images prove it apart");
    }
}

// The same velocities, or another share of them, about the same axis.
obb::Screw along(const obb::Screw& screw, double share, double slide) {
    obb::Screw other = screw;
    other.angular_velocity = share * screw.angular_velocity;
    other.linear_velocity = slide * screw.angular_velocity;
    return other;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Bytes bytes(data, size);
    const auto kind = bytes.take<std::uint8_t>();
    const double duration =
        std::fabs((kind & 4) != 0 ? bytes.number(false) : bytes.moderate() / 16);
    obb::Limits limits{.max_pops = kMostPops};
    limits.boxes.boxes_for_leaves = (kind & 8) != 0;
    limits.clearance = (kind & 16) != 0 ? std::fabs(bytes.moderate()) / 16 : 0;
    limits.distance_tolerance = (kind & 32) != 0 ? std::fabs(bytes.moderate()) / 16 : -1;
    limits.boxes.max_depth_a = (kind & 64) != 0 ? bytes.below(4) : ~0U;
    Body a(bytes, kind % 4), b(bytes, kind % 4);
    const bool is_screw = (kind & 128) != 0;
    if (is_screw) {
        const std::array<double, 4> shares{0, 0.5, -1, 2};
        const double slide_a = bytes.moderate(), slide_b = bytes.moderate();
        a.screw = along(b.screw, shares[bytes.below(4)], slide_a);
        b.screw = along(b.screw, 1, slide_b);
    }
    try {
        const obb::SweepAnswer answer = ask(a, b, duration, limits);
        check_answer(a, b, duration, answer);
        std::swap(limits.boxes.max_depth_a, limits.boxes.max_depth_b);
        const obb::SweepAnswer swapped = ask(b, a, duration, limits);
        require(!(is_proven(answer) && swapped.status == obb::SweepStatus::kSeparated) &&
                    !(is_proven(swapped) && answer.status == obb::SweepStatus::kSeparated),
                "nobody meets whom the swapped question proves apart");
        check_each(a, b, duration, is_screw);
        if (is_screw && answer.status != obb::SweepStatus::kTrianglesAtStart &&
            answer.status != obb::SweepStatus::kOverlapAtStart) {
            check_screw(a, b, duration, limits);
        }
    } catch (const std::domain_error&) { // numbers beyond the range of double
    }
    return 0;
}
