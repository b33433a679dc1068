// Images of triangles about a screw axis: what they bound holds for points of the triangles and for
// points as near as the slack says, and where two of those meet on the screw, no bound is later.
// The truth is worked out in long double.
#include "bytes.hpp"
#include "screws/image.hpp"
#include "screws/meeting.hpp"

#include <array>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace {

using fuzz::require;
using Point = std::array<long double, 3>;

constexpr long double kPi = std::numbers::pi_v<long double>;
constexpr int kPoints = 12;
constexpr std::array<std::array<double, 2>, 6> kDirections{
    {{1, 0}, {0, 1}, {0.6, 0.8}, {0.8, -0.6}, {0.28, 0.96}, {-0.96, 0.28}}};

// Of the axis z through 0, so that nothing is rounded before the images are made.
struct Setting {
    obb::RelativeScrew screw{};
    double off = 0; // how far points may be from their triangles
};

Setting setting(fuzz::Bytes& bytes) {
    Setting s;
    obb::RelativeScrew& screw = s.screw;
    screw.axis = {0, 0, 1};
    screw.across = {1, 0, 0};
    screw.third = {0, 1, 0};
    screw.speed = 1;
    screw.sweep = std::ldexp(1.0 + bytes.take<std::uint8_t>() / 256.0,
                             static_cast<int>(bytes.below(50)) - 10);
    const auto kind = bytes.below(4);
    const double pitch = bytes.moderate();
    screw.pitch = kind == 0 ? 0 : std::ldexp(pitch, -static_cast<int>(bytes.below(24)));
    screw.lead = 2 * std::numbers::pi * screw.pitch;
    s.off = bytes.below(3) == 0 ? 0 : std::ldexp(1.0, -2 - static_cast<int>(bytes.below(44)));
    // As relative_screw() charges it for bodies that reach as far as any point here.
    const double reach = 256 + std::fabs(screw.pitch) * screw.sweep;
    screw.slack = s.off + 0x1p-44 * reach;
    screw.angle_error = 0x1p-49 * screw.sweep;
    return s;
}

// Of any shape: with the axis in one plane, on it, across it, near it, a needle, a point.
obb::Triangle triangle(fuzz::Bytes& bytes) {
    obb::Triangle t{bytes.moderate_point(), bytes.moderate_point(), bytes.moderate_point()};
    switch (bytes.below(8)) {
    case 0: // radial
        t[1] = {t[0].x * t[1].x, t[0].y * t[1].x, t[1].z};
        break;
    case 1: { // needle
        const double share = bytes.take<std::uint8_t>() / 255.0;
        const double thin = std::ldexp(1.0, -static_cast<int>(bytes.below(48)));
        t[2] = t[0] + share * (t[1] - t[0]) + thin * t[2];
        break;
    }
    case 2:
        t[0].x = t[0].y = 0;
        break;
    case 3:
        t[2] = t[bytes.below(3)];
        break;
    case 4: // small
        t[1] = t[0] + 0x1p-9 * t[1];
        t[2] = t[0] + 0x1p-9 * t[2];
        break;
    case 5: { // near the axis
        const double near = std::ldexp(1.0, -static_cast<int>(bytes.below(40)));
        for (obb::Vec3& p : t) {
            p = {near * p.x, near * p.y, p.z};
        }
        break;
    }
    default:
        break;
    }
    return t;
}

// A point of the triangle, moved by no more than `off`.
Point point_near(fuzz::Bytes& bytes, const obb::Triangle& t, double off) {
    std::array<long double, 3> weights{};
    for (long double& w : weights) {
        const auto byte = bytes.take<std::uint8_t>();
        w = byte < 64 ? 0.0L : byte / 255.0L;
    }
    const long double sum = weights[0] + weights[1] + weights[2];
    if (sum == 0) {
        weights[0] = 1;
    }
    const std::array<long double, 3> aside{bytes.take<std::int8_t>() / 128.0L,
                                           bytes.take<std::int8_t>() / 128.0L,
                                           bytes.take<std::int8_t>() / 128.0L};
    const long double length =
        std::sqrt(aside[0] * aside[0] + aside[1] * aside[1] + aside[2] * aside[2]);
    Point p{};
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) {
            p[k] += weights[i] / (sum == 0 ? 1 : sum) * t[i][k];
        }
        p[k] += length == 0 ? 0 : off * aside[k] / length;
    }
    return p;
}

bool holds(const obb::Span& span, long double value) {
    return span.low <= value && value <= span.high;
}

bool holds(const obb::Image& image, const Point& p, const obb::RelativeScrew& screw) {
    const long double r = std::sqrt(p[0] * p[0] + p[1] * p[1]);
    if (!holds(image.radius, r) || !holds(image.height, p[2])) {
        return false;
    }
    bool is_in_profile = true;
    for (const auto& [n_r, n_z] : kDirections) {
        is_in_profile = is_in_profile &&
                        holds(image.profile_along(n_r, n_z, screw.slack), n_r * r + n_z * p[2]);
    }
    if (image.is_ring || !is_in_profile) {
        return is_in_profile;
    }
    const long double angle = std::atan2(p[1], p[0]);
    const long double turns = std::round((image.angle.middle() - angle) / (2 * kPi));
    const long double turned = angle + 2 * kPi * turns;
    const long double u = p[2] - screw.pitch * turned;
    bool is_in = holds(image.angle, turned);
    for (const auto& [n_r, n_u] : kDirections) {
        is_in = is_in && holds(image.along(n_r, n_u), n_r * r + n_u * u);
    }
    return is_in;
}

std::vector<obb::Image> images_of(const obb::RelativeScrew& screw,
                                  const std::vector<obb::Triangle>& triangles) {
    const obb::ImageMaker maker(screw, triangles[0][0].z, 64);
    std::vector<obb::Image> images;
    for (std::uint32_t k = 0; k < triangles.size(); ++k) {
        const auto corner = [&](std::size_t i) {
            return obb::axial_point(screw, triangles[k][i], {0, 0, 0});
        };
        maker.add({corner(0), corner(1), corner(2)}, k, images);
    }
    return images;
}

// Where the screw takes a point, by so many radians.
Point screwed(const Point& p, long double sigma, double pitch) {
    const long double c = std::cos(sigma), s = std::sin(sigma);
    return {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2] + pitch * sigma};
}

// The first time that two trees allow, each node's bound being no earlier than its parent's.
double first_time(const obb::RelativeScrew& screw, obb::ImageTree& a, obb::ImageTree& b,
                  std::uint32_t at_a, std::uint32_t at_b, double sigma, double& best) {
    const obb::ImageNode node_a = a.node(at_a), node_b = b.node(at_b);
    sigma = obb::first_meeting(screw, node_a, node_b, sigma);
    if (sigma >= best) {
        return best;
    }
    if (node_a.is_image() && node_b.is_image()) {
        best = std::min(
            best, obb::first_meeting(screw, a.image(node_a.begin), b.image(node_b.begin), sigma));
        return best;
    }
    const bool opens_a = node_b.is_image() || (!node_a.is_image() && node_a.size >= node_b.size);
    const std::uint32_t first = opens_a ? a.split(at_a) : b.split(at_b);
    for (std::uint32_t k = 0; k < 2; ++k) {
        first_time(screw, a, b, opens_a ? first + k : at_a, opens_a ? at_b : first + k, sigma,
                   best);
    }
    return best;
}

// B's last triangle is put where a point of it meets one of A's after a turn by sigma.
void check_meeting(fuzz::Bytes& bytes, const Setting& s, std::vector<obb::Triangle> a,
                   std::vector<obb::Triangle> b) {
    const double sigma = s.screw.sweep * (bytes.take<std::uint16_t>() / 65535.0);
    const Point met = point_near(bytes, a.back(), s.off);
    const Point start = screwed(met, -static_cast<long double>(sigma), s.screw.pitch);
    if (std::fabs(start[2]) > std::fabs(met[2]) + std::fabs(s.screw.pitch) * s.screw.sweep + 1) {
        return;
    }
    // Shifted so that its first corner is there, rounded to double, which the slack covers.
    obb::Triangle& moved = b.back();
    const obb::Vec3 way = obb::Vec3{static_cast<double>(start[0]), static_cast<double>(start[1]),
                                    static_cast<double>(start[2])} -
                          moved[0];
    for (obb::Vec3& p : moved) {
        p = p + way;
    }
    obb::ImageTree tree_a(s.screw, images_of(s.screw, a)), tree_b(s.screw, images_of(s.screw, b));
    double best = std::numeric_limits<double>::infinity();
    const double from = sigma * (bytes.take<std::uint8_t>() / 255.0);
    for (const std::uint32_t at_a : tree_a.roots()) {
        for (const std::uint32_t at_b : tree_b.roots()) {
            first_time(s.screw, tree_a, tree_b, at_a, at_b, from, best);
        }
    }
    require(best <= sigma, "no bound is later than where points meet");
    require(best >= from, "no bound falls back");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Bytes bytes(data, size);
    const Setting s = setting(bytes);
    std::array<std::vector<obb::Triangle>, 2> bodies;
    for (auto& triangles : bodies) {
        const std::uint32_t count = 1 + bytes.below(4);
        for (std::uint32_t k = 0; k < count; ++k) {
            triangles.push_back(triangle(bytes));
        }
    }
    for (const auto& triangles : bodies) {
        const std::vector<obb::Image> images = images_of(s.screw, triangles);
        for (std::uint32_t k = 0; k < triangles.size(); ++k) {
            for (int i = 0; i < kPoints; ++i) {
                const Point p = point_near(bytes, triangles[k], s.off);
                bool is_held = false;
                for (const obb::Image& image : images) {
                    is_held = is_held || (image.triangle == k && holds(image, p, s.screw));
                }
                require(is_held, "an image holds what is near its triangle");
            }
        }
    }
    check_meeting(bytes, s, bodies[0], bodies[1]);
    return 0;
}
