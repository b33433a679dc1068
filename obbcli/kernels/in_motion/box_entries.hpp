// When boxes under a constant velocity may first and last touch: four pairs at once.
#pragma once

#include "in_motion/moving_boxes.hpp"
#include "numbers/vec.hpp"

#include <array>

namespace obb {

// How two bodies stand to each other at a time, and how they go on from there for a span. What a
// projection may be off by is `relative` times the sizes in play, plus `absolute`.
struct ClosingFrame {
    Vec3 between;  // B's coordinates less A's
    Vec3 velocity; // B's less A's
    double span;
    double relative, absolute;
};

// Pair by pair: no contact within the span before `entry` nor after `exit`; none at all where entry
// is the greater.
struct BoxEntries {
    std::array<double, 4> entry, exit;
};

// Two boxes of A and two of B: entry 2 i + j is that of A's i-th and B's j-th.
[[nodiscard]] BoxEntries box_entries(const PlacedBoxes& boxes, const ClosingFrame& frame);

} // namespace obb
