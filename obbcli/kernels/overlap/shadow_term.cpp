#include "overlap/shadow_term.hpp"

#include "overlap/column_integral.hpp"
#include "overlap/shadow_clip.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

namespace obb {

namespace {

// The smaller one is cut. Equal sizes are told apart by coordinates, whatever the order of a pair.
[[nodiscard]] bool comes_before(const Shadow& a, const Shadow& b) {
    return std::tie(a.extent, a.u, a.v, a.h) < std::tie(b.extent, b.u, b.v, b.h);
}

// The heights of a triangle over places of its shadow, from their areas with its edges.
struct Heights {
    const Shadow& shadow;
    const std::array<double, 3>&u, &v; // corners, in the coordinates of the pair

    [[nodiscard]] double at(double x, double y) const {
        const double from_u = x - u[0], from_v = y - v[0];
        const double second = (from_u * (v[2] - v[0]) - from_v * (u[2] - u[0])) * shadow.inverse;
        const double third = ((u[1] - u[0]) * from_v - (v[1] - v[0]) * from_u) * shadow.inverse;
        const auto& h = shadow.h;
        const double height = h[0] + second * (h[1] - h[0]) + third * (h[2] - h[0]);
        return height < shadow.low_h ? shadow.low_h
                                     : (shadow.high_h < height ? shadow.high_h : height);
    }
    // What they may be off by, as derived below.
    [[nodiscard]] double doubt(double unit) const {
        const double range = shadow.high_h - shadow.low_h;
        const double relative = 512 * unit * shadow.extent * std::fabs(shadow.inverse);
        const double by_place = shadow.inverse != 0 && relative < 1 ? relative * range : range;
        return by_place + 16 * kUnitRoundoff * shadow.reach;
    }
};

// What the lower of two heights may be off by. Where one is the lower one everywhere beyond doubt,
// the other does not matter.
[[nodiscard]] double doubt_of_lower(std::span<const ColumnPlace> places, double first,
                                    double second) {
    bool is_first = true, is_second = true;
    for (const ColumnPlace& p : places) {
        const double gap = p.second - p.first;
        is_first = is_first && gap > 2 * (first + second);
        is_second = is_second && -gap > 2 * (first + second);
    }
    return is_first ? first : is_second ? second : first + second;
}

} // namespace

// The error of a term, with u the unit roundoff, D and l as in ShadowClip, H the lower of both
// triangles' tops (no point that counts is higher), e the extent of a triangle, F = |f| twice the
// area of its shadow, R the range of its heights.
//
// 1. The area that is integrated over is off by slack u D l (ShadowClip), each unit of it by at
//    most H. l is the extent of the triangle that is cut, or of what the window leaves of it, with
//    128 u D for the corners that moved.
// 2. Corners q of the polygon lie within 64 u D of both triangles' half-planes: within 4.01 u D by
//    each cut, and moved by 5.1 u D at most seven times. The weights of a triangle's corners at q
//    are its areas with the edges, divided by F. They are >= -64 u D e / F, so that the plane
//    leaves the triangle's range by at most 3 * 64 u D e / F * R at q and, as it is linear, in
//    between. The weights are computed with cross products off by 4.01 u D e and F off by as much:
//    17 u D e / F * R for both weights and the sums. Clamped to the triangle's own range, a height
//    is off by at most 2 * 192 + 17 + 17 < 512 u D e / F * R, and never by more than R. A steep
//    triangle so errs by (what is uncertain of its shadow) times (its height).
// 3. Heights of corners over the floor are rounded once: u times the largest, `reach`, the
//    interpolated ones by 4 u more. Places where heights cross or reach the floor are off by 2.01 u
//    of the difference of heights there: 16 u times the reach of each triangle that matters covers
//    these. Prisms and their sums are off by 16 u of area times height: 64 u H.
// The lower of two heights, and what is above the floor of it, are as close as the heights are.
//
// Moments weigh the same errors by a coordinate in the window, or by half the height: at most the
// window's size, and twice that covers their own rounding, 64 u of the area times H as well.
ShadowTerm term_of(const Shadow& one, const Shadow& other, const ColumnWindow& window) {
    const bool is_other_first = comes_before(other, one);
    const Shadow& a = is_other_first ? other : one;
    const Shadow& b = is_other_first ? one : other;
    const double height = std::min(a.high_h, b.high_h);
    if (a.sign == 0 || b.sign == 0 || height <= 0 || !may_share(a, b)) {
        return {};
    }
    ShadowClip clip(a, b);
    if (clip.are_apart()) {
        return {};
    }
    const double left_u = std::min(a.high_u, window.high[0]) - std::max(a.low_u, window.low[0]);
    const double left_v = std::min(a.high_v, window.high[1]) - std::max(a.low_v, window.low[1]);
    if (left_u < 0 || left_v < 0) {
        return {}; // the triangle is beside the window
    }
    clip.cut(window);
    const ClippedShadow& kept = clip.kept();
    const double unit = clip.unit();
    const double extent = left_u + left_v + 128 * unit;
    if (kept.is_too_large) {
        return {0, {0, 0, 0}, height * extent * extent};
    }
    const Heights first{a, clip.subject_u, clip.subject_v};
    const Heights second{b, clip.other_u, clip.other_v};
    std::array<ColumnPlace, ClippedShadow::kMost> places{};
    for (std::size_t i = 0; i < kept.count; ++i) {
        places[i] = {kept.u[i], kept.v[i], first.at(kept.u[i], kept.v[i]),
                     second.at(kept.u[i], kept.v[i])};
    }
    ColumnIntegral integral;
    for (std::size_t i = 2; i < kept.count; ++i) {
        integral.add(places[0], places[i - 1], places[i]);
    }
    const double area = integral.area + 8 * unit * extent;
    const double doubt =
        doubt_of_lower({places.data(), kept.count}, first.doubt(unit), second.doubt(unit));
    ShadowTerm term;
    term.error = height * kept.slack * unit * extent + area * (doubt + 64 * kUnitRoundoff * height);
    // The polygon turns as the triangle that is cut does: its area has that one's sign already.
    term.volume = b.sign * integral.volume;
    term.moments = {b.sign * integral.moments[0] + (a.u[0] - window.low[0]) * term.volume,
                    b.sign * integral.moments[1] + (a.v[0] - window.low[1]) * term.volume,
                    b.sign * integral.moments[2]};
    return term;
}

} // namespace obb
