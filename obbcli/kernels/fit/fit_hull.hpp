// Orientation of a box from the convex hull of what it holds. Eberly 2008 §6.1.
#pragma once

#include "fit/convex_hull.hpp"
#include "fit/fit.hpp"

#include <span>

namespace obb {

// Axes by the spread of the hull's surface (§6.1.2, §6.1.3), that of its edges or corners where it
// has none. Of more than 64 hull vertices those farthest out count.
[[nodiscard]] std::array<Vec3, 3> hull_axes(std::span<const Vec3> points);

// The same of a hull that is there.
[[nodiscard]] std::array<Vec3, 3> hull_axes(std::span<const Vec3> points, const ConvexHull& hull);

// The quaternion of Fit::kHull or Fit::kMinVolume for the corners of a node's triangles. The root's
// box of least volume is searched for thoroughly; below, searching further made trees no
// smaller in sum.
[[nodiscard]] std::array<float, 4> hull_rotation(std::span<const Vec3> points, Fit fit,
                                                 bool is_root);

} // namespace obb
