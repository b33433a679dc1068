// Does the ray from a point towards +z pass through a triangle, and which way?
#pragma once

#include "numbers/vec.hpp"
#include "shapes/triangle.hpp"

namespace obb {

struct RayCrossing {
    int turn = 0;           // 1 where it meets the triangle turning anticlockwise from above, -1, 0
    bool is_tested = false; // the boxes of the two did not settle it
    bool is_exact = false;  // rounding could not decide, big integers did
};

// The sum of all turns of a closed surface is its winding number around a point that does not lie
// on it: where a ray would meet an edge, it is moved aside by what is infinitely small.
[[nodiscard]] RayCrossing ray_crossing(const Triangle& triangle, const Vec3& point);

} // namespace obb
