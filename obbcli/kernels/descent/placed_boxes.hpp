// Boxes of two trees in one frame, two of A and two of B at once.
#pragma once

#include "descent/box_tests.hpp"
#include "shapes/lanes.hpp"
#include "tree/node.hpp"

#include <array>

namespace obb {

// From the coordinates of either tree to the frame: x -> matrix * (node_scale * x) + shift. A's in
// the lower half of the lanes, B's in the upper one.
struct LaneFrame {
    alignas(kAlignment<Four>) Four node_scale;
    std::array<Vector3<Four>, 3> matrix; // rows
    Vector3<Four> shift;
};

// In the order of the lanes: two of A, two of B.
using FourNodes = std::array<const Node*, 4>;

void place_boxes(const LaneFrame& frame, const FourNodes& nodes, BasicObb<Four>& boxes);

} // namespace obb
