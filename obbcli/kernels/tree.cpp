#include "tree.hpp"

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
        if (top.begin - ref.begin >= count || top.is_triangle()) {
            continue;
        }
        const Node& box = node(top);
        if (is_leaf(box)) {
            prepare(top);
            continue;
        }
        for (const NodeRef& child : children(top, box)) {
            stack.push_back(child);
        }
    }
}

} // namespace obb
