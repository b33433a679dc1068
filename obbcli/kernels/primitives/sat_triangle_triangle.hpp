// Separating axes of two triangles, Eberly 2008 §4.1 and 4.2, Table 5.
// Coplanar and degenerate triangles have no certain verdict here: their axes (Table 6) are exact.
#pragma once

#include "primitives/axis.hpp"
#include "primitives/sat.hpp"
#include "shapes/extremes.hpp"
#include "shapes/triangle.hpp"

#include <array>

namespace obb {

// Legend: E_i = A_{i+1} - A_i, F_j = B_{j+1} - B_j (cyclic, so E_2 and F_2 differ from the paper's
// E_1 and F_1 in sign and order), N = E_0 x E_1, M = F_0 x F_1, w = B's velocity less A's.
// Every product below is a triple product of once rounded differences: gamma_8 times its permanent.
template <bool kMoving, typename Visit>
bool visit_bounds(const Triangle& a, const Triangle& b, const Vec3& w, double duration,
                  double /*axis_error*/, Visit&& visit) {
    constexpr double kError = 16 * kUnitRoundoff;
    const std::array<Vec3, 3> e{a[1] - a[0], a[2] - a[1], a[0] - a[2]};
    const std::array<Vec3, 3> f{b[1] - b[0], b[2] - b[1], b[0] - b[2]};
    const std::array<double, 3> e_size{norm_1(e[0]), norm_1(e[1]), norm_1(e[2])};
    const std::array<double, 3> f_size{norm_1(f[0]), norm_1(f[1]), norm_1(f[2])};
    const Vec3 d = b[0] - a[0];
    const double reach = norm_1(d) + largest(e_size[0], e_size[1], e_size[2]) +
                         largest(f_size[0], f_size[1], f_size[2]);
    // How far B's vertices are from A's until the end, and the error of a product per its size.
    const double unit = kError * (reach + (kMoving ? duration * norm_1(w) : 0));
    const Vec3 n = cross(e[0], e[1]);
    const Vec3 m = cross(f[0], f[1]);
    const double n_size = kError * (e_size[0] * e_size[1]);
    const double m_size = kError * (f_size[0] * f_size[1]);

    const auto bound = [&](const Vec3& axis, double low, double high, double error) {
        return AxisBound{low, high, kMoving ? dot(axis, w) : 0, error + kUnderflow};
    };
    // Axis N: A at 0, B at N.D and the rest. Axis M: the other way round.
    const std::array<double, 3> nf{dot(n, f[0]), dot(n, f[1]), dot(n, f[2])};
    const std::array<double, 3> me{dot(m, e[0]), dot(m, e[1]), dot(m, e[2])};
    {
        const double q = dot(n, d);
        const double high = largest(q, q + nf[0], q - nf[2]);
        const double low = smallest(q, q + nf[0], q - nf[2]);
        const double error = 3 * unit * (e_size[0] * e_size[1]);
        if (visit({AxisKind::kFaceA, 0, 0}, bound(n, -high, -low, error))) {
            return true;
        }
    }
    {
        const double q = dot(m, d);
        const double high = largest(0.0, me[0], -me[2]);
        const double low = smallest(0.0, me[0], -me[2]);
        const double error = 3 * unit * (f_size[0] * f_size[1]);
        if (visit({AxisKind::kFaceB, 0, 0}, bound(m, low - q, high - q, error))) {
            return true;
        }
    }
    // Axes E_i x F_j: A at {0, -N.F_j} from A_i, B at {q, q + M.E_i}.
    for (std::uint8_t i = 0; i < 3; ++i) {
        for (std::uint8_t j = 0; j < 3; ++j) {
            const Vec3 axis = cross(e[i], f[j]);
            if (axis == Vec3{0, 0, 0} && is_surely_parallel(e[i], f[j])) {
                continue;
            }
            const double q = dot(axis, b[j] - a[i]);
            const double high_a = larger(0.0, -nf[j]);
            const double low_a = smaller(0.0, -nf[j]);
            const double high_b = q + larger(0.0, me[i]);
            const double low_b = q + smaller(0.0, me[i]);
            const double error = f_size[j] * (e_size[i] * unit + n_size) + e_size[i] * m_size;
            if (visit({AxisKind::kEdgeEdge, i, j},
                      bound(axis, low_a - high_b, high_a - low_b, error))) {
                return true;
            }
        }
    }
    return false;
}

} // namespace obb
