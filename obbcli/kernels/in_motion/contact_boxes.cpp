// What a contact query does with pairs of boxes: pushes them on, opens them, for a while.
#include "in_motion/contact_query.hpp"

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

// Boxes this near, of their own size, are said to meet when they cannot be told apart any longer.
constexpr double kAllButMeeting = 0x1p-20;
// A pair is opened for as long as its boxes take to move by their own size, times this.
constexpr double kWindow = 2;
// Triangles of a leaf, which may hold a whole mesh, that are looked at in one pop.
constexpr std::uint32_t kTrianglesAPop = 64;

} // namespace

// How long it takes a pair's boxes to move by their own sizes against each other, about.
double ContactQuery::window(const Entry& entry) const {
    const Vec3 wa = a_.spin().velocity(), wb = b_.spin().velocity();
    const Vec3 velocity =
        closing_velocity_ + cross(wb, lane(boxes_->center, 2)) - cross(wa, lane(boxes_->center, 0));
    const double size_a = size_of(a_, entry.a), size_b = size_of(b_, entry.b);
    const double turning = size_a * a_.spin().speed() + size_b * b_.spin().speed();
    return kWindow * (size_a + size_b) / (norm_1(velocity) + turning);
}

// Bodies that slide along each other would keep every pair open that was ever near. So a pair is
// opened for a while, and longer each time that it has not parted since; then it is looked at as a
// whole again, unless all its parts were proven apart for good.
void ContactQuery::close_after(Entry& entry, double wide) {
    const double stop = entry.time + wide * power_of_two(static_cast<int>(entry.reopened));
    if (!(stop > entry.time) || !(stop + 2 * (stop - entry.time) < entry.end)) {
        return; // of points, say
    }
    if (free_windows_.empty()) {
        free_windows_.push_back(static_cast<std::uint32_t>(is_needed_.size()));
        is_needed_.push_back(false);
    }
    Entry again = entry;
    again.time = stop;
    again.reopened += 1;
    again.opened = free_windows_.back();
    push(again);
    free_windows_.pop_back();
    entry.window = again.opened;
    entry.end = stop;
}

// Whether a pair that was opened before needs not be opened again now.
bool ContactQuery::is_over(const Entry& entry) {
    const bool is_needed = is_needed_[entry.opened];
    is_needed_[entry.opened] = false;
    free_windows_.push_back(entry.opened);
    if (!is_needed) {
        return true;
    }
    const std::optional<double> time = later(entry, step_of_boxes(entry, 0));
    if (!time) {
        return true;
    }
    // Far enough apart to be pushed on as a whole.
    const bool has_parted = *time - entry.time > 0.5 * window(entry);
    if (has_parted) {
        push({*time, entry.end, entry.a, entry.b, entry.window});
    }
    return has_parted;
}

// The boxes of two parts of each body at the present time.
void ContactQuery::place(const std::array<NodeRef, 2>& a, const std::array<NodeRef, 2>& b) {
    const auto node = [](const MovingTree& body, const NodeRef& ref) {
        return ref.is_triangle() ? &kNoBox : &body.tree().node(ref);
    };
    place_boxes(*motion_, {node(a_, a[0]), node(a_, a[1]), node(b_, b[0]), node(b_, b[1])},
                *boxes_);
    place_triangles(a_, a, 0);
    place_triangles(b_, b, 2);
}

// Boxes around what has none of its own; around the same triangle twice, one.
void ContactQuery::place_triangles(const MovingTree& body, const std::array<NodeRef, 2>& parts,
                                   std::size_t lane) {
    const auto is_triangle = [&](std::size_t k) { return parts[k].is_triangle(); };
    if (is_triangle(0)) {
        set_lane(*boxes_, lane, body.box(parts[0]));
    }
    if (is_triangle(1)) {
        const bool is_same = is_triangle(0) && parts[0].begin == parts[1].begin;
        set_lane(*boxes_, lane + 1, is_same ? obb::lane(*boxes_, lane) : body.box(parts[1]));
    }
}

// Replaces a pair by its children's, each pushed on as far as its own boxes prove it apart.
template <bool kOpensA>
void ContactQuery::open(Entry entry) {
    set_time(entry.time);
    const NodeRef& ref = kOpensA ? entry.a : entry.b;
    const NodeRef& other = kOpensA ? entry.b : entry.a;
    const TreeView& tree = (kOpensA ? a_ : b_).tree();
    const Node& node = tree.node(ref);
    const bool is_leaf = TreeView::is_leaf(node);
    tree.prepare(ref);
    // Of a leaf the triangles are the children, two at a time, the rest after what these lead to.
    const std::uint32_t begin = is_leaf ? ref.begin + entry.next : 0;
    const std::uint32_t end = is_leaf ? begin + std::min(kTrianglesAPop, ref.end - begin) : 2;
    const MovingFrame now = frame(a_.box_error() + b_.box_error(), entry.time);
    for (std::uint32_t i = begin; i < end; i += 2) {
        const std::uint32_t last = std::min(i + 1, end - 1);
        const std::array<NodeRef, 2> children =
            is_leaf ? std::array{TreeView::triangle_ref(ref, i), TreeView::triangle_ref(ref, last)}
                    : tree.children(ref, node);
        const std::array<NodeRef, 2> others{other, other};
        place(kOpensA ? children : others, kOpensA ? others : children);
        if (i == begin && entry.next == 0 && !is_translation_) {
            close_after(entry, window(entry));
        }
        const std::array<double, 2> steps =
            times_apart(*motion_, *boxes_, now, entry.end - entry.time);
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
    set_time(entry.time);
    ++counts_.box_tests;
    place({entry.a, entry.a}, {entry.b, entry.b});
    const MovingFrame now = frame(a_.box_error() + b_.box_error() + margin, entry.time);
    return times_apart(*motion_, *boxes_, now, entry.end - entry.time)[0];
}

// A node that stands for what it holds: pushed on as long as the boxes are apart.
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
    const Vec3 ha = lane(boxes_->half_extents, 0), hb = lane(boxes_->half_extents, 2);
    const double sizes = std::hypot(ha.x, ha.y, ha.z) + std::hypot(hb.x, hb.y, hb.z);
    const double margin = kAllButMeeting * sizes;
    if (step_of_boxes(entry, margin) > 0) {
        give_up(entry.time);
        return;
    }
    const double absolute = frame(a_.box_error() + b_.box_error() + margin, entry.time).absolute;
    // Boxes that no face axis separates may be apart still, by no more than their diagonals.
    const double bound = std::ldexp(4 * (1 + 0x1p-16) * sizes + 2 * absolute, length_exponent_);
    report({entry.time, entry.time, Evidence::kBoxes, entry.a, entry.b, 0, bound});
}

void ContactQuery::visit(const Entry& entry) {
    const bool open_a = is_open(a_.tree(), entry.a, options_.limits.boxes.max_depth_a);
    const bool open_b = is_open(b_.tree(), entry.b, options_.limits.boxes.max_depth_b);
    if (!open_a && !open_b) {
        if (options_.each_pair && known_.contains(key_of(entry.a, entry.b))) {
            return;
        }
        if (!entry.a.is_triangle() || !entry.b.is_triangle()) {
            meet_boxes(entry);
        } else if (is_translation_) {
            clearance_ > 0 ? meet_within_clearance(entry) : meet_in_translation(entry);
        } else {
            meet_triangles(entry);
        }
    } else if (entry.reopened > 0 && entry.next == 0 && is_over(entry)) {
        return;
    } else {
        probe(entry);
        if (may_tie(entry)) {
            look_for_tie(entry);
        } else {
            part(entry);
        }
    }
}

// Opens the larger box, or the one that can be.
void ContactQuery::part(const Entry& entry) {
    const bool open_a = is_open(a_.tree(), entry.a, options_.limits.boxes.max_depth_a);
    const bool open_b = is_open(b_.tree(), entry.b, options_.limits.boxes.max_depth_b);
    if (!open_b || (open_a && size_of(a_, entry.a) >= size_of(b_, entry.b))) {
        open<true>(entry);
    } else {
        open<false>(entry);
    }
}

} // namespace obb
