// When boxes under a constant velocity may first and last touch, in floats: eight pairs at once,
// two pairs of nodes that are each opened into two boxes of A and two of B.
#pragma once

#include "in_motion/moving_pair.hpp"
#include "tree/node.hpp"

#include <array>
#include <cstddef>

namespace obb {

// How the boxes of two trees come into A's own frame, lane by lane: in floats for what is turned
// and scaled, in doubles for what keeps the digits of a far scene.
struct RayFrame {
    // Of A's lanes and B's: the nodes' unit and rows of the matrix.
    std::array<float, 8> node_scale;
    std::array<std::array<std::array<float, 8>, 3>, 3> matrix;
    // Times A's unit; B's rows times B's unit, and where B's centres are at t = 0.
    double scale_a;
    std::array<std::array<double, 4>, 3> rows_b;
    Vec3 velocity; // of B as A sees it
    float speed;   // bounds the sum of its coordinates
    float relative, absolute;

    // What a projection may be off by in floats, of the sizes in play; ray_boxes.cpp proves it.
    static constexpr float kRelative = 0x1p-16F;

    RayFrame() = default;
    // Of bodies that do not turn.
    explicit RayFrame(const MovingPair& pair);
};

// A pair of nodes that is opened: two boxes of A and two of B, and from when on for how long they
// are looked at, scaled.
struct RayOpening {
    std::array<const Node*, 4> nodes{&kNoBox, &kNoBox, &kNoBox, &kNoBox};
    double time = 0, span = 0;
};

// The pairs that lanes stand for: A's kOfA[k] and B's kOfB[k] in lane k, and so in lane 4 + k.
inline constexpr std::array<std::size_t, 4> kRayOfA{0, 1, 0, 1}, kRayOfB{0, 1, 1, 0};

// Lane by lane: no contact within the span before `entry` nor after `exit`, from the time on; none
// at all where entry is the greater.
struct EightEntries {
    std::array<float, 8> entry, exit;
};

void enter_boxes(const RayFrame& frame, const std::array<RayOpening, 2>& openings,
                 EightEntries& entries);

} // namespace obb
