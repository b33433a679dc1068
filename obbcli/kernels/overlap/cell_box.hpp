// The boxes that branch and bound over points lives in: each in a frame of its own.
#pragma once

#include "numbers/vec.hpp"
#include "shapes/obb.hpp"

#include <array>
#include <cstddef>

namespace obb {

// The box *is* the image of the local one: all points sum_j q_j axes[j] with low_j <= q_j <=
// high_j. The axes are as they are stored; that they are about orthonormal is of use, but no proof
// leans on it. Halves of a box share the number at which it is cut, so that nothing is between
// them.
struct CellBox {
    std::array<Vec3, 3> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    Vec3 low{0, 0, 0}, high{0, 0, 0};

    using Corners = std::array<Vec3, 8>;

    [[nodiscard]] Vec3 at(const Vec3& q) const {
        return q.x * axes[0] + (q.y * axes[1] + q.z * axes[2]);
    }
    [[nodiscard]] Vec3 local(const Vec3& p) const {
        return {dot(axes[0], p), dot(axes[1], p), dot(axes[2], p)};
    }
    // Bit j of the number tells which end of axis j.
    [[nodiscard]] static Vec3 end_of(const Vec3& low, const Vec3& high, std::size_t k) {
        return {k & 1U ? high.x : low.x, k & 2U ? high.y : low.y, k & 4U ? high.z : low.z};
    }
    [[nodiscard]] Corners corners(double pad = 0) const {
        const Vec3 more{pad, pad, pad};
        Corners result;
        for (std::size_t k = 0; k < result.size(); ++k) {
            result[k] = at(end_of(low - more, high + more, k));
        }
        return result;
    }
    [[nodiscard]] Vec3 width() const { return high - low; }
    [[nodiscard]] Vec3 middle() const { return 0.5 * (low + high); }
    [[nodiscard]] double volume() const {
        const Vec3 w = width();
        return w.x * w.y * w.z;
    }
    [[nodiscard]] Obb obb() const { return {at(middle()), axes, 0.5 * width()}; }
};

inline constexpr double kDiagonal = 1.7321; // of a unit cube, rounded up

// How far a computed corner is from the exact one, in a frame where no coordinate exceeds 1 by more
// than a little: local coordinates are at most sqrt(3), their row of the matrix is at most 1 long,
// both up to 1e-6, so that a coordinate is a sum of three products of at most sqrt(3) together
// (Cauchy-Schwarz), off by 3 u of that. Over three coordinates: 9.1 u.
inline constexpr double kCornerError = 10 * kUnitRoundoff;

// What a box is grown by where something is to hold for all of its points in spite of rounding: of
// its corners, of its middle and half widths (2 u each, times sqrt(3)), and of a point that was
// rounded on its way to the world and back.
inline constexpr double kCellPad = 32 * kUnitRoundoff;

} // namespace obb
