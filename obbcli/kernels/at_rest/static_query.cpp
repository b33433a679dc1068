#include "at_rest/static_query.hpp"

#include "descent/query_frame.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace obb {

StaticQuery::StaticQuery(const TreeView& a, const Pose& pose_a, const TreeView& b,
                         const Pose& pose_b, const StaticQueryOptions& options)
    : a_(a, pose_a), b_(b, pose_b), options_(options), is_coarse_(options.boxes != BoxLimits{}) {
    const QueryFrame frame = set_common_frame(a_, b_);
    bound_ = frame.bound;
    exponent_ = frame.exponent;
    frame_.set(a_, b_, bound_);
    waiting_nodes_.fill(&kNoBox);
    begin();
}

void StaticQuery::stop() {
    stack_.clear();
    waiting_count_ = 0;
    forget_ahead();
}

void StaticQuery::forget_ahead() {
    for (Ahead& ahead : ahead_) {
        ahead.place = kNowhere;
    }
}

// Each surface touches its box, so two boxes that meet hold surfaces no further apart than their
// diagonals. Shapes that every axis left undecided need not quite meet. With e what a projection
// may be off by, the gap is at most 2 e along the normal of a face; along the product of two edges
// at an angle of sine s, it is 2 e / s, but turning one shape until they are parallel moves nothing
// by more than s times its size. So the gap is of the order of sqrt(e size) whatever s is, and
// alike for short edges and thin triangles. Climbing through boxes and triangles of all proportions
// found no gap above 1.01 (sqrt(e size) + e), with e of the bound in use, as skewed poses widen it,
// and the size below: what the box tests take for the size of shapes so close never exceeds it.
// Four times that is added here.
double StaticQuery::distance_bound(const Pair& pair) const {
    // Squares of what is far smaller than the scene vanish, and so may products: hence std::hypot
    // and two roots.
    const auto length = [](Vec3 v) { return std::hypot(v.x, v.y, v.z); };
    const auto diagonal = [&](const PosedTree& body, const NodeRef& ref) {
        return ref.is_triangle() ? 0.0 : 2.0 * length(body.box(body.tree().node(ref)).half_extents);
    };
    const auto extent = [&](const PosedTree& body, const NodeRef& ref) {
        if (!ref.is_triangle()) {
            return diagonal(body, ref);
        }
        const Triangle t = body.triangle_in_frame(ref);
        return length(t[1] - t[0]) + length(t[2] - t[0]);
    };
    const double extents = extent(a_, pair.a) + extent(b_, pair.b);
    const double size = 8.0 * (extents + bound_.absolute);
    const double e = bound_.relative * size + bound_.absolute;
    const double slack = 4.0 * (std::sqrt(e) * std::sqrt(size) + e);
    const double bound = std::ldexp(diagonal(a_, pair.a) + diagonal(b_, pair.b) + slack, exponent_);
    // Upwards, for subnormal bounds are rounded by more than the slack.
    const double largest = std::numeric_limits<double>::max();
    return std::fmin(std::nextafter(bound, std::numeric_limits<double>::infinity()), largest);
}

// From the lowest up.
std::vector<StaticQuery::Pair> StaticQuery::take_stack() {
    std::vector<Pair> pairs;
    pairs.reserve(stack_.size());
    for (std::size_t k = 0; k < stack_.size(); ++k) {
        pairs.push_back(stack_[k]);
    }
    stack_.clear();
    return pairs;
}

std::vector<StaticQuery> StaticQuery::divide(std::size_t count) {
    // What waits belongs to one part alone.
    if (waiting_count_ > 0) {
        open_waiting();
    }
    forget_ahead();
    std::vector<Pair> wide = take_stack();
    while (!wide.empty() && wide.size() < count) {
        std::vector<Pair> next;
        for (const Pair& pair : wide) {
            stack_.push_back(pair);
            pop_alone();
            const std::vector<Pair> left = take_stack();
            next.insert(next.end(), left.begin(), left.end());
        }
        wide = std::move(next);
    }
    StaticQuery empty = *this;
    empty.pairs_.clear();
    empty.counts_ = {};
    std::vector<StaticQuery> parts(wide.size(), empty);
    for (std::size_t k = 0; k < wide.size(); ++k) {
        parts[k].stack_.push_back(wide[k]);
    }
    return parts;
}

void StaticQuery::join(std::span<StaticQuery> parts) {
    std::size_t count = pairs_.size();
    for (const StaticQuery& part : parts) {
        count += part.pairs_.size();
    }
    pairs_.reserve(count);
    for (StaticQuery& part : parts) {
        // No pair is held twice for longer than that takes.
        const std::vector<TrianglePair> found = part.take_pairs();
        pairs_.insert(pairs_.end(), found.begin(), found.end());
        counts_ += part.counts_;
    }
    finish();
}

void StaticQuery::finish() {
    std::sort(pairs_.begin(), pairs_.end());
    is_finished_ = true;
}

} // namespace obb
