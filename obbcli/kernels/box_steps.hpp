// How long boxes of two moving bodies stay apart: four pairs of a box and an axis set at once.
#pragma once

#include "advancement.hpp"
#include "lanes.hpp"
#include "node.hpp"

#include <array>

namespace obb {

// Both bodies' motions at one time, A's in the lower half of the lanes, B's in the upper one.
struct LaneMotion {
    // Constant.
    Vector3<Four> velocity; // of the spins
    Vector3<Four> axis;     // unit; zero where still
    Four speed, square;     // of the spins; the square rounded up
    FourMask is_still;
    Four node_scale;
    Four skew; // bounds how far from orthonormal axes of either body are
    // At the present time.
    std::array<Vector3<Four>, 3> matrix; // rows: from tree coordinates to those about the pivot
    Vector3<Four> shift;
};

// Two boxes of A and two of B; lane k of A's is paired with lane 2 + k. Positions are relative to
// each body's own pivot.
void place_boxes(const LaneMotion& motion, const std::array<const Node*, 4>& nodes,
                 BasicObb<Four>& boxes);

// Times for which the two pairs are proven apart from now on: 0 where no face axis shows a gap,
// infinite where they never meet.
[[nodiscard]] std::array<double, 2>
times_apart(const LaneMotion& motion, const BasicObb<Four>& boxes, const MovingFrame& frame);

} // namespace obb
