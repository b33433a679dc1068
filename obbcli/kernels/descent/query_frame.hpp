// The frame in which two posed trees are compared: A's own, scaled by one power of two.
#pragma once

#include "at_rest/static_query.hpp"
#include "descent/box_tests.hpp"

namespace obb {

// What comparing boxes in that frame costs in certainty.
struct QueryFrame {
    int exponent;        // its unit is 2^exponent mesh units: no coordinate exceeds it
    RoundingBound bound; // for boxes against the posed vertices, rounded to double
    // A length in the frame times this is at most the length in the world: axes and rotations are
    // orthonormal only up to roundoff and to what poses are allowed.
    double shrink;
};

// Sets the frames of both bodies. Throws std::domain_error where posed coordinates would leave the
// range of double.
[[nodiscard]] QueryFrame set_common_frame(PosedTree& a, PosedTree& b);

} // namespace obb
