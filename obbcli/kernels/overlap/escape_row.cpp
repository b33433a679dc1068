#include "overlap/escape_row.hpp"

#include "shapes/extremes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace obb {

namespace {

// `up` has length 1 to 4 u, reaches are at most 4, products round by 12 u, and the way along `up`
// leaves the shadow by less than 16 u: altogether below 64 u.
constexpr double kRowError = 64 * kUnitRoundoff;

// Of directions that are of length 1 and perpendicular, all to a few u.
[[nodiscard]] std::array<Vec3, 2> across_of(const Vec3& up, const Vec3& side) {
    const auto upright = [&](const Vec3& v) { return v - dot(v, up) * up; };
    Vec3 first = upright(side);
    if (!(norm_inf(first) > 0x1p-10 * norm_inf(side))) {
        const Vec3 a = abs(up);
        first = upright(a.x <= a.y && a.x <= a.z ? Vec3{1, 0, 0}
                        : a.y <= a.z             ? Vec3{0, 1, 0}
                                                 : Vec3{0, 0, 1});
    }
    first = unit_or(first, {0, 0, 0});
    first = unit_or(upright(first), {0, 0, 0});
    return {first, unit_or(cross(up, first), {0, 0, 0})};
}

using Place = std::array<double, 2>;

// Adds the sides of the convex hull of places (Andrew 1979, Another efficient algorithm for convex
// hulls in two dimensions), but for those of the rectangle. A side is where the outermost of the
// places says, whatever its direction: rounding makes the shadow no smaller.
void add_sides(Prism& prism, std::span<Place> places) {
    std::sort(places.begin(), places.end());
    std::array<Place, 2 * Prism::kMostSides + 2> hull;
    std::size_t count = 0;
    const auto turn = [](const Place& a, const Place& b, const Place& c) {
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    };
    const auto go_on = [&](const Place& place, std::size_t first) {
        while (count >= first + 2 && !(turn(hull[count - 2], hull[count - 1], place) > 0)) {
            --count;
        }
        hull[count++] = place;
    };
    for (const Place& place : places) {
        go_on(place, 0);
    }
    const std::size_t lower = count - 1;
    for (std::size_t k = places.size() - 1; k-- > 0;) {
        go_on(places[k], lower);
    }
    constexpr double kUpright = 0x1p-30; // as good as a side of the rectangle
    for (std::size_t k = 0; k + 1 < count && prism.side_count < Prism::kMostSides; ++k) {
        const double v = hull[k + 1][1] - hull[k][1], w = hull[k][0] - hull[k + 1][0];
        const double length = std::sqrt(v * v + w * w);
        if (!(std::fabs(v) > kUpright * length && std::fabs(w) > kUpright * length)) {
            continue;
        }
        Prism::Side side{v / length, w / length, -HUGE_VAL};
        for (const Place& place : places) {
            side.limit = larger(side.limit, side.v * place[0] + side.w * place[1]);
        }
        prism.sides[prism.side_count++] = side;
    }
}

} // namespace

bool EscapeSearch::set_shadow(std::span<const Vec3> corners, const Vec3& direction,
                              const Vec3& side) {
    const Vec3 up = unit_or(direction, {0, 0, 0});
    if (up == Vec3{0, 0, 0} || !is_finite(up) || corners.empty()) {
        return false;
    }
    prism_ = {up, across_of(up, side), {HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}, {}, 0};
    std::array<Place, Prism::kMostSides> places;
    middle_ = {0, 0};
    bottom_ = HUGE_VAL;
    top_ = -HUGE_VAL;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3& p = corners[k];
        const double height = dot(up, p);
        bottom_ = smaller(bottom_, height);
        top_ = larger(top_, height);
        for (std::size_t i = 0; i < 2; ++i) {
            const double place = dot(prism_.across[i], p);
            prism_.low[i] = smaller(prism_.low[i], place);
            prism_.high[i] = larger(prism_.high[i], place);
            places[std::min(k, places.size() - 1)][i] = place;
            middle_[i] += place / static_cast<double>(corners.size());
        }
    }
    if (corners.size() <= places.size()) {
        add_sides(prism_, std::span(places).first(corners.size()));
    }
    return true;
}

// Let the gap be from c to c1 over the shadow, c1 above the cell, and a point of it outside:
// then all of it is. From a point p of the cell in the solid, which is not in the gap, and
// therefore not above c, the way along `up` stays over the shadow until it comes into the gap,
// and meets the surface before.
std::optional<EscapeRow> EscapeSearch::find(std::span<const Vec3> corners, const Vec3& up,
                                            const Vec3& side, const RowEffort& effort) {
    if (!set_shadow(corners, up, side)) {
        return std::nullopt;
    }
    for (const HeightGap& gap :
         heights_.find(prism_, bottom_ - kRowError, top_ + effort.useful + kRowError, effort.thin,
                       effort.most, top_)) {
        if (gap.to < top_ + kRowError) {
            continue;
        }
        if (const auto winding = winding_in(gap); winding && winding->is_outside()) {
            return EscapeRow{prism_.up, gap.from + kRowError};
        }
    }
    return std::nullopt;
}

// Between two gaps in which the surface winds another number of times around points, every upright
// line over the shadow meets it.
std::optional<CrossingRow> EscapeSearch::find_crossing(std::span<const Vec3> corners,
                                                       const Vec3& up, const Vec3& side,
                                                       const RowEffort& effort) {
    if (!set_shadow(corners, up, side)) {
        return std::nullopt;
    }
    constexpr std::size_t kMostGaps = 6;
    const double far = effort.useful + kRowError;
    std::optional<CrossingRow> best;
    std::optional<std::int64_t> before;
    double before_to = 0, least = effort.useful;
    std::size_t count = 0;
    for (const HeightGap& gap :
         heights_.find(prism_, bottom_ - far, top_ + far, effort.thin, effort.most)) {
        if (++count > kMostGaps) {
            break;
        }
        const auto winding = winding_in(gap);
        if (!winding || winding->is_on_surface) {
            continue;
        }
        const double reach = larger(gap.from - bottom_, top_ - before_to) + kRowError;
        if (before && *before != winding->number && reach < least) {
            least = reach;
            best = CrossingRow{prism_.up, before_to - kRowError, gap.from + kRowError};
        }
        before = winding->number;
        before_to = gap.to;
    }
    return best;
}

// Of a point of the world in the midst of the gap: its place in the frame, rounded, is seen to be
// in the gap, else there is no answer.
std::optional<Winding> EscapeSearch::winding_in(const HeightGap& gap) {
    if (!(gap.to - gap.from > 4 * kRowError)) {
        return std::nullopt;
    }
    Vec3 place = (0.5 * gap.from + 0.5 * gap.to) * prism_.up;
    for (std::size_t i = 0; i < 2; ++i) {
        place = place + middle_[i] * prism_.across[i];
    }
    const OverlapFrame& frame = windings_.frame();
    const Vec3 world = frame.to_world(place);
    const Vec3 back = frame.to_frame(world);
    const double height = dot(prism_.up, back);
    const Place at{dot(prism_.across[0], back), dot(prism_.across[1], back)};
    constexpr double kBeside = 32 * kUnitRoundoff; // of the 64 u by which the shadow is grown
    bool is_within = height > gap.from + kRowError && height < gap.to - kRowError;
    for (std::size_t i = 0; i < 2; ++i) {
        is_within = is_within && at[i] >= prism_.low[i] - 0.5 * kBeside &&
                    at[i] <= prism_.high[i] + 0.5 * kBeside;
    }
    for (std::size_t k = 0; k < prism_.side_count; ++k) {
        const Prism::Side& side = prism_.sides[k];
        is_within = is_within && side.v * at[0] + side.w * at[1] <= side.limit + 0.5 * kBeside;
    }
    return is_within ? std::optional{windings_.find(world)} : std::nullopt;
}

} // namespace obb
