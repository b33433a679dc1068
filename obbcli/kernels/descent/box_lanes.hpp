// Which of eight pairs of boxes are apart, in floats: two pairs of nodes at a time, each opened
// into two boxes of A and two of B.
#pragma once

#include "descent/box_tests.hpp"
#include "descent/posed_tree.hpp"
#include "tree/node.hpp"

#include <array>
#include <cstddef>

namespace obb {

// How the boxes of two trees come into their common frame, which is A's own: lane by lane for what
// is turned and scaled in floats, in doubles for what keeps the digits of a far scene.
struct EightFrame {
    // Of A's lanes and B's: the nodes' unit and rows of the matrix.
    alignas(32) std::array<float, 8> node_scale;
    alignas(32) std::array<std::array<std::array<float, 8>, 3>, 3> matrix;
    // The unit of A's nodes; rows of B's matrix times the unit of B's nodes, and B's offset.
    alignas(32) std::array<double, 4> scale_a;
    alignas(32) std::array<std::array<std::array<double, 4>, 4>, 3> rows_b;
    alignas(32) std::array<float, 8> relative, absolute; // see box_lanes.cpp

    // Of bodies in their common frame. A's frame has to be its own.
    void set(const PosedTree& a, const PosedTree& b, const RoundingBound& bound);
};

// Two boxes of A and two of B, then two of A and two of B of another pair. None is a null pointer.
using EightNodes = std::array<const Node*, 8>;

// The pairs that lanes stand for: A's kOfA[k] and B's kOfB[k] in lane k, and so in lane 4 + k.
inline constexpr std::array<std::size_t, 4> kOfA{0, 1, 0, 1}, kOfB{0, 1, 1, 0};

struct EightVerdicts {
    // Bits by lane. Boxes are proven apart; or their faces leave open whether doubles might prove
    // it; or any axis does.
    unsigned apart, open_by_faces, open;
    alignas(32) std::array<float, 8> nearness; // the centres' distance, by the sum of coordinates
};

// What it says to be apart is, as are_separated() would say. Boxes that are no numbers never are.
void judge_boxes(const EightFrame& frame, const EightNodes& nodes, EightVerdicts& verdicts);

} // namespace obb
