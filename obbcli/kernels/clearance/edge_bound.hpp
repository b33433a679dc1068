// A lower bound on the distance of two triangles along the moving product of an edge of each.
#pragma once

#include "clearance/relative_motion.hpp"
#include "shapes/triangle.hpp"

namespace obb {

// A triangle about its body's pivot, and one of its edges.
struct EdgedTriangle {
    const Triangle& corners;
    Vec3 edge;
};

// Holds for half an interval before and after, but for what the corners themselves are off by.
// Negative where nothing is proven.
//
// N(s) = e_x x e_y(s) stays across both edges, so that a gap between them closes to second order
// only. With n0 its direction and g the gap along it at s = 0, and f(s) the least of
// N . (y - x - g n0) over all corners, the gap along N at s is g + (f + g (N . n0 - |N|)) / |N|;
// and |N| is at most N . n0 + |N across n0|^2 / (2 N . n0).
[[nodiscard]] double bound_edges(const RelativeMotion& motion, double half, const EdgedTriangle& x,
                                 const EdgedTriangle& y);

} // namespace obb
