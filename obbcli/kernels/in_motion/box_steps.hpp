// How long boxes of two moving bodies stay apart: four pairs of a box and an axis set at once.
#pragma once

#include "in_motion/advancement.hpp"
#include "in_motion/moving_boxes.hpp"

#include <array>

namespace obb {

// Times for which the first boxes of A and B, and the second, are proven apart from now on: 0 where
// no face axis shows a gap, infinite where they never meet. It takes less to say how far within
// `wanted` they are apart.
[[nodiscard]] std::array<double, 2> box_steps(const LaneMotion& motion, const PlacedBoxes& boxes,
                                              const MovingFrame& frame, double wanted);

} // namespace obb
