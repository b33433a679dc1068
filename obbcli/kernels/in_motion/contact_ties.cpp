// How a contact query tells ties: translations after which thousands of pairs touch at the same
// time, as faces do that land on each other, or triangles that a mesh holds many times. The plane
// of the earliest contact shows of all vertices under two nodes that none touches earlier.
#include "in_motion/contact_query.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obb {

namespace {

// Pops after which a contact is looked for ahead of its time, and since the earliest one so far:
// few questions get that far.
constexpr std::uint64_t kProbePatience = 1024;
constexpr std::uint64_t kTiePatience = 64;
// By how much boxes may reach beyond a plane that what they hold does not cross, of the size of
// their extents and of their distance from the pivot: they were turned as well, and the plane's
// normal is rounded.
constexpr double kReachesBeyond = 8 * kBoxRounding;

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

// Of bodies that come within a clearance, the plane's two sides are that far apart then, and
// further before: what holds of contact holds of nearness.
void ContactQuery::set_planes(const Entry& entry, const Touch& touch) {
    planes_.clear();
    exact_pops_ = counts_.pops;
    if (has_limits()) {
        return;
    }
    const LinearMotion motion = pair_.linear_motion();
    const Triangle a = pair_.a().posed_triangle(entry.a), b = pair_.b().posed_triangle(entry.b);
    for (const auto& plane : {ContactPlane::of_axis(a, b, motion, touch),
                              ContactPlane::of_motion(a, b, motion, touch)}) {
        if (plane) {
            const Vec3 n = plane->normal();
            planes_.push_back({*plane, n, top_of(pair_.a().triangle(entry.a), n),
                               -top_of(pair_.b().triangle(entry.b), -n)});
        }
    }
    crowd_ = {};
    tie_pops_ = counts_.pops + kTiePatience;
}

double ContactQuery::top_of(const Triangle& t, Vec3 direction) {
    return std::max({dot(t[0], direction), dot(t[1], direction), dot(t[2], direction)});
}

bool ContactQuery::may_tie(const Entry& entry) const {
    if (planes_.empty() || counts_.pops < tie_pops_) {
        return false;
    }
    return crowd_.may_look_at(entry.a.triangle_count() + entry.b.triangle_count());
}

// Whether both boxes are on their own sides of the plane, up to their rounding.
bool ContactQuery::are_sides(const Entry& entry, const Tie& tie) const {
    const auto reaches = [](const MovingTree& body, const NodeRef& ref, Vec3 n, double top) {
        const Obb box = body.box(ref);
        double height = dot(box.center, n);
        for (std::size_t k = 0; k < 3; ++k) {
            height += box.half_extents[k] * std::fabs(dot(box.axes[k], n));
        }
        return height <= top + kReachesBeyond * (norm_1(box.half_extents) + norm_1(box.center));
    };
    return reaches(pair_.a(), entry.a, tie.normal, tie.top_of_a) &&
           reaches(pair_.b(), entry.b, -tie.normal, -tie.bottom_of_b);
}

// Looks for a plane that may prove that nothing under a pair touches before the earliest contact
// known, and opens the pair where there is none. The bodies as a whole are looked at first: a plane
// that holds for them ends the search.
void ContactQuery::look_for_tie(const Entry& entry) {
    if (crowd_.starts_with_all()) {
        Entry all = entry;
        all.a = pair_.a().tree().root();
        all.b = pair_.b().tree().root();
        if (waits_for(all, entry, 0)) {
            return;
        }
    }
    if (!waits_for(entry, entry, 0)) {
        part(entry);
    }
}

bool ContactQuery::waits_for(const Entry& candidate, const Entry& entry, std::size_t plane) {
    for (; plane < planes_.size(); ++plane) {
        if (are_sides(candidate, planes_[plane])) {
            wait_ = Wait{{candidate, entry}, plane, candidate.a.begin, candidate.b.begin, {}};
            wait_->nodes.begin(pair_.a().tree(), pair_.b().tree());
            return true;
        }
    }
    return false;
}

// Goes on with vertices one by one, in slices: both nodes may hold whole meshes.
bool ContactQuery::end_wait(SliceClock& clock) {
    Wait& wait = *wait_;
    if (!wait.nodes.advance(clock)) {
        return false;
    }
    const ContactPlane& plane = planes_[wait.plane].plane;
    const auto all_hold = [&](const MovingTree& body, std::uint32_t position, RecentVertices& seen,
                              const auto& holds) {
        const Triangle t = body.posed_triangle({position, position + 1, 0, 0});
        const Corners& corners = body.tree().corners[position];
        for (std::size_t k = 0; k < 3; ++k) {
            if (!seen.add(corners[k]) && !holds(t[k])) {
                return false;
            }
        }
        return true;
    };
    bool holds = true;
    for (; holds && wait.next_a < wait.nodes.candidate.a.end; ++wait.next_a) {
        if (clock.is_over()) {
            return false;
        }
        holds = all_hold(pair_.a(), wait.next_a, wait.seen[0],
                         [&](const Vec3& p) { return plane.holds_a(p); });
    }
    for (; holds && wait.next_b < wait.nodes.candidate.b.end; ++wait.next_b) {
        if (clock.is_over()) {
            return false;
        }
        holds = all_hold(pair_.b(), wait.next_b, wait.seen[1],
                         [&](const Vec3& p) { return plane.holds_b(p); });
    }
    const Entry candidate = wait.nodes.candidate, entry = wait.nodes.pair;
    const std::size_t next = wait.plane + 1;
    wait_.reset();
    const bool is_pair = key_of(candidate.a, candidate.b) == key_of(entry.a, entry.b) &&
                         candidate.a.end == entry.a.end && candidate.b.end == entry.b.end;
    if (holds && !is_pair) {
        queue_.clear();
    } else if (!holds) {
        crowd_.fail(candidate.a.triangle_count() + candidate.b.triangle_count());
        if (!waits_for(candidate, entry, next) && (is_pair || !waits_for(entry, entry, 0))) {
            part(entry);
        }
    }
    return true;
}

} // namespace obb
