// What a contact query does with pairs of boxes: pushes them on, opens them, for a while.
#include "in_motion/contact_query.hpp"

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

// Boxes this near, of their own size, are said to meet when they cannot be told apart any longer.
constexpr double kAllButMeeting = 0x1p-20;
// A pair is opened for as long as its boxes take to move by their own size, times this: less once
// so many pairs of boxes were tested that the bodies must glide along each other.
constexpr double kWindow = 2, kWindowOfGliding = 0.5;
constexpr std::uint64_t kGliding = 8192;
// Triangles of a leaf, which may hold a whole mesh, that are looked at in one pop.
constexpr std::uint32_t kTrianglesAPop = 64;

} // namespace

bool ContactQuery::is_open(const TreeView& tree, const NodeRef& ref,
                           std::uint32_t max_depth) const {
    return !ref.is_triangle() && ref.depth < max_depth &&
           !(options_.limits.boxes.boxes_for_leaves && TreeView::is_leaf(tree.node(ref)));
}

// The largest half extents of both.
std::array<double, 2> ContactQuery::sizes_of(const Entry& entry) const {
    return {MovingPair::size_of(pair_.a(), entry.a), MovingPair::size_of(pair_.b(), entry.b)};
}

// About the time in which boxes of such sizes, as they are placed, move by as much against each
// other.
double ContactQuery::window(const std::array<double, 2>& sizes) const {
    const Vec3 wa = pair_.a().spin().velocity(), wb = pair_.b().spin().velocity();
    const Vec3 velocity = pair_.closing_velocity() +
                          cross(wb, lane(pair_.boxes().center, kLaneOfB[0])) -
                          cross(wa, lane(pair_.boxes().center, kLaneOfA[0]));
    const auto [size_a, size_b] = sizes;
    const double turning = size_a * pair_.a().spin().speed() + size_b * pair_.b().spin().speed();
    const double factor = counts_.box_tests < kGliding ? kWindow : kWindowOfGliding;
    return factor * (size_a + size_b) / (norm_1(velocity) + turning);
}

// Bodies that slide along each other would keep every pair open that was ever near. So a pair is
// opened for a window, each time for twice as long if it has not parted since. After the window the
// pair is looked at as a whole again, unless all its parts were proven apart until the duration.
void ContactQuery::close_after(Entry& entry, double wide) {
    const double stop = entry.time + wide * power_of_two(static_cast<int>(entry.reopened));
    if (!(stop > entry.time) || !(stop + 2 * (stop - entry.time) < entry.end)) {
        return; // of points, say
    }
    Entry again = entry;
    again.time = stop;
    again.reopened += 1;
    again.opened = windows_.open();
    push(again);
    entry.window = again.opened;
    entry.end = stop;
}

// Whether a pair that comes back after its window is done with: nothing in the window needed it, or
// it is apart as a whole, for good or for so long that it goes back into the queue.
bool ContactQuery::is_over(const Entry& entry) {
    if (!windows_.close(entry.opened)) {
        return true;
    }
    const std::optional<double> time = later(entry, step_of_boxes(entry, 0));
    if (!time) {
        return true;
    }
    // Far enough apart to be pushed on as a whole.
    const bool has_parted = *time - entry.time > 0.5 * window(sizes_of(entry));
    if (has_parted) {
        push({*time, entry.end, entry.a, entry.b, entry.window});
    }
    return has_parted;
}

// Replaces a pair by the pairs of its children, each of which goes into the queue with the time
// until which its own boxes prove it apart.
template <bool kOpensA>
void ContactQuery::open(Entry entry, const std::array<double, 2>& sizes) {
    pair_.set_time(entry.time);
    const NodeRef& ref = kOpensA ? entry.a : entry.b;
    const NodeRef& other = kOpensA ? entry.b : entry.a;
    const TreeView& tree = (kOpensA ? pair_.a() : pair_.b()).tree();
    const Node& node = tree.node(ref);
    const bool is_leaf = TreeView::is_leaf(node);
    tree.prepare(ref);
    // Of a leaf the triangles are the children, two at a time, the rest after what these lead to.
    const std::uint32_t begin = is_leaf ? ref.begin + entry.next : 0;
    const std::uint32_t end = is_leaf ? begin + std::min(kTrianglesAPop, ref.end - begin) : 2;
    const MovingFrame now = pair_.box_frame(entry.time);
    for (std::uint32_t i = begin; i < end; i += 2) {
        const std::uint32_t last = std::min(i + 1, end - 1);
        const std::array<NodeRef, 2> children =
            is_leaf ? std::array{TreeView::triangle_ref(ref, i), TreeView::triangle_ref(ref, last)}
                    : tree.children(ref, node);
        const std::array<NodeRef, 2> others{other, other};
        pair_.place(kOpensA ? children : others, kOpensA ? others : children);
        if (i == begin && entry.next == 0 && !pair_.is_translation()) {
            close_after(entry, window(sizes));
        }
        const std::array<double, 2> steps = pair_.steps(now, entry.end - entry.time);
        for (std::uint32_t k = 0; k <= last - i; ++k) {
            ++counts_.box_tests;
            if (const std::optional<double> time = later(entry, steps[k])) {
                push(kOpensA ? Entry{*time, entry.end, children[k], entry.b, entry.window}
                             : Entry{*time, entry.end, entry.a, children[k], entry.window});
            }
        }
    }
    if (is_leaf && end < ref.end) {
        Entry rest = entry;
        rest.next = end - ref.begin;
        push(rest);
    }
}

// How long the pair's own boxes stay apart, with a margin to spare.
double ContactQuery::step_of_boxes(const Entry& entry, double margin) {
    pair_.set_time(entry.time);
    ++counts_.box_tests;
    pair_.place({entry.a, entry.a}, {entry.b, entry.b});
    const MovingFrame now = pair_.box_frame(entry.time, margin);
    return pair_.steps(now, entry.end - entry.time)[0];
}

// Nodes that stand for what they hold: the pair goes on while the boxes are apart.
void ContactQuery::meet_boxes(const Entry& entry) {
    const std::optional<double> time = later(entry, step_of_boxes(entry, 0));
    if (!time) {
        return;
    }
    if (*time > entry.time) {
        push({*time, entry.end, entry.a, entry.b, entry.window});
        return;
    }
    // A step too short for a double to tell: the boxes all but meet, or turn too fast.
    const Vec3 ha = lane(pair_.boxes().half_extents, kLaneOfA[0]);
    const Vec3 hb = lane(pair_.boxes().half_extents, kLaneOfB[0]);
    const double sizes = std::hypot(ha.x, ha.y, ha.z) + std::hypot(hb.x, hb.y, hb.z);
    const double margin = kAllButMeeting * sizes;
    if (step_of_boxes(entry, margin) > 0) {
        give_up(entry.time);
        return;
    }
    const double absolute = pair_.box_frame(entry.time, margin).absolute;
    // Boxes that no face axis separates may be apart still, by no more than their diagonals.
    const double bound = pair_.mesh_length(4 * (1 + 0x1p-16) * sizes + 2 * absolute);
    report({entry.time, entry.time, Evidence::kBoxes, entry.a, entry.b, 0, bound});
}

void ContactQuery::visit(const Entry& entry) {
    const bool open_a = is_open(pair_.a().tree(), entry.a, options_.limits.boxes.max_depth_a);
    const bool open_b = is_open(pair_.b().tree(), entry.b, options_.limits.boxes.max_depth_b);
    if (!open_a && !open_b) {
        if (options_.each_pair && found_.knows(known_key(entry.a, entry.b))) {
            return;
        }
        if (!entry.a.is_triangle() || !entry.b.is_triangle()) {
            meet_boxes(entry);
        } else if (pair_.is_translation()) {
            pair_.clearance() > 0 ? meet_within_clearance(entry) : meet_in_translation(entry);
        } else {
            meet_triangles(entry);
        }
    } else if (entry.reopened > 0 && entry.next == 0 && is_over(entry)) {
        return;
    } else {
        probe(entry);
        if (ties_.may_tie(entry.refs(), counts_.pops)) {
            looked_at_ = entry;
            take_tie(ties_.look(pair_, entry.refs(), counts_.pops));
        } else {
            part(entry);
        }
    }
}

// Opens the larger box, or the one that can be.
void ContactQuery::part(const Entry& entry) {
    const bool open_a = is_open(pair_.a().tree(), entry.a, options_.limits.boxes.max_depth_a);
    const bool open_b = is_open(pair_.b().tree(), entry.b, options_.limits.boxes.max_depth_b);
    const std::array<double, 2> sizes = sizes_of(entry);
    if (!open_b || (open_a && sizes[0] >= sizes[1])) {
        open<true>(entry, sizes);
    } else {
        open<false>(entry, sizes);
    }
}

} // namespace obb
