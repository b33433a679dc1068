// Separation of the boxes and triangles that a traversal meets: "separated" is proof, "not
// separated" may be caution. Eberly 2008 §2.2.1 Table 1 and §3.2.1 Table 3.
#pragma once

#include "numbers/vec.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

// What a projection may be off by: `relative` times the sizes in play, plus `absolute`, which is at
// least 2^-900 for coordinates up to 2^10.
struct RoundingBound {
    double relative;
    double absolute;
};

// Boxes with axes orthonormal up to what bound.relative allows for. Axes are not normalised: where
// two edges are nearly parallel both sides of the comparison vanish, the bound does not, and the
// axis is inconclusive, which is the safe side.
//
// Products that underflow lose at most 2^-1075 each. Here every product has an entry of an axis or
// the relative bound for a factor, both at most about 1: no axis sums, nor carries on, more than a
// few dozen of them, times coordinates up to 2^10, which stays far below bound.absolute.
//
// Comparisons are such that a NaN, from the damaged box of an unverified tree, separates nothing.
//
// Each group of axes is judged as a whole: which of its axes separates is as good as random, and a
// mispredicted branch costs more than an axis.
[[nodiscard]] inline bool are_separated(const Obb& a, const Obb& b, const RoundingBound& bound) {
    const Vec3 d = b.center - a.center;
    const Vec3 ha = a.half_extents, hb = b.half_extents;
    const double sizes = norm_1(d) + (ha.x + ha.y + ha.z) + (hb.x + hb.y + hb.z);
    const double e = bound.relative * sizes + bound.absolute;

    // c[i][j] = A_i . B_j, t[i] = A_i . D
    double c[3][3], r[3][3], t[3];
    bool apart = false;
    for (std::size_t i = 0; i < 3; ++i) {
        t[i] = dot(a.axes[i], d);
        for (std::size_t j = 0; j < 3; ++j) {
            c[i][j] = dot(a.axes[i], b.axes[j]);
            r[i][j] = std::fabs(c[i][j]);
        }
        const double radius_b = hb.x * r[i][0] + hb.y * r[i][1] + hb.z * r[i][2];
        apart |= std::fabs(t[i]) > ha[i] + radius_b + e;
    }
    if (apart) {
        return true;
    }
    for (std::size_t j = 0; j < 3; ++j) {
        const double distance = std::fabs(t[0] * c[0][j] + t[1] * c[1][j] + t[2] * c[2][j]);
        const double radius_a = ha.x * r[0][j] + ha.y * r[1][j] + ha.z * r[2][j];
        apart |= distance > hb[j] + radius_a + e;
    }
    if (apart) {
        return true;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            const double distance = std::fabs(t[i2] * c[i1][j] - t[i1] * c[i2][j]);
            const double radius_a = ha[i1] * r[i2][j] + ha[i2] * r[i1][j];
            const double radius_b = hb[j1] * r[i][j2] + hb[j2] * r[i][j1];
            apart |= distance > radius_a + radius_b + e;
        }
    }
    return apart;
}

namespace detail {

// False where a NaN is among them, which std::min and std::max may pass over.
[[nodiscard]] inline bool is_outside(double p0, double p1, double p2, double radius) {
    return ((p0 > radius) & (p1 > radius) & (p2 > radius)) |
           ((p0 < -radius) & (p1 < -radius) & (p2 < -radius));
}

} // namespace detail

// The triangle is first taken into the box's own coordinates, where its 13 axes are cheap.
[[nodiscard]] inline bool are_separated(const Obb& box, const Triangle& triangle,
                                        const RoundingBound& bound) {
    const Vec3 h = box.half_extents;
    std::array<Vec3, 3> p;
    double size = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 d = triangle[k] - box.center;
        p[k] = {dot(box.axes[0], d), dot(box.axes[1], d), dot(box.axes[2], d)};
        size = std::max(size, norm_1(d));
    }
    size += h.x + h.y + h.z;
    const double e = bound.relative * size + bound.absolute;
    for (std::size_t k = 0; k < 3; ++k) {
        if (detail::is_outside(p[0][k], p[1][k], p[2][k], h[k] + e)) {
            return true;
        }
    }
    // An error of e in the coordinates moves a projection on a product of edges by no more than
    // 4 e times the other factors. Small edges times small coordinates may underflow, and so may
    // that bound: a few dozen products lose at most 2^-1075 each, times coordinates up to 2^10.
    constexpr double kLostToUnderflow = 0x1p-1000;
    const std::array<Vec3, 3> edges{p[1] - p[0], p[2] - p[0], p[2] - p[1]};
    const Vec3 n = cross(edges[0], edges[1]);
    const double e_normal =
        4.0 * e * (norm_1(edges[0]) + norm_1(edges[1])) * size + kLostToUnderflow;
    if (std::fabs(dot(n, p[0])) > dot(abs(n), h) + e_normal) {
        return true;
    }
    const double e_edge = 4.0 * e * size + kLostToUnderflow;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (const Vec3& edge : edges) {
            const auto along = [&](Vec3 q) { return q[i2] * edge[i1] - q[i1] * edge[i2]; };
            const double radius = h[i1] * std::fabs(edge[i2]) + h[i2] * std::fabs(edge[i1]);
            if (detail::is_outside(along(p[0]), along(p[1]), along(p[2]), radius + e_edge)) {
                return true;
            }
        }
    }
    return false;
}

} // namespace obb
