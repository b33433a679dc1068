#include "tree/tree_boxes.hpp"

#include "numbers/scale.hpp"

#include <algorithm>

namespace obb {

namespace {

ShownBox shown(const TreeView& tree, const NodeRef& ref, const Node& node) {
    const int exponent = tree.scale_exponent;
    return {ref,
            {scaled(node.center, exponent), axes_of(node.rotation),
             scaled(half_extents_of(node), exponent)}};
}

// Goes down to the box in a slot: those of a left child come before that of the right one.
std::optional<NodeRef> find(const TreeView& tree, std::uint32_t slot) {
    NodeRef ref = tree.root();
    while (!ref.is_triangle()) {
        if (ref.slot == slot) {
            return ref;
        }
        const Node& node = tree.node(ref);
        if (TreeView::is_leaf(node)) {
            break;
        }
        const auto [left, right] = tree.children(ref, node);
        ref = slot < right.slot ? left : right;
    }
    return std::nullopt;
}

} // namespace

ShownBoxes boxes_of_level(const TreeView& tree, std::uint32_t level) {
    ShownBoxes found;
    std::vector<NodeRef> stack{tree.root()};
    while (!stack.empty()) {
        const NodeRef ref = stack.back();
        stack.pop_back();
        if (ref.is_triangle()) {
            continue;
        }
        found.deepest = std::max(found.deepest, ref.depth);
        const Node& node = tree.node(ref);
        if (ref.depth == level) {
            found.boxes.push_back(shown(tree, ref, node));
        } else if (!TreeView::is_leaf(node)) {
            const auto [left, right] = tree.children(ref, node);
            stack.insert(stack.end(), {right, left});
        }
    }
    return found;
}

std::optional<ShownBoxes> last_boxes_under(const TreeView& tree, std::uint32_t slot) {
    const std::optional<NodeRef> top = find(tree, slot);
    if (!top) {
        return std::nullopt;
    }
    ShownBoxes found;
    std::vector<NodeRef> stack{*top};
    while (!stack.empty()) {
        const NodeRef ref = stack.back();
        stack.pop_back();
        found.deepest = std::max(found.deepest, ref.depth);
        const Node& node = tree.node(ref);
        if (TreeView::is_leaf(node)) {
            found.boxes.push_back(shown(tree, ref, node));
            continue;
        }
        const auto [left, right] = tree.children(ref, node);
        if (left.is_triangle() || right.is_triangle()) {
            found.boxes.push_back(shown(tree, ref, node));
        }
        for (const NodeRef& child : {right, left}) {
            if (!child.is_triangle()) {
                stack.push_back(child);
            }
        }
    }
    return found;
}

} // namespace obb
