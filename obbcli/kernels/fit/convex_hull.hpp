// Convex hull of points in space, whatever their number and rank: what the fits by hull stand on.
#pragma once

#include "numbers/vec.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace obb {

// Indices are those of the points.
struct ConvexHull {
    int rank = 0; // dimension that the points span: 0 one point, 1 a segment, 2 a polygon, 3 a body
    // A point, the ends of a segment, the corners of a polygon in order, or those of a body as they
    // were found: the farthest out first.
    std::vector<std::uint32_t> vertices;
    // Counter-clockwise seen from outside, closed and convex; of a polygon the fan of one side.
    std::vector<std::array<std::uint32_t, 3>> triangles;
    // Of a body: the triangle beyond the edge from corner i to corner i + 1.
    std::vector<std::array<std::uint32_t, 3>> neighbors;
};

// The hull of the points on a grid: 2^40 steps, or up to twice as many, along each coordinate's own
// extent, rounded to the nearest. On the grid all signs are exact, so that it never fails, and
// coincident, collinear and coplanar points are no special case. Every vertex is one of the points,
// and along no coordinate does a point lie further outside than two steps. No coordinate may exceed
// 2^500; extents below 2^-900 count as none. The order of the points changes nothing but the
// indices, and which of the points on one place of the grid stands for them.
//
// A body's hull ends early once it took in `max_vertices` points, at least 4. Those farthest from
// what is there are taken first, so that what is left out is as near as this rule can have it.
[[nodiscard]] ConvexHull
convex_hull(std::span<const Vec3> points,
            std::size_t max_vertices = std::numeric_limits<std::size_t>::max());

} // namespace obb
