// The walk of a question at rest: which pair comes next, and which of its nodes are opened.
#include "at_rest/static_query.hpp"

#include "descent/opening.hpp"
#include "numbers/registers.hpp"
#include "work/slice.hpp"

#include <cstdint>

namespace obb {

namespace {

// Of two boxes whose sizes differ by no more than this both are opened.
constexpr double kAlike = 0.5;

// So many pops open one pair alone.
constexpr std::uint64_t kAlone = 16;

// The boxes of a node's children, if the node is split, both children have boxes, and the links say
// so. Differences of numbers without a sign that would be negative are large.
OBB_INLINE bool find_boxes(const TreeView& tree, const NodeRef& ref, const Node& opened,
                           const Node** nodes) {
    if (tree.on_demand != nullptr && !tree.on_demand->is_ready(ref.slot)) {
        return false;
    }
    const std::uint32_t count = ref.triangle_count();
    if (count < 4 || opened.split - ref.begin - 2 > count - 4 ||
        opened.right - ref.slot - 1 >= tree.nodes.size() - ref.slot - 1) {
        return false;
    }
    nodes[0] = &opened + 1;
    nodes[1] = tree.nodes.data() + opened.right;
    return true;
}

// The larger of two boxes is to be opened, or both where they are about as large: of sizes that are
// no numbers or negative, in a damaged tree, both. The other becomes null.
OBB_INLINE void choose(const PosedTree& body_a, const Node*& a, const PosedTree& body_b,
                       const Node*& b) {
    const double size_a = size_of(body_a, *a), size_b = size_of(body_b, *b);
    const bool is_small_a = size_a < kAlike * size_b, is_small_b = size_b < kAlike * size_a;
    if (is_small_a != is_small_b) {
        (is_small_a ? a : b) = nullptr;
    }
}

} // namespace

// The box of a node that may be opened; none of others, and of triangles.
OBB_INLINE const Node* StaticQuery::box_to_open(const PosedTree& body, const NodeRef& ref,
                                                std::uint32_t max_depth) const {
    if (ref.is_triangle() || (is_coarse_ && ref.depth >= max_depth)) {
        return nullptr;
    }
    const Node& node = body.tree().nodes[ref.slot]; // whoever pushed it looked whether it is there
    return options_.boxes.boxes_for_leaves && TreeView::is_leaf(node) ? nullptr : &node;
}

void StaticQuery::wait_to_open(const Pair& pair, const Node* node_a, const Node* node_b) {
    const Node** const nodes = waiting_nodes_.data() + 4 * waiting_count_;
    const unsigned triangles_a = find_parts(a_.tree(), pair.a, node_a, nodes);
    const unsigned triangles_b = find_parts(b_.tree(), pair.b, node_b, nodes + 2);
    const unsigned lanes =
        kLanesOfA[node_a != nullptr ? 3 : 1] & kLanesOfB[node_b != nullptr ? 3 : 1];
    waiting_[waiting_count_++] = {pair, node_a, node_b, lanes,
                                  lanes & (kLanesOfA[triangles_a] | kLanesOfB[triangles_b])};
}

// Nodes that cannot be opened leave it to the other.
void StaticQuery::visit(const Pair& pair) {
    if (is_crowd(pair)) {
        meet_all(pair);
        return;
    }
    const Node* a = box_to_open(a_, pair.a, options_.boxes.max_depth_a);
    const Node* b = box_to_open(b_, pair.b, options_.boxes.max_depth_b);
    if (a != nullptr && b != nullptr) {
        choose(a_, a, b_, b);
    } else if (a == nullptr && b == nullptr) {
        meet(pair);
        return;
    }
    const bool leaf_a = a != nullptr && TreeView::is_leaf(*a);
    const bool leaf_b = b != nullptr && TreeView::is_leaf(*b);
    if (leaf_a || leaf_b) {
        open_leaf(pair, leaf_a);
    } else {
        wait_to_open(pair, a, b);
    }
}

// The same in few instructions where all that it opens has two boxes under it, as nearly always;
// false elsewhere.
OBB_INLINE bool StaticQuery::visit_boxes(const Pair& pair) {
    if (is_coarse_ || pair.a.is_triangle() || pair.b.is_triangle() || is_crowd(pair)) {
        return false;
    }
    const Node* const box_a = a_.tree().nodes.data() + pair.a.slot;
    const Node* const box_b = b_.tree().nodes.data() + pair.b.slot;
    const Node *a = box_a, *b = box_b;
    choose(a_, a, b_, b);
    const Node** const nodes = waiting_nodes_.data() + 4 * waiting_count_;
    unsigned lanes = 0b1111;
    if (a == nullptr) {
        nodes[0] = nodes[1] = box_a;
        lanes = kLanesOfA[1];
    } else if (!find_boxes(a_.tree(), pair.a, *a, nodes)) {
        return false;
    }
    if (b == nullptr) {
        nodes[2] = nodes[3] = box_b;
        lanes = kLanesOfB[1];
    } else if (!find_boxes(b_.tree(), pair.b, *b, nodes + 2)) {
        return false;
    }
    waiting_[waiting_count_++] = {pair, a, b, lanes, 0};
    return true;
}

// Two pairs are opened at a time, the nearest and the next. Not so the first few, whose nodes are
// large: where the nearest leads to a contact, boxes of the others would have been made on demand
// for nothing. And not where boxes stand for triangles, so that which of them meet first is found
// first.
OBB_INLINE void StaticQuery::pop() {
    const bool is_alone = is_coarse_ || counts_.pops < kAlone;
    ++counts_.pops;
    const Pair pair = stack_.back();
    stack_.pop_back();
    if (is_alone) {
        if (Ahead& ahead = ahead_of(stack_.size()); ahead.place == stack_.size()) {
            open_ahead(ahead);
            return;
        }
    }
    if (!visit_boxes(pair)) {
        visit(pair);
    }
    if (waiting_count_ == 0) {
        return;
    }
    if (is_alone && waiting_count_ == 1 && !stack_.empty()) {
        look_ahead();
    } else if (waiting_count_ == 2 || is_alone || stack_.empty()) {
        open_waiting();
    }
}

// Opens the pair that waits. The next one that was not judged is judged along with it if its boxes
// are there, in lanes that are empty else, and stays where it is on the stack.
void StaticQuery::look_ahead() {
    std::size_t place = stack_.size() - 1;
    while (place > 0 && ahead_of(place).place == place) {
        --place;
    }
    const bool is_room = ahead_of(place).place > stack_.size();
    if (is_room && visit_boxes(stack_[place])) {
        open_first(place);
    } else {
        open_waiting();
    }
}

void StaticQuery::pop_alone() { pop(); }

// Roots that were tested already are opened next; else they are tested as if both were children of
// a node.
void StaticQuery::begin() {
    const Pair roots{a_.tree().root(), b_.tree().root()};
    if (options_.roots_may_meet && !is_coarse_) {
        counts_.box_tests = 1;
        stack_.push_back(roots);
        return;
    }
    wait_to_open(roots, nullptr, nullptr);
    open_waiting();
}

bool StaticQuery::advance(std::uint64_t max_pops) {
    const bool is_whole = a_.tree().on_demand == nullptr && b_.tree().on_demand == nullptr;
    SliceClock clock(is_whole ? SliceClock::Steps::kShort : SliceClock::Steps::kLong);
    for (; !stack_.empty() && max_pops > 0 && !clock.is_over(); --max_pops) {
        pop();
    }
    if (stack_.empty() && !is_finished_) {
        finish();
    }
    return is_finished_;
}

} // namespace obb
