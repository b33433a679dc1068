// What is known of a first contact: when, along which axis, and which features meet.
#pragma once

#include "axis.hpp"
#include "vec.hpp"

#include <array>
#include <cstdint>

namespace obb {

// Constant velocities of two shapes over the closed interval [0, duration].
struct LinearMotion {
    Vec3 velocity_a{0, 0, 0};
    Vec3 velocity_b{0, 0, 0};
    double duration = 0;
};

// A vertex, edge or face: of a triangle the vertices in `points`, a bit each; of a box the part
// with y_i = signs[i] * half_extents[i] wherever signs[i] is not 0.
struct Feature {
    std::uint8_t points = 0;
    std::array<std::int8_t, 3> signs{};
    std::uint8_t dimension = 3; // 0 vertex, 1 edge, 2 face, 3 the shape as a whole
};

// Where the shapes touch without overlapping: the axis that ended last (of several with a gap of
// zero, the first in the paper's order), and the smallest faces of the shapes that hold all common
// points. No axis where the shapes overlap from the start.
struct Touch {
    AxisId axis;
    Vec3 normal{0, 0, 0}; // unit, along the axis from A to B
    Feature feature_a;
    Feature feature_b;
};

} // namespace obb
