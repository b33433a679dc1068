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
// Boxes so much smaller than the other, as a share of its size, wait for it to be opened first.
constexpr double kMuchSmaller = 0.5;
// A search that takes more pops than this does pairs of so few triangles depth-first: the queue
// costs more than it saves once the least distance is about known.
constexpr std::uint64_t kPatience = 512;
constexpr std::uint32_t kSmall = 512;

} // namespace

DistanceQuery::DistanceQuery(const TreeView& a, const Pose& pose_a, const TreeView& b,
                             const Pose& pose_b, const Limits& limits)
    : a_(a, pose_a), b_(b, pose_b), boxes_(limits.boxes) {
    const QueryFrame frame = set_common_frame(a_, b_);
    bound_ = frame.bound;
    shrink_ = frame.shrink;
    exponent_ = frame.exponent;
    unit_ = std::abs(exponent_) <= 700 ? std::ldexp(1.0, -exponent_) : 0.0;
    tolerance_ = std::ldexp(std::max(limits.distance_tolerance, 0.0), -exponent_);
    box_units_ = {std::ldexp(1.0, a.scale_exponent - exponent_),
                  std::ldexp(1.0, b.scale_exponent - exponent_)};
    const int half = -exponent_ / 2;
    unit_factors_ = {std::ldexp(1.0, half), std::ldexp(1.0, -exponent_ - half)};
    for (std::size_t k = 0; k < 3; ++k) {
        lanes_->matrix[k] = halves(a_.matrix().rows[k], b_.matrix().rows[k]);
    }
    lanes_->shift = halves(a_.offset(), b_.offset());
    lanes_->node_scale = halves(box_units_[0], box_units_[1]);
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
            return true;
        }
        if (max_pops == 0 || clock.is_over()) {
            return false;
        }
        --max_pops;
        ++counts_.pops;
        visit(pop());
    }
}

DistanceQuery::Next DistanceQuery::next(const Pair& pair) const {
    const bool is_box_a = !pair.a.is_triangle(), is_box_b = !pair.b.is_triangle();
    if (!is_box_a && !is_box_b) {
        return Next::kMeasure;
    }
    const Node* node_a = is_box_a ? &a_.tree().node(pair.a) : nullptr;
    const Node* node_b = is_box_b ? &b_.tree().node(pair.b) : nullptr;
    const bool opens_a = is_box_a && is_open(*node_a, pair.a, boxes_.max_depth_a);
    const bool opens_b = is_box_b && is_open(*node_b, pair.b, boxes_.max_depth_b);
    if (opens_a == is_box_a && opens_b == is_box_b && pair.a.triangle_count() <= kFew &&
        pair.b.triangle_count() <= kFew) {
        return Next::kMeasure;
    }
    if (opens_a && opens_b) {
        const double size_a = box_units_[0] * norm_inf(half_extents_of(*node_a));
        const double size_b = box_units_[1] * norm_inf(half_extents_of(*node_b));
        if (pair.b.triangle_count() <= kFew || size_b < kMuchSmaller * size_a) {
            return Next::kOpenA;
        }
        return pair.a.triangle_count() <= kFew || size_a < kMuchSmaller * size_b ? Next::kOpenB
                                                                                 : Next::kOpenBoth;
    }
    return opens_a ? Next::kOpenA : opens_b ? Next::kOpenB : Next::kClose;
}

bool DistanceQuery::is_open(const Node& node, const NodeRef& ref, std::uint32_t max_depth) const {
    return ref.depth < max_depth && !(boxes_.boxes_for_leaves && TreeView::is_leaf(node));
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

void DistanceQuery::part(const Pair& pair) {
    const Next how = next(pair);
    if (how == Next::kMeasure) {
        measure_all(pair);
    } else if (how == Next::kClose) {
        close(pair);
    } else {
        open(pair, how != Next::kOpenB, how != Next::kOpenA);
    }
}

DistanceQuery::Part DistanceQuery::part_of(const PosedTree& body, const NodeRef& ref,
                                           bool opens) const {
    if (!opens) {
        return {{ref, ref}, 1};
    }
    return {body.tree().children(ref, body.tree().node(ref)), 2};
}

void DistanceQuery::open(const Pair& pair, bool opens_a, bool opens_b) {
    for (const bool is_a : {true, false}) {
        if ((is_a ? opens_a : opens_b) &&
            TreeView::is_leaf((is_a ? a_ : b_).tree().node(is_a ? pair.a : pair.b))) {
            return open_leaf(pair, is_a);
        }
    }
    const Part a = part_of(a_, pair.a, opens_a), b = part_of(b_, pair.b, opens_b);
    const auto has_triangle = [](const Part& part) {
        return part.refs[0].is_triangle() || part.refs[1].is_triangle();
    };
    if (has_triangle(a) || has_triangle(b)) {
        add_one_by_one(pair, a, b);
    } else {
        add_by_lanes(pair, a, b);
    }
}

// Some triangles at a time, the rest after what they lead to: leaves may hold whole meshes, and
// neither the queue nor the time between two looks at the clock should.
void DistanceQuery::open_leaf(const Pair& pair, bool opens_a) {
    constexpr std::uint32_t kTrianglesAPop = 64;
    const PosedTree& body = opens_a ? a_ : b_;
    const NodeRef& ref = opens_a ? pair.a : pair.b;
    body.tree().prepare(ref);
    const Side other = side_of(opens_a ? b_ : a_, opens_a ? pair.b : pair.a);
    const std::uint32_t begin = ref.begin + pair.next;
    const std::uint32_t end = begin + std::min(kTrianglesAPop, ref.end - begin);
    if (end < ref.end) {
        Pair rest = pair;
        rest.next = end - ref.begin;
        add(rest);
    }
    for (std::uint32_t i = begin; i < end; ++i) {
        const NodeRef child = TreeView::triangle_ref(ref, i);
        const double key = std::max(pair.key, bound(side_of(body, child), other));
        add(opens_a ? Pair{key, child, pair.b, {}} : Pair{key, pair.a, child, {}});
    }
}

void DistanceQuery::add_one_by_one(const Pair& pair, const Part& a, const Part& b) {
    for (std::uint32_t i = 0; i < a.count; ++i) {
        const Side side_a = side_of(a_, a.refs[i]);
        for (std::uint32_t j = 0; j < b.count; ++j) {
            const double key = bound(side_a, side_of(b_, b.refs[j]));
            add({std::max(pair.key, key), a.refs[i], b.refs[j], {}});
        }
    }
}

// The nearest of them is next where a dive or a stack goes on with it.
void DistanceQuery::add_by_lanes(const Pair& pair, const Part& a, const Part& b) {
    BasicObb<Four> boxes;
    place_boxes(*lanes_,
                {&a_.tree().node(a.refs[0]), &a_.tree().node(a.refs[1]), &b_.tree().node(b.refs[0]),
                 &b_.tree().node(b.refs[1])},
                boxes);
    const BoxGaps gaps = box_gaps(boxes, bound_);
    const std::uint32_t count = a.count * b.count;
    std::array<Pair, 4> pairs;
    std::uint32_t nearest = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
        const double key = std::max(pair.key, shrink_ * std::sqrt(gaps.squares[k]));
        pairs[k] = {key, a.refs[k % 2], b.refs[kSecond[k]], {}};
        if (key < pairs[nearest].key ||
            (key == pairs[nearest].key && gaps.center_squares[k] < gaps.center_squares[nearest])) {
            nearest = k;
        }
    }
    counts_.box_tests += count;
    for (std::uint32_t k = 0; k < count; ++k) {
        if (k != nearest) {
            add(pairs[k]);
        }
    }
    if (is_diving() || pairs[nearest].key == 0) {
        stack_.push_back(pairs[nearest]);
    } else {
        add(pairs[nearest]);
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

bool DistanceQuery::is_settled(double key) const { return !is_diving() && high_ - key <= slack(); }

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
    } else if (counts_.pops > kPatience && pair.features.kind == NearFeatures::Kind::kNone &&
               pair.a.triangle_count() + pair.b.triangle_count() <= kSmall) {
        stack_.push_back(pair);
    } else {
        // Of a leaf, what it still has comes after what it had.
        queue_.push(pair, pair.key, pair.next > 0 ? 0 : pair.a.depth + pair.b.depth);
    }
}

} // namespace obb
