// Proven lower bounds on the distances of triangles, many pairs at once, so that few are measured.
#pragma once

#include "descent/posed_tree.hpp"
#include "descent/triangle_lanes.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace obb {

// A power of two as two factors, of which neither leaves the range of double.
using ScaleFactors = std::array<double, 2>;

// Up to four triangles that stand next to each other in a tree, where their body stands.
struct TriangleBlock {
    static constexpr std::uint32_t kMost = 4;
    // A number of each triangle: of the first to the last, then of the last two and the first two.
    using Row = std::array<float, 8>;

    FourTriangles corners; // in the world; the first triangle again in lanes left over
    std::uint32_t begin, count = 0;

    // What the triangles tell in floats, in the unit that brings coordinates to at most about 1,
    // and relative to the first corner.
    Vec3 origin;
    float reach; // the largest coordinate
    std::array<std::array<Row, 3>, 3> rounded;
    std::array<Row, 3> normal;                  // of length about 1, or 0 where digits are lost
    Row low_along, high_along;                  // the normal
    std::array<Row, 3> low_corner, high_corner; // of the bounding box

    // From the corners.
    void describe(const ScaleFactors& factors);
};

// The blocks of a body that were placed last, for most are asked for again and again.
class TriangleBlocks {
  public:
    // Of a range of at most kMost triangles; until the next call.
    [[nodiscard]] const TriangleBlock& placed(const PosedTree& body, const NodeRef& ref,
                                              const ScaleFactors& factors);

  private:
    std::array<TriangleBlock, 16> blocks_;
};

// Of pair k of two blocks' triangles: A's is k % 4, and B's this.
[[nodiscard]] constexpr std::uint32_t second_of_pair(std::uint32_t k) {
    return (k % 4) ^ (k / 8) ^ (k / 4 % 2 * 2);
}
// The pairs of so many triangles of A and of B, a bit each.
[[nodiscard]] constexpr unsigned pairs_of(std::uint32_t count_a, std::uint32_t count_b) {
    unsigned pairs = 0;
    for (std::uint32_t k = 0; k < 16; ++k) {
        pairs |= static_cast<unsigned>(k % 4 < count_a && second_of_pair(k) < count_b) << k;
    }
    return pairs;
}

struct BlockGaps {
    alignas(32) std::array<float, 16> lows; // of the pairs, in the unit; may be negative
    float margin;                           // what has been taken off them for rounding
    unsigned open;                          // those that are not above a limit, a bit each
    float least_of_others;                  // infinite where there are none
};

// In floats: between the bounding boxes and along both normals. Of lanes left over anything.
void measure_block(const TriangleBlock& a, const TriangleBlock& b, float limit, BlockGaps& gaps);

// Four of those pairs.
using PairsInLanes = std::array<std::uint32_t, 4>;

// In doubles, along the direction between the nearest points of edges. With the normals that is
// about the distance, for a corner is nearest a face along the face's normal. The unit is as above.
[[nodiscard]] std::array<double, 4> edge_gaps(const TriangleBlock& a, const TriangleBlock& b,
                                              const ScaleFactors& factors,
                                              const PairsInLanes& pairs);

} // namespace obb
