// Separating axes of a box and a triangle, Eberly 2008 §3.1 and 3.2, Table 3.
#pragma once

#include "primitives/axis.hpp"
#include "primitives/sat.hpp"
#include "primitives/sat_obb_obb.hpp"
#include "shapes/extremes.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

#include <array>

namespace obb {

// Legend: y = A^T (U - C) takes the triangle into the box's coordinates, where A_i are the
// coordinate axes; e_j = y_{j+1} - y_j (cyclic), n = e_0 x e_1, w = B's velocity less A's.
// Coordinates, at any time until the end, are off by less than `blur`; a product of two edges, so
// off by 2 blur, with a third factor by less than 6 blur times the other two sizes.
template <bool kMoving, typename Visit>
bool visit_bounds(const Obb& a, const Triangle& b, const Vec3& velocity, double duration,
                  double axis_error, Visit&& visit) {
    const Vec3 h = a.half_extents;
    std::array<Vec3, 3> y;
    double reach = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 d = b[k] - a.center;
        y[k] = {dot(a.axes[0], d), dot(a.axes[1], d), dot(a.axes[2], d)};
        reach = larger(reach, norm_1(d));
    }
    reach += h.x + h.y + h.z;
    Vec3 w{0, 0, 0};
    if constexpr (kMoving) {
        w = {dot(a.axes[0], velocity), dot(a.axes[1], velocity), dot(a.axes[2], velocity)};
        reach += duration * norm_1(velocity);
    }
    const double blur = axis_error * reach + kUnderflow;

    const std::array<Vec3, 3> e{y[1] - y[0], y[2] - y[1], y[0] - y[2]};
    const Vec3 n = cross(e[0], e[1]);
    {
        const double q = dot(n, y[0]);
        const double radius = dot(abs(n), h);
        const double size = norm_1(e[0]) + norm_1(e[1]);
        const double error = 6 * blur * size * reach + kUnderflow;
        if (visit({AxisKind::kFaceB, 0, 0},
                  {-q - radius, radius - q, kMoving ? dot(n, w) : 0, error})) {
            return true;
        }
    }
    for (std::uint8_t i = 0; i < 3; ++i) {
        const double high = largest(y[0][i], y[1][i], y[2][i]);
        const double low = smallest(y[0][i], y[1][i], y[2][i]);
        if (visit({AxisKind::kFaceA, i, i}, {-h[i] - high, h[i] - low, w[i], blur})) {
            return true;
        }
    }
    for (std::uint8_t i = 0; i < 3; ++i) {
        const std::size_t i1 = (i + 1u) % 3, i2 = (i + 2u) % 3;
        for (std::uint8_t j = 0; j < 3; ++j) {
            // A_i x e_j has the components 0, -e_j[i2], e_j[i1].
            const double l1 = -e[j][i2], l2 = e[j][i1];
            if (l1 == 0 && l2 == 0 && is_surely_parallel(a.axes[i], b[(j + 1u) % 3] - b[j])) {
                continue;
            }
            // Both ends of edge j are at the same place.
            const double q = l1 * y[j][i1] + l2 * y[j][i2];
            const Vec3& opposite = y[(j + 2u) % 3];
            const double q2 = l1 * opposite[i1] + l2 * opposite[i2];
            const double radius = h[i1] * std::fabs(l1) + h[i2] * std::fabs(l2);
            const double size = std::fabs(l1) + std::fabs(l2);
            const double error = 4 * blur * (reach + size) + kUnderflow;
            if (visit({AxisKind::kEdgeEdge, i, j},
                      {-radius - larger(q, q2), radius - smaller(q, q2),
                       kMoving ? l1 * w[i1] + l2 * w[i2] : 0, error})) {
                return true;
            }
        }
    }
    return false;
}

} // namespace obb
