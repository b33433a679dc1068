// Separating axes of two boxes, Eberly 2008 §2.1 and 2.2, Table 1 (last row: A_2 x B_2).
#pragma once

#include "primitives/axis.hpp"
#include "primitives/sat.hpp"
#include "shapes/extremes.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

#include <array>
#include <cmath>

namespace obb {

// Axes are taken literally but may be orthonormal to kAxisDefect only (largest entry of
// |A^T A - I|). The tables take them as orthonormal: relative to the sizes in play their entries
// are then off by less than ten times that, and rounding adds less than 64 u.
inline constexpr double kAxisDefect = 1e-9;
inline constexpr double kAxisError = 1e-7;

// The largest entry of |A^T A - I|, within 8 u.
[[nodiscard]] inline double axis_defect(const Obb& box) {
    const std::array<Vec3, 3>& axes = box.axes;
    const double lengths =
        largest(std::fabs(dot(axes[0], axes[0]) - 1), std::fabs(dot(axes[1], axes[1]) - 1),
                std::fabs(dot(axes[2], axes[2]) - 1));
    return larger(lengths,
                  largest(std::fabs(dot(axes[0], axes[1])), std::fabs(dot(axes[1], axes[2])),
                          std::fabs(dot(axes[2], axes[0]))));
}
[[nodiscard]] inline double axis_defect(const Triangle&) { return 0; }

// A bound on the tables' relative error for two shapes, as kAxisError is for all; measured only
// where that leaves a doubt.
template <typename A, typename B>
[[nodiscard]] double axis_error(const A& a, const B& b) {
    return 16 * (axis_defect(a) + axis_defect(b)) + 512 * kUnitRoundoff;
}

[[nodiscard]] inline bool is_one_direction(const Vec3& u, const Vec3& v) {
    return u == v || u == -v || is_surely_parallel(u, v);
}

// Legend: c_ij = A_i . B_j, t = A^T D with D = C_1 - C_0, a and b the half extents, R_0 and R_1 the
// radii, w = B's velocity less A's.
template <bool kMoving, typename Visit>
bool visit_bounds(const Obb& box_a, const Obb& box_b, const Vec3& velocity, double duration,
                  double axis_error, Visit&& visit) {
    const Vec3 d = box_b.center - box_a.center;
    const Vec3 a = box_a.half_extents;
    const Vec3 b = box_b.half_extents;
    double reach = norm_1(d) + (a.x + a.y + a.z) + (b.x + b.y + b.z);
    Vec3 w{0, 0, 0};
    if constexpr (kMoving) {
        w = {dot(box_a.axes[0], velocity), dot(box_a.axes[1], velocity),
             dot(box_a.axes[2], velocity)};
        reach += duration * norm_1(velocity);
    }
    const double error = axis_error * reach + kUnderflow;
    const auto bound = [&](double distance, double radius, double speed) {
        return AxisBound{-radius - distance, radius - distance, speed, error};
    };

    std::array<std::array<double, 3>, 3> c, r;
    std::array<double, 3> t;
    for (std::uint8_t i = 0; i < 3; ++i) {
        t[i] = dot(box_a.axes[i], d);
        for (std::size_t j = 0; j < 3; ++j) {
            c[i][j] = dot(box_a.axes[i], box_b.axes[j]);
            r[i][j] = std::fabs(c[i][j]);
        }
        const double radius = a[i] + (b.x * r[i][0] + b.y * r[i][1] + b.z * r[i][2]);
        if (visit({AxisKind::kFaceA, i, i}, bound(t[i], radius, w[i]))) {
            return true;
        }
    }
    for (std::uint8_t j = 0; j < 3; ++j) {
        const double distance = t[0] * c[0][j] + t[1] * c[1][j] + t[2] * c[2][j];
        const double radius = b[j] + (a.x * r[0][j] + a.y * r[1][j] + a.z * r[2][j]);
        const double speed = kMoving ? w.x * c[0][j] + w.y * c[1][j] + w.z * c[2][j] : 0;
        if (visit({AxisKind::kFaceB, j, j}, bound(distance, radius, speed))) {
            return true;
        }
    }
    for (std::uint8_t i = 0; i < 3; ++i) {
        const std::size_t i1 = (i + 1u) % 3, i2 = (i + 2u) % 3;
        for (std::uint8_t j = 0; j < 3; ++j) {
            const std::size_t j1 = (j + 1u) % 3, j2 = (j + 2u) % 3;
            // A_i x B_j = c_i1j A_i2 - c_i2j A_i1, and zero where the two are one direction.
            const double distance = t[i2] * c[i1][j] - t[i1] * c[i2][j];
            const double radius =
                (a[i1] * r[i2][j] + a[i2] * r[i1][j]) + (b[j1] * r[i][j2] + b[j2] * r[i][j1]);
            if (radius <= kAxisError * reach && is_one_direction(box_a.axes[i], box_b.axes[j])) {
                continue;
            }
            const double speed = kMoving ? w[i2] * c[i1][j] - w[i1] * c[i2][j] : 0;
            if (visit({AxisKind::kEdgeEdge, i, j}, bound(distance, radius, speed))) {
                return true;
            }
        }
    }
    return false;
}

} // namespace obb
