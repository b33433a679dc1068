// Does the ray from a point towards +z or -z pass through a triangle, and which way?
#pragma once

#include "numbers/vec.hpp"
#include "shapes/triangle.hpp"

namespace obb {

struct RayCrossing {
    // 1 or -1 where it meets the triangle: towards +z, 1 where that turns anticlockwise from above,
    // towards -z the other way round.
    int turn = 0;
    bool is_tested = false; // the boxes of the two did not settle it
    bool is_exact = false;  // rounding could not decide, big integers did
};

// The sum of all turns of a closed surface is its winding number around a point that does not lie
// on it, whichever way the ray goes: where it would meet an edge, it is moved aside by what is
// infinitely small. The whole line through the point meets as many triangles turning one way as the
// other.
[[nodiscard]] RayCrossing ray_crossing(const Triangle& triangle, const Vec3& point,
                                       bool is_down = false);

} // namespace obb
