// The boxes of a clearance query: which are opened, and how near what is in them may come.
#include "clearance/clearance_query.hpp"

#include <algorithm>

namespace obb {

void ClearanceQuery::open(const Item& item) {
    const bool is_triangle_a = item.a.is_triangle(), is_triangle_b = item.b.is_triangle();
    if (is_triangle_a && is_triangle_b) {
        add_triangles(item, frame_of(item.span));
        return;
    }
    const bool opens_a =
        is_triangle_b || (!is_triangle_a && MovingPair::size_of(pair_.a(), item.a) >=
                                                MovingPair::size_of(pair_.b(), item.b));
    const MovingTree& body = opens_a ? pair_.a() : pair_.b();
    const NodeRef& ref = opens_a ? item.a : item.b;
    const Node& node = body.tree().node(ref);
    if (TreeView::is_leaf(node)) {
        open_leaf(item, opens_a);
        return;
    }
    const std::array<NodeRef, 2> parts = body.tree().children(ref, node);
    const IntervalFrame frame = frame_of(item.span);
    if (opens_a) {
        add_children(item, frame, parts, {item.b, item.b}, 2);
    } else {
        add_children(item, frame, {item.a, item.a}, parts, 2);
    }
}

// Some triangles at a time: leaves may hold whole meshes.
void ClearanceQuery::open_leaf(const Item& item, bool opens_a) {
    constexpr std::uint32_t kTrianglesAPop = 64;
    const TreeView& tree = (opens_a ? pair_.a() : pair_.b()).tree();
    const NodeRef& ref = opens_a ? item.a : item.b;
    tree.prepare(ref);
    const std::uint32_t begin = ref.begin + item.next;
    const std::uint32_t end = begin + std::min(kTrianglesAPop, ref.end - begin);
    Item part = item;
    part.next = 0;
    if (end < ref.end) {
        Item rest = item;
        rest.next = end - ref.begin;
        add(rest);
    }
    const IntervalFrame frame = frame_of(item.span);
    for (std::uint32_t i = begin; i < end && !is_contact_; ++i) {
        const NodeRef child = TreeView::triangle_ref(ref, i);
        const NodeRef &a = opens_a ? child : item.a, &b = opens_a ? item.b : child;
        add_children(part, frame, {a, a}, {b, b}, 1);
    }
}

void ClearanceQuery::add_children(const Item& item, const IntervalFrame& frame,
                                  const std::array<NodeRef, 2>& a, const std::array<NodeRef, 2>& b,
                                  std::size_t count) {
    bool is_placed = false;
    for (std::size_t k = 0; k < count && !is_contact_; ++k) {
        Item child = item;
        child.a = a[k];
        child.b = b[k];
        if (child.a.is_triangle() && child.b.is_triangle()) {
            add_triangles(child, frame);
            continue;
        }
        if (!is_placed) {
            pair_.place(a, b);
            is_placed = true;
        }
        add_bounded(child, frame, pair_.boxes().box(kLaneOfA[k]), pair_.boxes().box(kLaneOfB[k]));
    }
}

void ClearanceQuery::add_bounded(Item item, const IntervalFrame& frame, const Obb& a,
                                 const Obb& b) {
    ++counts_.box_tests;
    const BoxBound bound = bound_boxes(frame, a, b);
    if (bound.low > item.key) { // not where a damaged tree makes it no number
        item.key = bound.low;
    }
    item.gap = bound.gap;
    item.travel = bound.travel;
    add(item);
}

} // namespace obb
