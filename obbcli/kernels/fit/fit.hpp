// Orientation of a box from the spread of what it holds. Eberly 2008 §6.1.2, §6.1.3.
#pragma once

#include "numbers/registers.hpp"
#include "shapes/triangle.hpp"
#include "tree/node.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace obb {

enum class Fit { kTriangles, kPoints, kHull, kMinVolume, kAxisAligned };

// Whether boxes are oriented by sums over their triangles; else by the hull, or not at all.
[[nodiscard]] constexpr bool fits_by_moments(Fit fit) {
    return fit == Fit::kTriangles || fit == Fit::kPoints;
}
[[nodiscard]] constexpr bool fits_by_hull(Fit fit) {
    return fit == Fit::kHull || fit == Fit::kMinVolume;
}

// Sums over triangles from which mean and covariance follow; taken about a reference point near
// them, or the differences would cancel. Of each triangle: w s, and w (sum_j P_j P_j^T + s s^T)
// with s the sum of its corners P_j, or 4 w sum_j P_j P_j^T where it stands for its corners.
struct Moments {
    double weight = 0;
    std::array<double, 3> first{};
    std::array<double, 6> second{}; // xx, xy, xz, yy, yz, zz

    [[nodiscard]] bool is_empty() const { return !(weight > 0); }
    // One triangle relative to the reference point, by its area or by its corners.
    void add(const Triangle& t, bool by_corners);
    void add(const Moments& other) {
        weight += other.weight;
        for (std::size_t i = 0; i < 3; ++i) {
            first[i] += other.first[i];
        }
        for (std::size_t k = 0; k < 6; ++k) {
            second[k] += other.second[k];
        }
    }
};

// Moments in the making, some triangles at a time.
template <typename Reals>
struct MomentSums {
    Reals weight;
    std::array<Reals, 3> first;
    std::array<Reals, 6> second;

    // Triangles relative to the reference point; `counts` is 1 in the lanes that hold one, else 0.
    // By area, or, for Fit::kPoints and sets of no area at all, by corners.
    OBB_INLINE void add(const LaneTriangles<Reals>& p, const Reals& counts, bool by_corners) {
        std::array<Reals, 3> s, e, f;
        unrolled<3>([&](auto i) {
            s[i] = p[0][i] + p[1][i] + p[2][i];
            e[i] = p[1][i] - p[0][i];
            f[i] = p[2][i] - p[0][i];
        });
        const Reals x = e[1] * f[2] - e[2] * f[1];
        const Reals y = e[2] * f[0] - e[0] * f[2];
        const Reals z = e[0] * f[1] - e[1] * f[0];
        const Reals w = by_corners ? counts : counts * root_of(x * x + y * y + z * z);
        const Reals corner_share = by_corners ? 4 : 1, sum_share = by_corners ? 0 : 1;
        weight += w;
        unrolled<3>([&](auto i) { first[i] += w * s[i]; });
        unrolled<6>([&](auto k) {
            constexpr std::size_t i = k < 3 ? 0 : k < 5 ? 1 : 2, j = k < 3 ? k : k < 5 ? k - 2 : 2;
            const Reals corners = p[0][i] * p[0][j] + p[1][i] * p[1][j] + p[2][i] * p[2][j];
            second[k] += w * (corner_share * corners + sum_share * (s[i] * s[j]));
        });
    }

    OBB_INLINE void add_to(Moments& moments) const {
        moments.weight += sum_of(weight);
        for (std::size_t i = 0; i < 3; ++i) {
            moments.first[i] += sum_of(first[i]);
        }
        for (std::size_t k = 0; k < 6; ++k) {
            moments.second[k] += sum_of(second[k]);
        }
    }
};

// Where the axes of a box point: the stored quaternion, and the rows that it stands for.
struct Orientation {
    std::array<float, 4> rotation{1, 0, 0, 0};
    std::array<Vec3, 3> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    std::size_t widest = 0; // the axis along which what is in the box varies most
};

// More than fit a register: each step waits for divisions and roots, which several can do at once.
inline constexpr std::size_t kOrientationsAtOnce = 8;

// Quaternion (w, x, y, z) in float32 of right-handed orthonormal rows.
[[nodiscard]] std::array<float, 4> quaternion_of(const std::array<Vec3, 3>& axes);

// Orthonormal rows, the eigenvectors of the covariance matrix; right-handed.
[[nodiscard]] std::array<Vec3, 3> principal_axes(const Moments& moments);

// The eigenvectors of the covariance matrices; the axes of coordinates where moments are empty.
void orient(std::span<const Moments, kOrientationsAtOnce> moments,
            std::span<Orientation, kOrientationsAtOnce> orientations);

} // namespace obb
