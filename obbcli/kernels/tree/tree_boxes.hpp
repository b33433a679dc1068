// Boxes of a tree for those who look at them: of one level, or the last ones under a node.
#pragma once

#include "shapes/obb.hpp"
#include "tree/tree.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace obb {

struct ShownBox {
    NodeRef ref;
    Obb box; // mesh units
};

struct ShownBoxes {
    std::vector<ShownBox> boxes; // from left to right
    std::uint32_t deepest = 0;   // level that the walk came to
};

// All boxes of one depth. Of a tree that is made as it is used nothing below that depth is made.
[[nodiscard]] ShownBoxes boxes_of_level(const TreeView& tree, std::uint32_t level);

// The last box above each triangle under a node: leaves, and nodes with a child that is a single
// triangle. The node is told by the slot of its box; nothing where there is no such box.
[[nodiscard]] std::optional<ShownBoxes> last_boxes_under(const TreeView& tree, std::uint32_t slot);

} // namespace obb
