// A common point of two shapes that overlap with more than their surfaces.
#pragma once

#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

namespace obb {

// Within rounding of both shapes, whose coordinates must be below one.
template <typename A, typename B>
[[nodiscard]] Vec3 overlap_point(const A& a, const B& b);

} // namespace obb
