// What is known of a first contact: when, along which axis, and which features meet.
#pragma once

#include "numbers/vec.hpp"
#include "primitives/axis.hpp"

#include <algorithm>
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

// Which features meet, as a code that Python has words for: none that could be told, those of A
// and B by their dimensions, or boxes that stand for triangles.
using FeatureCode = std::uint8_t;
constexpr FeatureCode kNoFeature = 0, kBoxFeature = 10;

// A shape as a whole counts as a face.
[[nodiscard]] constexpr FeatureCode feature_code(int dimension_a, int dimension_b) {
    return static_cast<FeatureCode>(1 + 3 * std::min(dimension_a, 2) + std::min(dimension_b, 2));
}

// Edge k of a triangle runs from vertex k to the next; its face normal is edge 0 x edge 1. The
// face normals and edges of a box are its axes.
// Where the shapes touch without overlapping: the axis that ended last (of several with a gap of
// zero, the first in the paper's order), and the smallest faces of the shapes that hold all common
// points. No axis where the shapes overlap from the start.
struct Touch {
    AxisId axis;
    std::int8_t side = 0; // +1 where B is on the side that the axis L points to, else -1
    Vec3 normal{0, 0, 0}; // unit: side * L, from A to B
    Feature feature_a;
    Feature feature_b;
};

} // namespace obb
