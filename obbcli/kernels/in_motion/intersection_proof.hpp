// Proofs that triangles meet whose vertices are known to within an error.
#pragma once

#include "shapes/triangle.hpp"

#include <span>

namespace obb {

// Whether the true triangles surely intersect, where each point is known to within `error`.
[[nodiscard]] bool surely_intersect(const Triangle& a, const Triangle& b, double error);

// Whether an edge of a triangle surely meets one of the triangles of a patch, where each point is
// known to within `error`: also where no triangle alone shows it, as the edge passes through an
// edge or a vertex that they share. Shared vertices have the same coordinates.
[[nodiscard]] bool surely_intersects_patch(const Triangle& a, std::span<const Triangle> patch,
                                           double error);

} // namespace obb
