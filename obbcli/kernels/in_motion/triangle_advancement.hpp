// Steps for pairs of moving triangles.
#pragma once

#include "in_motion/advancement.hpp"
#include "shapes/triangle.hpp"

#include <array>
#include <cstdint>

namespace obb {

// One triangle at one time, relative to its body's pivot.
struct SpinningTriangle {
    Triangle points;
    std::array<Vec3, 3> velocities; // W x points
    std::array<double, 3> radii;    // distances from the axis, rounded up
    double size;                    // largest |point|_1

    SpinningTriangle(const Triangle& t, const Spin& spin);
};

// The axis of the longest step, and what it separates.
struct TriangleStep {
    double time = 0;      // proven apart for so long from now on; 0 where nothing is proven
    double gap = 0;       // the widest between projections, before any error is taken off
    Vec3 normal{0, 0, 0}; // unit, from A to B
};

// Axes fixed in the world, and the best of them fixed in A and in B as well: a gap between faces
// that turn together closes slowly only when looked at from one of them. For a clearance the
// direction between the closest points must be among the axes; it is passed as `hint` (or zero).
[[nodiscard]] TriangleStep triangle_step(const SpinningTriangle& a, const SpinningTriangle& b,
                                         const MovingFrame& frame, Vec3 hint);

} // namespace obb
