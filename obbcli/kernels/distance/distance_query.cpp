#include "distance/distance_query.hpp"

#include "descent/box_distance.hpp"
#include "descent/query_frame.hpp"
#include "work/slice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace obb {

namespace {

// Bounds this close, as a share of the distance, are settled: a few units in its last place.
constexpr double kSettled = 0x1p-50;
// After so many pairs of triangles of about the same distance (plates face to face have thousands)
// it is enough to know the rest to a unit in the last place of the scene's size.
constexpr std::uint64_t kManyTies = 256;
constexpr double kSettledOfMany = 0x1p-50;
// What waits on the way down to a first pair of triangles.
constexpr std::size_t kReserved = 64;

} // namespace

DistanceQuery::DistanceQuery(const TreeView& a, const Pose& pose_a, const TreeView& b,
                             const Pose& pose_b, const Limits& limits)
    : a_(a, pose_a), b_(b, pose_b), boxes_(limits.boxes), is_coarse_(limits.boxes != BoxLimits{}) {
    const QueryFrame frame = set_common_frame(a_, b_);
    bound_ = frame.bound;
    shrink_ = frame.shrink;
    exponent_ = frame.exponent;
    unit_ = std::abs(exponent_) <= 700 ? std::ldexp(1.0, -exponent_) : 0.0;
    tolerance_ = std::ldexp(std::max(limits.distance_tolerance, 0.0), -exponent_);
    const int half = -exponent_ / 2;
    unit_factors_ = {std::ldexp(1.0, half), std::ldexp(1.0, -exponent_ - half)};
    frame_.set(a_, b_, bound_, shrink_);
    openings_[0].nodes.fill(&kNoBox);
    openings_[1].nodes.fill(&kNoBox);
    queue_.reserve(kReserved);
    stack_.reserve(kReserved);
    stack_.push_back({0.0, a.root(), b.root(), {}});
    // Straight down to one pair of triangles, the nearest children each time: the distance that is
    // found there keeps most of the rest from the queue. A damaged tree may hold what has none.
    while (is_diving() && !(stack_.empty() && queue_.is_empty())) {
        visit(pop());
    }
}

DistanceQuery::Pair DistanceQuery::pop() {
    if (stack_.empty()) {
        return queue_.pop();
    }
    const Pair pair = stack_.back();
    stack_.pop_back();
    return pair;
}

bool DistanceQuery::advance(std::uint64_t max_pops) {
    SliceClock clock;
    for (;;) {
        if (wait_) {
            if (!wait_->advance(clock)) {
                return false;
            }
            end_wait();
            continue;
        }
        while (!stack_.empty() && is_settled(stack_.back().key)) {
            settle(stack_.back().key);
            stack_.pop_back();
        }
        if (stack_.empty() && (queue_.is_empty() || is_settled(queue_.next_time()))) {
            if (!open_waiting()) {
                return true;
            }
            continue;
        }
        if (max_pops == 0 || clock.is_over()) {
            return false;
        }
        --max_pops;
        ++counts_.pops;
        visit(pop());
    }
}

DistanceQuery::Side DistanceQuery::side_of(const PosedTree& body, const NodeRef& ref) const {
    Side side;
    side.ref = ref;
    if (ref.is_triangle()) {
        side.triangle = body.triangle_in_frame(ref);
    } else {
        side.box = body.box(body.tree().node(ref));
    }
    return side;
}

void DistanceQuery::visit(const Pair& pair) {
    if (pair.features.kind != NearFeatures::Kind::kNone) {
        refine(pair);
        return;
    }
    if (may_tie(pair)) {
        look_for_tie(pair);
    } else {
        part(pair);
    }
}

// Of two triangles nothing yet: they are measured when their turn comes.
double DistanceQuery::bound(const Side& a, const Side& b) {
    if (a.ref.is_triangle() && b.ref.is_triangle()) {
        return 0;
    }
    ++counts_.box_tests;
    const double square = a.ref.is_triangle()   ? distance_square(b.box, a.triangle, bound_)
                          : b.ref.is_triangle() ? distance_square(a.box, b.triangle, bound_)
                                                : distance_square(a.box, b.box, bound_);
    return shrink_ * std::sqrt(square);
}

double DistanceQuery::slack() const {
    const double share = kSettled * high_;
    return std::max(tolerance_, has_many_ties()
                                    ? std::max(share, std::min(kSettledOfMany, 0x1p-20 * high_))
                                    : share);
}

bool DistanceQuery::has_many_ties() const { return counts_.exact_triangle_tests > kManyTies; }

void DistanceQuery::add(const Pair& pair) {
    if (is_settled(pair.key)) {
        settle(pair.key);
    } else if (pair.features.kind == NearFeatures::Kind::kNone && is_stacked(pair.a, pair.b)) {
        stack_.push_back(pair);
    } else {
        // Of a leaf, what it still has comes after what it had.
        queue_.push(pair, pair.key, pair.next > 0 ? 0 : pair.a.depth + pair.b.depth);
    }
}

} // namespace obb
