// Faces along each other: thousands of pairs are as near as the nearest, and boxes, which are
// rounded, cannot tell. The direction of the least distance can, for all they hold at once.
#include "descent/recent_vertices.hpp"
#include "distance/distance_query.hpp"
#include "nearest/localized.hpp"
#include "nearest/nearest_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace obb {

namespace {

// How much nearer boxes may seem than what they hold, in the query's unit: those of both bodies,
// whose extents sum to at most 3 each.
constexpr double kSeemsNearer = 8 * kBoxRounding;

// Posed coordinates in the query's unit stay below 3, differences below 6, and lengths of these
// below 11. In doubles a projection of a difference on a direction with entries up to 1 is off by
// at most 6 roundoffs of the product of the lengths.
constexpr double kReach = 11;
constexpr double kRoughly = 6 * kUnitRoundoff * 2 * kReach;

// The greatest projection of vertices on a direction. Most are far below it, which doubles tell.
class Summit {
  public:
    explicit Summit(const Vector3<Twofold>& n) : n_(n), rough_n_(nearest_double(n)) {}

    void add(const Vec3& point, const Vec3& origin) {
        const double rough = dot(rough_n_, point - origin);
        if (rough < rough_ - 2 * kRoughly) {
            return;
        }
        is_number_ = is_number_ && std::isfinite(rough);
        rough_ = std::max(rough_, rough);
        const Twofold exact = dot(n_, difference(point, origin, Twofold{}));
        if (exact > height_) {
            height_ = exact;
        }
    }

    [[nodiscard]] bool is_number() const { return is_number_; }
    [[nodiscard]] double rough() const { return rough_; }
    [[nodiscard]] Twofold height() const { return height_; }

  private:
    Vector3<Twofold> n_;
    Vec3 rough_n_;
    double rough_ = -HUGE_VAL;
    Twofold height_{-HUGE_VAL};
    bool is_number_ = true;
};

} // namespace

bool DistanceQuery::may_tie(const Pair& pair) const {
    return !is_diving() && high_ - pair.key <= kSeemsNearer && !pair.a.is_triangle() &&
           !pair.b.is_triangle() &&
           crowds_[has_many_ties() ? 1 : 0].may_look_at(pair.a.triangle_count() +
                                                        pair.b.triangle_count());
}

bool DistanceQuery::are_sides_apart(const Pair& pair) {
    refine_incumbent();
    return are_boxes_apart(pair);
}

// The bodies as a whole come first: where they lie along each other nothing is left to do.
void DistanceQuery::look_for_tie(const Pair& pair) {
    if (crowds_[has_many_ties() ? 1 : 0].starts_with_all()) {
        Pair all{0.0, a_.tree().root(), b_.tree().root(), {}};
        all.key = bound(side_of(a_, all.a), side_of(b_, all.b));
        if (may_tie(all) && are_sides_apart(all)) {
            wait_for(all, pair);
            return;
        }
    }
    if (are_sides_apart(pair)) {
        wait_for(pair, pair);
    } else {
        part(pair);
    }
}

void DistanceQuery::wait_for(const Pair& candidate, const Pair& pair) {
    wait_ = TieWait<Pair>{candidate, pair, {}};
    wait_->begin(a_.tree(), b_.tree());
}

void DistanceQuery::end_wait() {
    const Pair candidate = wait_->candidate, pair = wait_->pair;
    const std::uint32_t count = wait_->triangle_count();
    wait_.reset();
    const double low = all_apart(candidate);
    const bool are_all =
        candidate.a.slot == a_.tree().root().slot && candidate.b.slot == b_.tree().root().slot;
    if (is_settled(low)) {
        settle(low);
        if (are_all) {
            stop();
        }
        return;
    }
    crowds_[has_many_ties() ? 1 : 0].fail(count);
    const bool is_pair = candidate.a.slot == pair.a.slot && candidate.b.slot == pair.b.slot;
    if (!is_pair && are_sides_apart(pair)) {
        wait_for(pair, pair);
    } else {
        part(pair);
    }
}

void DistanceQuery::refine_incumbent() {
    if (incumbent_.is_fine) {
        return;
    }
    const Incumbent now = incumbent_;
    const Triangle a = a_.triangle(now.a), b = b_.triangle(now.b);
    if (!now.is_measured) {
        ++counts_.exact_triangle_tests;
        take(measure_finely(a, b, now.features), now.a, now.b);
    }
    incumbent_ = {now.a, now.b, now.features, true, true, near_direction(a, b, now.features)};
}

// As far apart along the direction as the least distance, but for their rounding?
bool DistanceQuery::are_boxes_apart(const Pair& pair) const {
    const Vec3 n = nearest_double(incumbent_.direction);
    const double length = norm(n);
    const Mat3& turn = a_.pose().rotation; // boxes are in A's frame
    const Vec3 in_frame{dot(turn.column(0), n), dot(turn.column(1), n), dot(turn.column(2), n)};
    const Obb a = a_.box(a_.tree().node(pair.a)), b = b_.box(b_.tree().node(pair.b));
    const auto radius = [&](const Obb& box) {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            sum += box.half_extents[k] * std::fabs(dot(box.axes[k], in_frame));
        }
        return sum;
    };
    const double apart = dot(in_frame, b.center - a.center) - radius(a) - radius(b);
    const double sizes = norm_1(a.half_extents) + norm_1(b.half_extents);
    return length > 0.25 && apart >= (high_ - kBoxRounding * sizes) * length;
}

// A lower bound, as NearestPoints::bound_along(); 0 where they surely are not that far apart.
double DistanceQuery::all_apart(const Pair& pair) const {
    const Vector3<Twofold>& n = incumbent_.direction;
    const double length = norm(nearest_double(n));
    const double needed = (high_ - slack()) * length * (1 - 16 * kUnitRoundoff) - 8 * kRoughly;
    std::optional<Vec3> origin;
    std::array<Summit, 2> summits{Summit(n), Summit(-n)};
    for (const bool is_a : {true, false}) {
        const PosedTree& body = is_a ? a_ : b_;
        const NodeRef& ref = is_a ? pair.a : pair.b;
        Summit& summit = summits[is_a ? 0 : 1];
        std::optional<RecentVertices> seen; // a single triangle has each once
        if (!ref.is_triangle()) {
            seen.emplace();
        }
        for (std::uint32_t i = ref.begin; i < ref.end; ++i) {
            const auto places = body.tree().corners_of(i);
            for (std::size_t k = 0; k < 3; ++k) {
                if (seen && seen->add(body.tree().corners[i][k])) {
                    continue;
                }
                const Vec3 point = in_unit(body.placed(*places[k]));
                if (!origin) {
                    origin = point;
                }
                summit.add(point, *origin);
            }
            if (!is_a && !(-summit.rough() - summits[0].rough() >= needed)) {
                return 0;
            }
        }
    }
    if (!summits[0].is_number() || !summits[1].is_number()) {
        return 0;
    }
    const Twofold gap = (-summits[1].height() - summits[0].height()) / root_of(dot(n, n));
    const Twofold low = gap - Twofold(8 * kRoundoff<Twofold> * (gap.high + 4 * kReach));
    return std::max(rounded_down(low), 0.0);
}

} // namespace obb
