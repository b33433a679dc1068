// The least rectangle about a convex polygon.
#pragma once

#include "numbers/vec.hpp"

#include <vector>

namespace obb {

struct PolygonEdge {
    double x, y;
    double turn = 0; // grows with the direction's angle
};

struct Rectangle {
    double length, width; // along and across the direction
    double x, y;          // direction of unit length; zero where no edge has a length
};

// Edges of a convex polygon, counter-clockwise, in any order: sorted by angle they are the polygon.
// Among the least rectangles one has a side along an edge (Freeman and Shapira 1975); all such
// sides are tried by turning four supporting lines once (Toussaint 1983). O(n log n).
// Rounding can only cost area: the directions are good whatever order it leads to.
[[nodiscard]] Rectangle least_rectangle(std::vector<PolygonEdge>& edges);

// Two unit vectors that make a right-handed frame with a third.
struct Frame {
    Vec3 u, v;
    explicit Frame(Vec3 n);
};

} // namespace obb
