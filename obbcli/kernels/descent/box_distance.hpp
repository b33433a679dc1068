// Lower bounds on the distance of boxes and triangles, cheap enough for every pair that a search
// meets. The axes are those of separation (Eberly 2008 §2.2.1 Table 1, §3.2.1 Table 3) where they
// pay, and the direction between two points that are nearly the nearest.
#pragma once

#include "descent/box_tests.hpp"
#include "shapes/extremes.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

#include <cmath>
#include <cstddef>

namespace obb {

namespace detail {

[[nodiscard]] inline double positive_part(double value) { return value > 0 ? value : 0; }
[[nodiscard]] inline double clamped(double value, double radius) {
    const double below = value < radius ? value : radius;
    return larger(below, -radius);
}

} // namespace detail

// The square of a lower bound. `bound` must cover what a projection on a unit axis may be off by,
// as in are_separated(); the axes may be longer than 1 by a share that the caller takes off.
//
// Along the three axes of one box the gaps are those to an aligned box around the other: their
// squares add up. That misses little where faces are near, and much where corners are; there, and
// far away, the direction from one box's point nearest the other's centre to the point of the other
// nearest to that one serves. Edge-edge axes were measured: they save one box in twenty and cost as
// much as all the rest.
[[nodiscard]] inline double distance_square(const Obb& a, const Obb& b,
                                            const RoundingBound& bound) {
    const Vec3 d = b.center - a.center;
    const Vec3 ha = a.half_extents, hb = b.half_extents;
    const double sizes = norm_1(d) + (ha.x + ha.y + ha.z) + (hb.x + hb.y + hb.z);
    const double e = bound.relative * sizes + bound.absolute;

    // c[i][j] = A_i . B_j, t[i] = A_i . D; y and z are coordinates within A and within B.
    double c[3][3], r[3][3], t[3], y[3], z[3];
    double by_a{}, by_b{};
    for (std::size_t i = 0; i < 3; ++i) {
        t[i] = dot(a.axes[i], d);
        y[i] = t[i] - detail::clamped(t[i], ha[i]);
        for (std::size_t j = 0; j < 3; ++j) {
            c[i][j] = dot(a.axes[i], b.axes[j]);
            r[i][j] = std::fabs(c[i][j]);
        }
        const double radius_b = hb.x * r[i][0] + hb.y * r[i][1] + hb.z * r[i][2];
        const double gap = detail::positive_part(std::fabs(t[i]) - ha[i] - radius_b - e);
        by_a += gap * gap;
    }
    for (std::size_t j = 0; j < 3; ++j) {
        z[j] = detail::clamped(-(y[0] * c[0][j] + y[1] * c[1][j] + y[2] * c[2][j]), hb[j]);
        const double distance = std::fabs(dot(b.axes[j], d));
        const double radius_a = ha.x * r[0][j] + ha.y * r[1][j] + ha.z * r[2][j];
        const double gap = detail::positive_part(distance - hb[j] - radius_a - e);
        by_b += gap * gap;
    }
    // The direction n from A to B in A's coordinates. Any will do: it need not be exact.
    Vec3 n{};
    double along{}, radius{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double w = t[i] + (z[0] * c[i][0] + z[1] * c[i][1] + z[2] * c[i][2]);
        n[i] = w - detail::clamped(w, ha[i]);
        along += n[i] * t[i];
        radius += ha[i] * std::fabs(n[i]);
    }
    for (std::size_t j = 0; j < 3; ++j) {
        radius += hb[j] * std::fabs(n.x * c[0][j] + n.y * c[1][j] + n.z * c[2][j]);
    }
    constexpr double kTiny = 0x1p-1000; // n of zero or of lost digits proves nothing
    const double gap = detail::positive_part(along - radius - e * norm_1(n));
    const double by_n = gap * gap / (dot(n, n) + kTiny);
    return larger(larger(by_a, by_b), by_n);
}

// The same of a box and a triangle, which is first taken into the box's own coordinates.
[[nodiscard]] inline double distance_square(const Obb& box, const Triangle& triangle,
                                            const RoundingBound& bound) {
    const Vec3 h = box.half_extents;
    const Vec3 d0 = triangle[0] - box.center, d1 = triangle[1] - box.center,
               d2 = triangle[2] - box.center;
    const double size = largest(norm_1(d0), norm_1(d1), norm_1(d2)) + h.x + h.y + h.z;
    const double e = bound.relative * size + bound.absolute;
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double p0 = dot(box.axes[k], d0), p1 = dot(box.axes[k], d1),
                     p2 = dot(box.axes[k], d2);
        const double outside = larger(smallest(p0, p1, p2), -largest(p0, p1, p2));
        const double gap = larger(outside - h[k] - e, 0.0);
        square += gap * gap;
    }
    return square;
}

} // namespace obb
