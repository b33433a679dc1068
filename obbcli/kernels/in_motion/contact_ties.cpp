// How a contact query tells ties (see TiePlanes), and finds the contact whose planes do.
#include "in_motion/contact_query.hpp"

#include <algorithm>

namespace obb {

namespace {

// Pops after which a contact is looked for ahead of its time: few questions get that far.
constexpr std::uint64_t kProbePatience = 1024;

} // namespace

// Whether boxes stand for triangles: those may meet earlier than the triangles do.
bool ContactQuery::has_limits() const { return options_.limits.boxes != BoxLimits{}; }

// Asks when two triangles under a pair touch, ahead of their turn. Where many pairs touch at one
// time, all their boxes come before the first triangles in the queue.
void ContactQuery::probe(const Entry& entry) {
    if (!pair_.is_translation() || options_.each_pair || has_limits() ||
        counts_.pops < std::max(next_probe_, kProbePatience)) {
        return;
    }
    next_probe_ = 2 * counts_.pops;
    Entry at = entry;
    while (!at.a.is_triangle() || !at.b.is_triangle()) {
        at = nearer_half(at, at.b.is_triangle() ||
                                 (!at.a.is_triangle() && MovingPair::size_of(pair_.a(), at.a) >=
                                                             MovingPair::size_of(pair_.b(), at.b)));
    }
    pair_.clearance() > 0 ? solve_within_clearance(at) : meet_in_translation(at);
}

// The pair with one of its nodes replaced by the child that may be in contact first, or by the
// first triangle of a leaf.
ContactQuery::Entry ContactQuery::nearer_half(const Entry& entry, bool opens_a) {
    const NodeRef &ref = opens_a ? entry.a : entry.b, other = opens_a ? entry.b : entry.a;
    const TreeView& tree = (opens_a ? pair_.a() : pair_.b()).tree();
    const Node& node = tree.node(ref);
    tree.prepare(ref);
    const bool is_leaf = TreeView::is_leaf(node);
    const NodeRef first = TreeView::triangle_ref(ref, ref.begin);
    const std::array<NodeRef, 2> parts =
        is_leaf ? std::array{first, first} : tree.children(ref, node);
    const std::array<NodeRef, 2> others{other, other};
    pair_.set_time(entry.time);
    pair_.place(opens_a ? parts : others, opens_a ? others : parts);
    const std::array<double, 2> steps = pair_.steps(pair_.box_frame(entry.time), pair_.duration());
    counts_.box_tests += 2;
    Entry half = entry;
    (opens_a ? half.a : half.b) = parts[steps[1] < steps[0] ? 1 : 0];
    return half;
}

void ContactQuery::set_planes(const Entry& entry, const Touch& touch) {
    exact_pops_ = counts_.pops;
    if (has_limits()) {
        ties_.clear();
    } else {
        ties_.set(pair_, entry.refs(), touch, counts_.pops);
    }
}

// Goes on with the pair that was looked at, as the planes of the earliest contact say.
void ContactQuery::take_tie(TiePlanes::Verdict verdict) {
    if (verdict == TiePlanes::Verdict::kUnknown) {
        part(*looked_at_);
    } else if (verdict == TiePlanes::Verdict::kAllIsLater) {
        queue_.clear();
    }
}

} // namespace obb
