#include "overlap/escape_row.hpp"

#include "shapes/extremes.hpp"

#include <cmath>

namespace obb {

namespace {

// `up` has length 1 to 4 u, reaches are at most 4, products round by 12 u, and the way along `up`
// leaves the rectangle by less than its 16 u: altogether below 64 u.
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

} // namespace

// Let the gap be from c to c1 over the rectangle, c1 above the cell, and a point of it outside:
// then all of it is. From a point p of the cell in the solid, which is not in the gap, and
// therefore not above c, the way along `up` stays over the rectangle until it comes into the gap,
// and meets the surface before.
std::optional<EscapeRow> EscapeSearch::find(std::span<const Vec3> corners, const Vec3& direction,
                                            const Vec3& side, const RowEffort& effort) {
    const Vec3 up = unit_or(direction, {0, 0, 0});
    if (up == Vec3{0, 0, 0} || !is_finite(up) || corners.empty()) {
        return std::nullopt;
    }
    Prism prism{up, across_of(up, side), {HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
    double bottom = HUGE_VAL, top = -HUGE_VAL;
    for (const Vec3& p : corners) {
        const double height = dot(up, p);
        bottom = smaller(bottom, height);
        top = larger(top, height);
        for (std::size_t i = 0; i < 2; ++i) {
            const double place = dot(prism.across[i], p);
            prism.low[i] = smaller(prism.low[i], place);
            prism.high[i] = larger(prism.high[i], place);
        }
    }
    const double ceiling = top + effort.useful + kRowError;
    for (const HeightGap& gap :
         heights_.find(prism, bottom - kRowError, ceiling, effort.thin, effort.most)) {
        if (gap.to >= top + kRowError && gap.to - gap.from > 4 * kRowError &&
            is_outside(prism, gap)) {
            return EscapeRow{up, gap.from + kRowError};
        }
    }
    return std::nullopt;
}

// Whether a point of the world in the midst of the gap is outside: its place in the frame, rounded,
// is seen to be in the gap.
bool EscapeSearch::is_outside(const Prism& prism, const HeightGap& gap) {
    const double height = 0.5 * gap.from + 0.5 * gap.to;
    Vec3 place = height * prism.up;
    for (std::size_t i = 0; i < 2; ++i) {
        place = place + (0.5 * (prism.low[i] + prism.high[i])) * prism.across[i];
    }
    const OverlapFrame& frame = windings_.frame();
    const Vec3 world = frame.to_world(place);
    const Vec3 back = frame.to_frame(world);
    const double its = dot(prism.up, back);
    bool is_within = its > gap.from + kRowError && its < gap.to - kRowError;
    for (std::size_t i = 0; i < 2; ++i) {
        const double across = dot(prism.across[i], back);
        is_within = is_within && across >= prism.low[i] - 8 * kUnitRoundoff &&
                    across <= prism.high[i] + 8 * kUnitRoundoff;
    }
    return is_within && windings_.find(world).is_outside();
}

} // namespace obb
