// One box of a tree in one cache line.
#pragma once

#include "shapes/obb.hpp"

#include <array>
#include <cstdint>

namespace obb {

// Lengths are in the tree's unit: mesh units times a power of two that brings the largest
// coordinate into [1/2, 1). The centre is a double and the orientation a quaternion, so every
// rounding is relative to the box itself: a float32 quaternion turns into axes orthonormal to a few
// ulps of double, where nine float32 direction cosines would be skew by 1e-7 and leak the long
// extents into the thin ones.
struct alignas(64) Node {
    Vec3 center;
    std::array<float, 3> half_extents; // rounded up
    std::array<float, 4> rotation;     // quaternion (w, x, y, z), any length but zero
    std::uint32_t split;               // where the range of triangles is parted; 0 in a leaf
    std::uint32_t right; // slot of the right child's box; the left child's is the next
    std::uint32_t reserved;
};
static_assert(sizeof(Node) == 64);

// A box that stands where there is none.
inline constexpr Node kNoBox{{0, 0, 0}, {0, 0, 0}, {1, 0, 0, 0}, 0, 0, 0};

// Axes of the box, as rows. This function *defines* the box: containment is proven for its results.
template <typename Real>
[[nodiscard]] inline std::array<Vector3<Real>, 3> axes_of_quaternion(Real w, Real x, Real y,
                                                                     Real z) {
    const Real s = 2.0 / (w * w + x * x + y * y + z * z);
    const Real wx = s * w * x, wy = s * w * y, wz = s * w * z;
    const Real xx = s * x * x, xy = s * x * y, xz = s * x * z;
    const Real yy = s * y * y, yz = s * y * z, zz = s * z * z;
    return {{{1.0 - yy - zz, xy + wz, xz - wy},
             {xy - wz, 1.0 - xx - zz, yz + wx},
             {xz + wy, yz - wx, 1.0 - xx - yy}}};
}

[[nodiscard]] inline std::array<Vec3, 3> axes_of(const std::array<float, 4>& q) {
    return axes_of_quaternion<double>(q[0], q[1], q[2], q[3]);
}

[[nodiscard]] inline Vec3 half_extents_of(const Node& node) {
    return {node.half_extents[0], node.half_extents[1], node.half_extents[2]};
}

} // namespace obb
