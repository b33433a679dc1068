#include "tree/tree.hpp"

#include <vector>

namespace obb {

void TreeView::prepare_triangles(const NodeRef& ref, std::uint32_t count) const {
    if (on_demand == nullptr) {
        return;
    }
    std::vector<NodeRef> stack{ref};
    while (!stack.empty()) {
        const NodeRef top = stack.back();
        stack.pop_back();
        if (top.begin - ref.begin < count) {
            prepare_into(stack, top);
        }
    }
}

// Makes what stands right under a node ready, and pushes its children, if it has any.
void TreeView::prepare_into(std::vector<NodeRef>& stack, const NodeRef& ref) const {
    if (ref.is_triangle()) {
        return;
    }
    const Node& box = node(ref);
    if (is_leaf(box)) {
        prepare(ref);
        return;
    }
    for (const NodeRef& child : children(ref, box)) {
        stack.push_back(child);
    }
}

void Preparation::begin(const TreeView& tree, const NodeRef& ref) {
    tree_ = &tree;
    stack_.clear();
    if (tree.on_demand != nullptr) {
        stack_.push_back(ref);
    }
}

void Preparation::prepare_one() {
    const NodeRef top = stack_.back();
    stack_.pop_back();
    tree_->prepare_into(stack_, top);
}

} // namespace obb
