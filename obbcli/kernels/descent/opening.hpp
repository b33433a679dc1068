// Opening a pair of nodes: the parts of either, whose pairs stand in lanes of eight boxes.
#pragma once

#include "descent/box_lanes.hpp"
#include "descent/posed_tree.hpp"
#include "numbers/registers.hpp"
#include "tree/tree.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace obb {

// The lanes with any of some parts of A, and of B; a bit each of the number is a part.
inline constexpr std::array<unsigned, 4> kLanesOfA{0, 0b0101, 0b1010, 0b1111};
inline constexpr std::array<unsigned, 4> kLanesOfB{0, 0b1001, 0b0110, 0b1111};
// The boxes under a node come from memory while others are tested. Links need not lead to any box,
// and where there is no box, nor does what stands behind it. Another thread may be splitting the
// node.
OBB_INLINE void fetch_children(const TreeView& tree, const Node& node) {
    const auto fetch = [](std::uintptr_t place) {
        __builtin_prefetch(reinterpret_cast<const void*>(place));
    };
    fetch(reinterpret_cast<std::uintptr_t>(&node) + sizeof(Node));
    const std::uint32_t right = __atomic_load_n(&node.right, __ATOMIC_RELAXED);
    fetch(reinterpret_cast<std::uintptr_t>(tree.nodes.data()) + sizeof(Node) * right);
}

// Part k of a node that is opened, or the node as it is.
OBB_INLINE NodeRef part_of_node(const NodeRef& ref, const Node* opened, std::size_t k) {
    return opened == nullptr ? ref : TreeView::child(ref, *opened, k);
}

// The boxes of a node's children, or of itself where it is not opened; which of them are
// triangles, a bit each.
OBB_INLINE unsigned find_parts(const TreeView& tree, const NodeRef& ref, const Node* opened,
                               const Node** nodes) {
    const auto box_of = [&](const NodeRef& part) {
        return part.is_triangle() ? &kNoBox : &tree.node(part);
    };
    if (opened == nullptr) {
        nodes[0] = nodes[1] = box_of(ref);
        return ref.is_triangle() ? 0b11 : 0;
    }
    const auto [first, second] = tree.children(ref, *opened);
    nodes[0] = box_of(first);
    nodes[1] = box_of(second);
    return static_cast<unsigned>(first.is_triangle()) | static_cast<unsigned>(second.is_triangle())
                                                            << 1U;
}

// The largest half extent, in the frame's unit.
OBB_INLINE double size_of(const PosedTree& body, const Node& node) {
    const auto& h = node.half_extents;
    const float yz = h[1] < h[2] ? h[2] : h[1];
    return body.node_scale() * double{h[0] < yz ? yz : h[0]};
}

} // namespace obb
