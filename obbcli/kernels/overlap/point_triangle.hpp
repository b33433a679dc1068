// How far a point is from a triangle, by a point of the triangle and by a direction that parts the
// two: on doubles and on lanes of doubles alike.
#pragma once

#include "numbers/lane_vectors.hpp"
#include "numbers/registers.hpp"
#include "numbers/vec.hpp"
#include "shapes/triangle.hpp"

#include <cstddef>
#include <span>

namespace obb {

// Of a point and a triangle of which no coordinate exceeds about 1, in an overlap query's frame.
// `high` and `low` bound the distance of the posed triangle; `foot` is the point of it that `high`
// is of, to rounding.
struct FootDistance {
    double low, high;
    Vec3 foot;
};

[[nodiscard]] FootDistance foot_distance(const Vec3& point, const Triangle& triangle);

// Upper bounds on the distance of many points from one triangle, four at a time.
void distances_from(const Triangle& triangle, std::span<const Vec3> points,
                    std::span<double> highs);

// Four of either: bounds as above, and the foot less the point.
template <typename Real>
struct LaneFeet {
    Real low, high;
    Lanes3<Real> way;
};

namespace detail {

template <typename Real>
OBB_INLINE Lanes3<Real> along(const Lanes3<Real>& start, Real factor, const Lanes3<Real>& edge) {
    return {start[0] + factor * edge[0], start[1] + factor * edge[1], start[2] + factor * edge[2]};
}
template <typename Real>
OBB_INLINE Lanes3<Real> less(const Lanes3<Real>& a, const Lanes3<Real>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <typename Real, typename Mask>
OBB_INLINE Lanes3<Real> chosen(const Mask& mask, const Lanes3<Real>& a, const Lanes3<Real>& b) {
    return {select(mask, a[0], b[0]), select(mask, a[1], b[1]), select(mask, a[2], b[2])};
}
template <typename Real>
OBB_INLINE Real within_one(Real value) {
    return upper(lower(value, Real(1.0)), Real(0.0));
}
template <typename Real>
OBB_INLINE Real sum_of_sizes(const Lanes3<Real>& a) {
    return magnitude(a[0]) + magnitude(a[1]) + magnitude(a[2]);
}

} // namespace detail

// The corners are relative to the point, which is at the origin: each is off by u times its
// distance r from there at most, u = 2^-53, and r stands for the largest.
//
// Upper bound. The foot is a corner plus one or two edges times factors in [0, 1], of which two sum
// to at most 1 + 2 u: products, edges and sums are off by 8 u r, the excess of the sum moves it by
// 4 u r out of the triangle, and its length is off by 4 u of itself. 16 u (length + r) covers that.
//
// Lower bound. For any vector n whatever the distance is at least the least n.c / |n| of the
// corners c. The products are off by 3 u |n| r, corners by u r, length and quotient by 5 u of the
// result: 8 u (result + r). The better of two is taken: the foot, and where the point is so near
// that the foot is mostly noise, the triangle's normal or the foot made perpendicular to its edge
// once more.
//
// Squares below 2^-800 may have lost digits and prove nothing. Whatever else underflows is below
// 2^-600, and kPlaceError, which is added to `high` and taken off `low`, has that to spare.
template <typename Real>
OBB_INLINE LaneFeet<Real> lane_feet(const LaneTriangles<Real>& c) {
    using detail::chosen;
    const Real zero(0.0), one(1.0), least(0x1p-800), unit(kUnitRoundoff);
    const Lanes3<Real> u = detail::less(c[1], c[0]), v = detail::less(c[2], c[0]);
    const std::array<Lanes3<Real>, 3> edges{u, detail::less(c[2], c[1]), v};
    const std::array<std::size_t, 3> starts{0, 1, 0};

    Lanes3<Real> way = c[0], normal = c[0];
    Real square = inner(c[0], c[0]);
    for (std::size_t k = 0; k < 3; ++k) {
        const Lanes3<Real>& e = edges[k];
        const Lanes3<Real>& start = c[starts[k]];
        const Real length = upper(inner(e, e), least);
        const Real t = detail::within_one<Real>((zero - inner(start, e)) / length);
        const Lanes3<Real> foot = detail::along(start, t, e);
        const auto is_within = (t > zero) & (t < one);
        const Lanes3<Real> upright = detail::along(foot, (zero - inner(foot, e)) / length, e);
        const Real its = inner(foot, foot);
        const auto is_nearer = its < square;
        way = chosen(is_nearer, foot, way);
        normal = chosen(is_nearer, chosen(is_within, upright, foot), normal);
        square = select(is_nearer, its, square);
    }

    // The face: Ericson 2004, Real-Time Collision Detection, §5.1.5, by products with the normal.
    const Lanes3<Real> n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                         u[0] * v[1] - u[1] * v[0]};
    const Real nn = inner(n, n);
    const Lanes3<Real>& o = c[0];
    const Lanes3<Real> turned{n[2] * o[1] - n[1] * o[2], n[0] * o[2] - n[2] * o[0],
                              n[1] * o[0] - n[0] * o[1]};
    const Real on_u = inner(v, turned), on_v = zero - inner(u, turned);
    const auto is_over = (nn > least) & (on_u >= zero) & (on_v >= zero) & (on_u + on_v <= nn);
    const Real safe = upper(nn, least);
    const Real x = detail::within_one<Real>(on_u / safe);
    const Real y = lower(detail::within_one<Real>(on_v / safe), one - x);
    const Lanes3<Real> foot = detail::along(detail::along(o, x, u), y, v);
    const Real flips = select(inner(n, o) < zero, Real(-1.0), one);
    way = chosen(is_over, foot, way);
    square = select(is_over, inner(foot, foot), square);
    normal = chosen(is_over, {flips * n[0], flips * n[1], flips * n[2]}, normal);

    const Real r = upper(upper(detail::sum_of_sizes(c[0]), detail::sum_of_sizes(c[1])),
                         detail::sum_of_sizes(c[2]));
    const Real place(4 * kUnitRoundoff); // kPlaceError
    const Real length = root_of(square);
    const auto parted = [&](const Lanes3<Real>& d) __attribute__((always_inline)) {
        const Real size = inner(d, d);
        const Real corner = lower(lower(inner(d, c[0]), inner(d, c[1])), inner(d, c[2]));
        return select(size > least, corner / root_of(upper(size, least)), zero);
    };
    const Real value = upper(upper(parted(normal), parted(way)), zero);
    const Real low = value - Real(8.0) * unit * (value + r) - place;
    return {upper(low, zero), length + Real(16.0) * unit * (length + r) + place, way};
}

} // namespace obb
