// The boxes of a question at rest: which of a pair is opened, and which parts of it may meet.
#include "at_rest/static_query.hpp"

#include "numbers/registers.hpp"
#include "work/slice.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>

namespace obb {

namespace {

// Of two boxes whose sizes differ by no more than this both are opened.
constexpr double kAlike = 0.5;

// Boxes that rounding to floats leaves undecided are tested in doubles where one of them holds more
// triangles than this; else they are sooner opened.
constexpr std::uint32_t kMany = 512;

// So many pops open one pair alone.
constexpr std::uint64_t kAlone = 6;

// The lanes with any of some parts of A, and of B; a bit each of the number is a part.
constexpr std::array<unsigned, 4> kLanesOfA{0, 0b0101, 0b1010, 0b1111};
constexpr std::array<unsigned, 4> kLanesOfB{0, 0b1001, 0b0110, 0b1111};
constexpr std::array<unsigned, 16> kCounts{0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

// The boxes under a node come from memory while others are tested. Links need not lead to any box.
OBB_INLINE void fetch_children(const TreeView& tree, const NodeRef& ref) {
    if (!ref.is_triangle()) {
        const auto first = reinterpret_cast<std::uintptr_t>(tree.nodes.data());
        const auto fetch = [&](std::uintptr_t slot) {
            __builtin_prefetch(reinterpret_cast<const void*>(first + sizeof(Node) * slot));
        };
        fetch(std::uintptr_t{ref.slot} + 1);
        fetch(tree.nodes[ref.slot].right);
    }
}

OBB_INLINE NodeRef first_child(const NodeRef& ref, const Node& node) {
    return {ref.begin, node.split, ref.slot + 1, ref.depth + 1};
}
OBB_INLINE NodeRef second_child(const NodeRef& ref, const Node& node) {
    return {node.split, ref.end, node.right, ref.depth + 1};
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
    tree.prepare(ref);
    if (opened->split <= ref.begin || opened->split >= ref.end || opened->right <= ref.slot) {
        (void)TreeView::links(ref, *opened); // says what is wrong
    }
    const NodeRef first = first_child(ref, *opened), second = second_child(ref, *opened);
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

} // namespace

// The box of a node that may be opened; none of others, and of triangles.
OBB_INLINE const Node* StaticQuery::box_to_open(const PosedTree& body, const NodeRef& ref,
                                                std::uint32_t max_depth) const {
    if (ref.is_triangle() || ref.depth >= max_depth) {
        return nullptr;
    }
    const Node& node = body.tree().nodes[ref.slot]; // whoever pushed it looked whether it is there
    return options_.boxes.boxes_for_leaves && TreeView::is_leaf(node) ? nullptr : &node;
}

OBB_INLINE StaticQuery::Pair StaticQuery::part_of(const Opening& opening, std::size_t lane) {
    const auto part = [](const NodeRef& ref, const Node* opened, std::size_t k) {
        return opened == nullptr ? ref
               : k == 0          ? first_child(ref, *opened)
                                 : second_child(ref, *opened);
    };
    return {part(opening.pair.a, opening.node_a, kOfA[lane]),
            part(opening.pair.b, opening.node_b, kOfB[lane])};
}

OBB_INLINE void StaticQuery::push(const Pair& pair) {
    fetch_children(a_.tree(), pair.a);
    fetch_children(b_.tree(), pair.b);
    stack_.push_back(pair);
}

// The nearest comes on top, the others in the order of the lanes. A branch a lane, of which the
// processor guesses the outcome, is faster than to wait for it.
OBB_INLINE void StaticQuery::push_meeting(const Opening& opening, unsigned meeting,
                                          const float* nearness) {
    float least = std::numeric_limits<float>::infinity();
    std::size_t nearest = 0;
    unrolled<4>([&](auto lane) __attribute__((always_inline)) {
        if ((meeting >> lane & 1U) != 0) {
            push(part_of(opening, lane));
            if (nearness[lane] <= least) {
                least = nearness[lane];
                nearest = stack_.size();
            }
        }
    });
    if (nearest > 0 && nearest < stack_.size()) {
        std::swap(stack_[nearest - 1], stack_.back());
    }
}

// The farthest first; the order of equal ones is that of the children. In doubles, for which of the
// boxes meets first may be all that is told.
void StaticQuery::push_in_order(const Opening& opening, unsigned meeting) {
    constexpr std::array<std::size_t, 4> kByChildren{0, 2, 3, 1};
    const auto middle = [](const PosedTree& body, const NodeRef& ref) {
        if (!ref.is_triangle()) {
            return body.box(body.tree().nodes[ref.slot]).center;
        }
        const Triangle t = body.triangle_in_frame(ref);
        return (1.0 / 3.0) * (t[0] + t[1] + t[2]);
    };
    std::array<std::pair<double, std::size_t>, 4> lanes;
    std::size_t count = 0;
    for (const std::size_t lane : kByChildren) {
        if ((meeting >> lane & 1U) == 0) {
            continue;
        }
        const Pair pair = part_of(opening, lane);
        const double distance = norm_1(middle(a_, pair.a) - middle(b_, pair.b));
        std::size_t place = count++;
        for (; place > 0 && lanes[place - 1].first < distance; --place) {
            lanes[place] = lanes[place - 1];
        }
        lanes[place] = {distance, lane};
    }
    for (std::size_t k = 0; k < count; ++k) {
        push(part_of(opening, lanes[k].second));
    }
}

OBB_INLINE void StaticQuery::wait_to_open(const Pair& pair, const Node* node_a,
                                          const Node* node_b) {
    const Node** const nodes = waiting_nodes_.data() + 4 * waiting_count_;
    Opening& opening = waiting_[waiting_count_++];
    const unsigned triangles_a = find_parts(a_.tree(), pair.a, node_a, nodes);
    const unsigned triangles_b = find_parts(b_.tree(), pair.b, node_b, nodes + 2);
    opening.pair = pair;
    opening.node_a = node_a;
    opening.node_b = node_b;
    opening.lanes = kLanesOfA[node_a != nullptr ? 3 : 1] & kLanesOfB[node_b != nullptr ? 3 : 1];
    opening.triangle_lanes = opening.lanes & (kLanesOfA[triangles_a] | kLanesOfB[triangles_b]);
}

// The larger box is opened, or both where they are about as large. A node that cannot be opened
// leaves it to the other.
OBB_INLINE void StaticQuery::visit(const Pair& pair) {
    if (is_crowd(pair)) {
        meet_all(pair);
        return;
    }
    const Node* a = box_to_open(a_, pair.a, options_.boxes.max_depth_a);
    const Node* b = box_to_open(b_, pair.b, options_.boxes.max_depth_b);
    if (a != nullptr && b != nullptr) {
        const double size_a = size_of(a_, *a), size_b = size_of(b_, *b);
        const bool is_small_a = size_a < kAlike * size_b, is_small_b = size_b < kAlike * size_a;
        // Of sizes that are no numbers or negative, in a damaged tree, both are opened.
        if (is_small_a != is_small_b) {
            (is_small_a ? a : b) = nullptr;
        }
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

// Two pairs are opened at a time, the nearest and the next. Not so the first few, whose nodes are
// large: where the nearest leads to a contact, boxes of the others would have been made on demand
// for nothing. And not where boxes stand for triangles, so that which of them meet first is found
// first.
OBB_INLINE void StaticQuery::pop() {
    const bool is_alone = is_coarse_ || counts_.pops < kAlone;
    ++counts_.pops;
    const Pair pair = stack_.back();
    stack_.pop_back();
    visit(pair);
    if (waiting_count_ > 0 && (waiting_count_ == 2 || is_alone || stack_.empty())) {
        open_waiting();
    }
}

void StaticQuery::pop_alone() { pop(); }

// As if both roots were children of a node.
void StaticQuery::begin() {
    wait_to_open({a_.tree().root(), b_.tree().root()}, nullptr, nullptr);
    open_waiting();
}

bool StaticQuery::advance(std::uint64_t max_pops) {
    SliceClock clock;
    for (; !stack_.empty() && max_pops > 0 && !clock.is_over(); --max_pops) {
        pop();
    }
    if (stack_.empty() && !is_finished_) {
        finish();
    }
    return is_finished_;
}

void StaticQuery::open_waiting() {
    EightVerdicts verdicts;
    judge_boxes(frame_, waiting_nodes_, verdicts);
    const unsigned open = is_coarse_ ? verdicts.open : verdicts.open_by_faces;
    // What was on top of the stack stays above what was below it.
    for (std::size_t k = waiting_count_; k-- > 0;) {
        const Opening& opening = waiting_[k];
        float* const nearness = verdicts.nearness.data() + 4 * k;
        const unsigned boxes = opening.lanes & ~opening.triangle_lanes;
        counts_.box_tests += kCounts[boxes];
        unsigned meeting = boxes & ~(verdicts.apart >> 4 * k);
        if (const unsigned unsure = meeting & (open >> 4 * k); unsure != 0) {
            meeting ^= unsure ^ meeting_in_doubles(opening, unsure);
        }
        if (opening.triangle_lanes != 0) {
            meeting |= meeting_triangles(opening, nearness);
        }
        if (is_coarse_) {
            push_in_order(opening, meeting);
        } else {
            push_meeting(opening, meeting, nearness);
        }
    }
    waiting_count_ = 0;
}

// Those of some pairs of boxes that doubles do not prove apart, if that is worth the while.
unsigned StaticQuery::meeting_in_doubles(const Opening& opening, unsigned lanes) const {
    unsigned meeting = 0;
    for (; lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        const Pair pair = part_of(opening, lane);
        const bool is_small =
            !is_coarse_ && std::max(pair.a.triangle_count(), pair.b.triangle_count()) <= kMany;
        const bool meets = is_small || !are_separated(a_.box(a_.tree().nodes[pair.a.slot]),
                                                      b_.box(b_.tree().nodes[pair.b.slot]), bound_);
        meeting |= static_cast<unsigned>(meets) << lane;
    }
    return meeting;
}

// Of the pairs with a triangle, which has no box.
unsigned StaticQuery::meeting_triangles(const Opening& opening, float* nearness) {
    unsigned meeting = 0;
    for (unsigned lanes = opening.triangle_lanes; lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        const Pair pair = part_of(opening, lane);
        counts_.box_tests += pair.a.is_triangle() && pair.b.is_triangle() ? 0 : 1;
        const bool meets = may_triangle_meet(pair.a, pair.b, nearness[lane]);
        meeting |= static_cast<unsigned>(meets) << lane;
    }
    return meeting;
}

} // namespace obb
