// Proves that a tree is what it claims to be, or says where it is not.
#pragma once

#include "tree/tree.hpp"

#include <optional>
#include <string>
#include <vector>

namespace obb {

// Checks that every triangle lies under exactly one leaf and in every box above it, that the boxes
// stand in depth-first order without gaps, and that sizes add up. Containment is proven in double
// arithmetic with its rounding counted against the box. O(n depth).
// Returns what is wrong, or nothing.
[[nodiscard]] std::optional<std::string> tree_check(const TreeView& tree, std::uint32_t leaf_size,
                                                    std::uint32_t max_depth);

// Boxes of one depth: how many, and the sum of their volumes in cubes of the tree's unit.
struct Level {
    std::uint64_t box_count = 0;
    std::uint64_t leaf_count = 0; // boxes without children, and triangles that need no box
    double volume = 0;
};

// One entry for each depth that holds a box or a triangle.
[[nodiscard]] std::vector<Level> tree_levels(const TreeView& tree);

} // namespace obb
