#include "in_motion/tie_planes.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

constexpr std::uint64_t kTiePatience = 64;
// Where boxes lie on both sides of a plane, looks at others become as rare as this.
constexpr std::uint64_t kLongestPause = 32;
// By how much boxes may reach beyond a plane that what they hold does not cross, of the size of
// their extents and of their distance from the pivot: they were turned as well, and the plane's
// normal is rounded.
constexpr double kReachesBeyond = 8 * kBoxRounding;

double top_of(const Triangle& t, Vec3 direction) {
    return std::max({dot(t[0], direction), dot(t[1], direction), dot(t[2], direction)});
}

bool are_same(const NodeRef& x, const NodeRef& y) { return x.begin == y.begin && x.end == y.end; }

} // namespace

// Of bodies that come within a clearance, the plane's two sides are that far apart then, and
// further before: what holds of contact holds of nearness.
void TiePlanes::set(const MovingPair& pair, const PairRef& refs, const Touch& touch,
                    std::uint64_t pops) {
    planes_.clear();
    const LinearMotion motion = pair.linear_motion();
    const Triangle a = pair.a().posed_triangle(refs.a), b = pair.b().posed_triangle(refs.b);
    for (const auto& plane : {ContactPlane::of_axis(a, b, motion, touch),
                              ContactPlane::of_motion(a, b, motion, touch)}) {
        if (plane) {
            const Vec3 n = plane->normal();
            planes_.push_back({*plane, n, top_of(pair.a().triangle(refs.a), n),
                               -top_of(pair.b().triangle(refs.b), -n)});
        }
    }
    crowd_ = {};
    patience_ = pops + kTiePatience;
    pause_ = 0;
}

bool TiePlanes::may_tie(const PairRef& refs, std::uint64_t pops) const {
    if (planes_.empty() || pops < patience_) {
        return false;
    }
    return crowd_.may_look_at(refs.a.triangle_count() + refs.b.triangle_count());
}

// Whether both boxes are on their own sides of the plane, up to their rounding.
bool TiePlanes::are_sides(const MovingPair& pair, const PairRef& refs, const Tie& tie) {
    const auto reaches = [](const MovingTree& body, const NodeRef& ref, Vec3 n, double top) {
        const Obb box = body.box(ref);
        double height = dot(box.center, n);
        for (std::size_t k = 0; k < 3; ++k) {
            height += box.half_extents[k] * std::fabs(dot(box.axes[k], n));
        }
        return height <= top + kReachesBeyond * (norm_1(box.half_extents) + norm_1(box.center));
    };
    return reaches(pair.a(), refs.a, tie.normal, tie.top_of_a) &&
           reaches(pair.b(), refs.b, -tie.normal, -tie.bottom_of_b);
}

bool TiePlanes::waits_for(const MovingPair& pair, const PairRef& candidate, const PairRef& refs,
                          std::size_t plane) {
    const bool is_all = are_same(candidate.a, pair.a().tree().root()) &&
                        are_same(candidate.b, pair.b().tree().root());
    for (; plane < planes_.size(); ++plane) {
        if (are_sides(pair, candidate, planes_[plane])) {
            wait_ = std::make_unique<Wait>(Wait{.nodes = {candidate, refs},
                                                .plane = plane,
                                                .next = {candidate.a.begin, candidate.b.begin},
                                                .is_all = is_all});
            wait_->nodes.begin(pair.a().tree(), pair.b().tree());
            return true;
        }
    }
    return false;
}

TiePlanes::Verdict TiePlanes::look(const MovingPair& pair, const PairRef& refs,
                                   std::uint64_t pops) {
    if (crowd_.starts_with_all()) {
        const PairRef all{pair.a().tree().root(), pair.b().tree().root()};
        if (waits_for(pair, all, refs, 0)) {
            return Verdict::kLooking;
        }
    }
    if (waits_for(pair, refs, refs, 0)) {
        pause_ = 0;
        return Verdict::kLooking;
    }
    pause_ = std::min(2 * pause_ + 1, kLongestPause);
    patience_ = pops + pause_;
    return Verdict::kUnknown;
}

// Whether all vertices of a triangle are on their side of the plane. Of the bodies as a whole it
// keeps which are the farthest beyond it.
bool TiePlanes::all_hold(const MovingTree& body, std::uint32_t position, std::size_t side) {
    Wait& wait = *wait_;
    const Tie& tie = planes_[wait.plane];
    const NodeRef ref{position, position + 1, 0, 0};
    const Triangle t = body.posed_triangle(ref);
    const Corners& corners = body.tree().corners[position];
    bool holds = true;
    for (std::size_t k = 0; k < 3; ++k) {
        if (wait.seen[side].add(corners[k]) ||
            (side == 0 ? tie.plane.holds_a(t[k]) : tie.plane.holds_b(t[k]))) {
            continue;
        }
        holds = false;
        if (!wait.is_all) {
            break;
        }
        const double height = top_of(body.triangle(ref), side == 0 ? tie.normal : -tie.normal);
        if (!ahead_.triangles[side] || height > wait.farthest[side]) {
            ahead_.triangles[side] = ref;
            wait.farthest[side] = height;
        }
    }
    return holds;
}

// Whether all vertices under the nodes that are looked at are on their sides of the plane; nothing
// where the slice is over before that is known.
std::optional<bool> TiePlanes::compare(const MovingPair& pair, SliceClock& clock) {
    Wait& wait = *wait_;
    if (!wait.nodes.advance(clock)) {
        return std::nullopt;
    }
    const PairRef& refs = wait.nodes.candidate;
    for (const std::size_t side : {0U, 1U}) {
        const MovingTree& body = side == 0 ? pair.a() : pair.b();
        const std::uint32_t end = side == 0 ? refs.a.end : refs.b.end;
        for (std::uint32_t& next = wait.next[side]; next < end; ++next) {
            if (clock.is_over()) {
                return std::nullopt;
            }
            wait.holds = all_hold(body, next, side) && wait.holds;
            if (!wait.holds && !wait.is_all) {
                return false;
            }
        }
    }
    return wait.holds;
}

TiePlanes::Verdict TiePlanes::look_on(const MovingPair& pair, SliceClock& clock) {
    while (const std::optional<bool> holds = compare(pair, clock)) {
        const PairRef candidate = wait_->nodes.candidate, refs = wait_->nodes.pair;
        const std::size_t next = wait_->plane + 1;
        wait_.reset();
        const bool is_pair = are_same(candidate.a, refs.a) && are_same(candidate.b, refs.b);
        if (*holds) {
            return is_pair ? Verdict::kPairIsLater : Verdict::kAllIsLater;
        }
        crowd_.fail(candidate.a.triangle_count() + candidate.b.triangle_count());
        if (!waits_for(pair, candidate, refs, next) &&
            (is_pair || !waits_for(pair, refs, refs, 0))) {
            return Verdict::kUnknown;
        }
    }
    return Verdict::kLooking;
}

bool TiePlanes::are_later(const MovingPair& pair, const PairRef& refs) const {
    if (planes_.empty()) {
        return false;
    }
    const Triangle a = pair.a().posed_triangle(refs.a), b = pair.b().posed_triangle(refs.b);
    return std::any_of(planes_.begin(), planes_.end(), [&](const Tie& tie) {
        const auto on_a = [&](const Vec3& p) { return tie.plane.holds_a(p); };
        const auto on_b = [&](const Vec3& p) { return tie.plane.holds_b(p); };
        return std::all_of(a.begin(), a.end(), on_a) && std::all_of(b.begin(), b.end(), on_b);
    });
}

} // namespace obb
