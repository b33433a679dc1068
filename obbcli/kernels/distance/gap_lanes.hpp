// Lower bounds on how far apart eight pairs of boxes are, in floats: two pairs of nodes at a time,
// each opened into two boxes of A and two of B.
#pragma once

#include "descent/box_lanes.hpp"
#include "descent/box_tests.hpp"
#include "descent/posed_tree.hpp"

#include <array>

namespace obb {

// How the boxes come into their common frame, and what the bounds leave to rounding.
struct GapFrame : EightFrame {
    alignas(32) std::array<float, 8> of_way, of_sizes; // see gap_lanes.cpp
    double shrink = 1;                                 // a bound times this is one in the world

    // Of bodies in their common frame, which is A's own. A distance of boxes there times `factor`
    // is one in the world.
    void set(const PosedTree& a, const PosedTree& b, const RoundingBound& bound, double factor);
};

// Lane by lane, of A's box kOfA[k] and B's box kOfB[k], and so from lane 4 on.
struct EightGaps {
    alignas(32) std::array<float, 8> low;      // times the frame's `shrink` a bound on the distance
    alignas(32) std::array<float, 8> error;    // about what the bound lacks by rounding
    alignas(32) std::array<float, 8> nearness; // the centres' distance, by the sum of coordinates
};

// Boxes that are no numbers have a bound of 0.
void measure_gaps(const GapFrame& frame, const EightNodes& nodes, EightGaps& gaps);

} // namespace obb
