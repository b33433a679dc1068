// What a ray cast does with pairs of boxes: which it opens, and which parts of these it pushes.
#include "in_motion/ray_cast.hpp"

#include <algorithm>

namespace obb {

namespace {

// Of two boxes whose sizes differ by no more than this both are opened.
constexpr double kAlike = 0.5;
// Nodes of no more triangles than this are looked at in floats: of larger ones that slide past each
// other the digits that floats lack are worth a test in doubles.
constexpr std::uint32_t kSmall = 512;
// Triangles of a leaf, which may hold a whole mesh, that are looked at in one pop.
constexpr std::uint32_t kTrianglesAPop = 64;
// Beyond what box_entries() and enter_boxes() round: of sums of times.
constexpr double kDown = 1 - 0x1p-52, kUp = 1 + 0x1p-52;

} // namespace

RayCast::Parts RayCast::parts_of(const TreeView& tree, const NodeRef& ref, const Node* opened) {
    return opened != nullptr ? Parts{tree.children(ref, *opened), 2} : Parts{{ref, ref}, 1};
}

// The larger box is opened, or both where they are about as large. A leaf is opened alone.
void RayCast::part(MovingPair& pair, const Entry& entry) {
    const TreeView &tree_a = pair.a().tree(), &tree_b = pair.b().tree();
    const Node* a = entry.a.is_triangle() ? nullptr : &tree_a.node(entry.a);
    const Node* b = entry.b.is_triangle() ? nullptr : &tree_b.node(entry.b);
    if (a != nullptr && b != nullptr) {
        const double size_a = pair.a().node_scale() * norm_inf(half_extents_of(*a));
        const double size_b = pair.b().node_scale() * norm_inf(half_extents_of(*b));
        // Of sizes that are no numbers, in a damaged tree, both are opened.
        const bool is_a_small = size_a < kAlike * size_b, is_b_small = size_b < kAlike * size_a;
        a = is_a_small ? nullptr : a;
        b = is_b_small ? nullptr : b;
    }
    const bool leaf_a = a != nullptr && TreeView::is_leaf(*a);
    const bool leaf_b = b != nullptr && TreeView::is_leaf(*b);
    if (leaf_a && (b == nullptr || leaf_b)) {
        open_leaf(pair, entry, true);
    } else if (leaf_b && a == nullptr) {
        open_leaf(pair, entry, false);
    } else {
        open(pair, entry, leaf_a ? nullptr : a, leaf_b ? nullptr : b);
    }
}

// Opens the nodes that are given.
void RayCast::open(MovingPair& pair, const Entry& entry, const Node* node_a, const Node* node_b) {
    const TreeView &a = pair.a().tree(), &b = pair.b().tree();
    Waiting& opening = waiting_[waiting_count_];
    opening.entry = entry;
    opening.a = parts_of(a, entry.a, node_a);
    opening.b = parts_of(b, entry.b, node_b);
    const auto are_small_boxes = [](const Parts& parts) {
        const std::uint32_t x = parts.refs[0].triangle_count(), y = parts.refs[1].triangle_count();
        return x > 1 && y > 1 && x <= kSmall && y <= kSmall;
    };
    if (is_close_ || !are_small_boxes(opening.a) || !are_small_boxes(opening.b)) {
        push_meeting(pair, entry, opening.a, opening.b);
        return;
    }
    openings_[waiting_count_].nodes = {&a.node(opening.a.refs[0]), &a.node(opening.a.refs[1]),
                                       &b.node(opening.b.refs[0]), &b.node(opening.b.refs[1])};
    ++waiting_count_;
    if (!frame_) {
        frame_.emplace(pair);
    }
}

// Two pairs are opened at a time, the next on the stack and the one below it.
bool RayCast::is_opening_due() const {
    return waiting_count_ == 2 || (waiting_count_ == 1 && frontier_.is_empty());
}

void RayCast::open_waiting() {
    for (std::size_t k = 0; k < waiting_count_; ++k) {
        Entry& entry = waiting_[k].entry;
        entry.end = std::min(entry.end, latest_);
        openings_[k].time = entry.time;
        openings_[k].span = kUp * (entry.end - entry.time);
    }
    EightEntries found;
    enter_boxes(*frame_, openings_, found);
    // What was on top of the stack stays above what was below it.
    while (waiting_count_ > 0) {
        const std::size_t k = --waiting_count_;
        const Waiting& opening = waiting_[k];
        std::array<Entry, 4> near;
        std::size_t count = 0;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const std::size_t i = kRayOfA[lane], j = kRayOfB[lane];
            if (i >= opening.a.count || j >= opening.b.count) {
                continue;
            }
            ++counts_.box_tests;
            if (narrow(opening.entry, found.entry[4 * k + lane], found.exit[4 * k + lane],
                       near[count])) {
                near[count].a = opening.a.refs[i];
                near[count].b = opening.b.refs[j];
                ++count;
            }
        }
        push_in_order(std::span(near).first(count));
    }
}

// Pushes the leaf's next triangles, two at a time, above the rest of the leaf.
void RayCast::open_leaf(MovingPair& pair, const Entry& entry, bool opens_a) {
    const NodeRef& leaf = opens_a ? entry.a : entry.b;
    const NodeRef& other = opens_a ? entry.b : entry.a;
    (opens_a ? pair.a() : pair.b()).tree().prepare(leaf);
    const std::uint32_t begin = leaf.begin + entry.next;
    const std::uint32_t end = begin + std::min(kTrianglesAPop, leaf.end - begin);
    if (end < leaf.end) {
        Entry rest = entry;
        rest.next = end - leaf.begin;
        frontier_.push(rest);
    }
    for (std::uint32_t i = begin; i < end; i += 2) {
        const std::uint32_t last = std::min(i + 1, end - 1);
        const Parts triangles{{TreeView::triangle_ref(leaf, i), TreeView::triangle_ref(leaf, last)},
                              std::size_t{last} - i + 1};
        const Parts whole{{other, other}, 1};
        push_meeting(pair, entry, opens_a ? triangles : whole, opens_a ? whole : triangles);
    }
}

BoxEntries RayCast::entries_of(MovingPair& pair, const Entry& entry, const Parts& a,
                               const Parts& b) const {
    pair.place(a.refs, b.refs);
    const MovingFrame now = pair.box_frame(entry.time);
    return box_entries(pair.boxes(), {now.between, now.closing_velocity,
                                      kUp * (entry.end - entry.time), relative_, now.absolute});
}

// Sets when parts of a pair may touch, of which the boxes say so much; false where they cannot, or
// not before the earliest contact known.
bool RayCast::narrow(const Entry& entry, double first, double last, Entry& part) const {
    const double time = std::max(entry.time, kDown * (entry.time + first));
    if (first > last || time > entry.end || !(time < latest_)) {
        return false;
    }
    part.time = time;
    part.end = std::min(entry.end, kUp * (entry.time + last));
    return true;
}

// Pushes the pairs of parts whose boxes may meet before the earliest contact known, the first to
// meet on top. All pairs of boxes are tested at once.
void RayCast::push_meeting(MovingPair& pair, const Entry& entry, const Parts& a, const Parts& b) {
    Entry whole = entry;
    whole.end = std::min(entry.end, latest_);
    const BoxEntries found = entries_of(pair, whole, a, b);
    std::array<Entry, 4> near;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.count; ++i) {
        for (std::size_t j = 0; j < b.count; ++j) {
            ++counts_.box_tests;
            if (narrow(whole, found.entry[2 * i + j], found.exit[2 * i + j], near[count])) {
                near[count].a = a.refs[i];
                near[count].b = b.refs[j];
                ++count;
            }
        }
    }
    push_in_order(std::span(near).first(count));
}

// The first to meet on top; of equal times the order stays.
void RayCast::push_in_order(std::span<const Entry> parts) {
    std::array<std::uint8_t, 4> order;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        std::size_t at = k;
        for (; at > 0 && parts[order[at - 1]].time < parts[k].time; --at) {
            order[at] = order[at - 1];
        }
        order[at] = static_cast<std::uint8_t>(k);
    }
    for (std::size_t k = 0; k < parts.size(); ++k) {
        frontier_.push(parts[order[k]]);
    }
}

} // namespace obb
