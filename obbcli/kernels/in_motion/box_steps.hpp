// How long boxes of two moving bodies stay apart: four pairs of a box and an axis set at once.
#pragma once

#include "descent/placed_boxes.hpp"
#include "in_motion/advancement.hpp"

#include <array>

namespace obb {

// Both bodies' motions at one time, A's in the lower half of the lanes, B's in the upper one.
struct LaneMotion : LaneFrame { // about the pivots, at the present time
    // Constant.
    Vector3<Four> velocity;                       // of the spins
    Vector3<Four> axis;                           // unit; zero where still
    alignas(kAlignment<Four>) Four speed, square; // of the spins; the square rounded up
    alignas(kAlignment<Four>) FourMask is_still;
    alignas(kAlignment<Four>) Four skew;  // bounds how far from orthonormal axes of either body are
    std::array<Vector3<Four>, 3> columns; // of the poses' rotations
    Vector3<Four> offset;                 // of the poses, from the pivots
};

// Sets the frame to where both have turned, with the bits of Spin::matrix().
void set_turns(LaneMotion& motion, const Turn& a, const Turn& b);

// Times for which two pairs, lane k of A's boxes with lane 2 + k of B's, are proven apart from now
// on. Positions are relative to each body's own pivot: 0 where no face axis shows a gap,
// infinite where they never meet. It takes less to say how far within `wanted` they are apart.
[[nodiscard]] std::array<double, 2> box_steps(const LaneMotion& motion, const BasicObb<Four>& boxes,
                                              const MovingFrame& frame, double wanted);

} // namespace obb
