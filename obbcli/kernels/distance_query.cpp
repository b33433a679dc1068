#include "distance_query.hpp"

#include "box_distance.hpp"
#include "predicates.hpp"
#include "query_frame.hpp"
#include "scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace obb {

namespace {

// Bounds this close, as a share of the distance, are settled: a few units in its last place.
constexpr double kSettled = 0x1p-50;
// After so many pairs of triangles of about the same distance (plates face to face have thousands)
// it is enough to know the rest to a unit in the last place of the scene's size.
constexpr std::uint64_t kManyTies = 256;
constexpr double kSettledOfMany = 0x1p-50;
// So many pairs of triangles are measured one by one rather than by smaller boxes.
constexpr std::uint32_t kBatch = 6;
// A search that takes more pops than this does pairs of so few triangles depth-first: the queue
// costs more than it saves once the least distance is about known.
constexpr std::uint64_t kPatience = 512;
constexpr std::uint32_t kSmall = 512;

// A length times 2^exponent, one place further down or up where that rounds.
[[nodiscard]] double scaled_down(double length, int exponent) {
    const double result = std::ldexp(length, exponent);
    return std::ldexp(result, -exponent) > length ? std::nextafter(result, 0.0) : result;
}
[[nodiscard]] double scaled_up(double length, int exponent) {
    const double result = std::ldexp(length, exponent);
    return std::ldexp(result, -exponent) < length ? std::nextafter(result, HUGE_VAL) : result;
}

[[nodiscard]] std::pair<std::int64_t, std::int64_t> ids(const DistanceBounds& b) {
    return {b.triangle_a, b.triangle_b};
}

} // namespace

DistanceQuery::DistanceQuery(const TreeView& a, const Pose& pose_a, const TreeView& b,
                             const Pose& pose_b, const DistanceQueryOptions& options)
    : a_(a, pose_a), b_(b, pose_b), options_(options) {
    const QueryFrame frame = set_common_frame(a_, b_);
    bound_ = frame.bound;
    shrink_ = frame.shrink;
    exponent_ = frame.exponent;
    unit_ = std::abs(exponent_) <= 700 ? std::ldexp(1.0, -exponent_) : 0.0;
    tolerance_ = std::ldexp(options.tolerance, -exponent_);
    box_units_ = {std::ldexp(1.0, a.scale_exponent - exponent_),
                  std::ldexp(1.0, b.scale_exponent - exponent_)};
    queue_.push_back({0.0, a.root(), b.root(), {}});
    descend(queue_.front());
}

bool DistanceQuery::advance(std::uint64_t max_pops) {
    for (;; --max_pops) {
        while (!stack_.empty() && is_settled(stack_.back().key)) {
            low_ = std::min(low_, stack_.back().key);
            stack_.pop_back();
        }
        if (stack_.empty() && (queue_.empty() || is_settled(queue_.front().key))) {
            return true;
        }
        if (max_pops == 0) {
            return false;
        }
        if (stack_.empty()) {
            std::pop_heap(queue_.begin(), queue_.end(), IsLater{});
            stack_.push_back(queue_.back());
            queue_.pop_back();
        }
        const Pair pair = stack_.back();
        stack_.pop_back();
        ++counts_.pops;
        visit(pair);
    }
}

// Straight down to one pair of triangles, the nearer child each time: its distance keeps most of
// the rest from the queue.
void DistanceQuery::descend(Pair pair) {
    const auto middle = [](const Side& side) {
        const Triangle& t = side.triangle;
        return side.ref.is_triangle() ? (1.0 / 3.0) * (t[0] + t[1] + t[2]) : side.box.center;
    };
    const auto nearer = [&](const PosedTree& body, const NodeRef& ref, const Side& other) {
        const Node& node = body.tree().node(ref);
        if (TreeView::is_leaf(node)) {
            body.tree().prepare(ref);
            return TreeView::triangle_ref(ref, ref.begin);
        }
        const auto refs = body.tree().children(ref, node);
        const Side one = reach(body, refs[0]), two = reach(body, refs[1]);
        const double to_one = bound(one, other), to_two = bound(two, other);
        const Vec3 m = middle(other);
        const bool is_one =
            to_one != to_two ? to_one < to_two : norm(middle(one) - m) < norm(middle(two) - m);
        return refs[is_one ? 0 : 1];
    };
    for (;;) {
        const Next how = next(pair);
        if (how == Next::kOpenA) {
            pair.a = nearer(a_, pair.a, reach(b_, pair.b));
        } else if (how == Next::kOpenB) {
            pair.b = nearer(b_, pair.b, reach(a_, pair.a));
        } else {
            break;
        }
    }
    a_.tree().prepare_triangles(pair.a, 1);
    b_.tree().prepare_triangles(pair.b, 1);
    take(measure(a_.triangle(pair.a), b_.triangle(pair.b)), pair.a, pair.b);
}

DistanceQuery::Next DistanceQuery::next(const Pair& pair) const {
    const bool is_box_a = !pair.a.is_triangle(), is_box_b = !pair.b.is_triangle();
    if (!is_box_a && !is_box_b) {
        return Next::kMeasure;
    }
    const Node* node_a = is_box_a ? &a_.tree().node(pair.a) : nullptr;
    const Node* node_b = is_box_b ? &b_.tree().node(pair.b) : nullptr;
    const bool opens_a = is_box_a && is_open(*node_a, pair.a, options_.max_depth_a);
    const bool opens_b = is_box_b && is_open(*node_b, pair.b, options_.max_depth_b);
    if (opens_a == is_box_a && opens_b == is_box_b &&
        pair.a.triangle_count() * std::uint64_t{pair.b.triangle_count()} <= kBatch) {
        return Next::kMeasure;
    }
    if (opens_a && opens_b) {
        const double size_a = box_units_[0] * norm_inf(half_extents_of(*node_a));
        const double size_b = box_units_[1] * norm_inf(half_extents_of(*node_b));
        return size_a >= size_b ? Next::kOpenA : Next::kOpenB;
    }
    return opens_a ? Next::kOpenA : opens_b ? Next::kOpenB : Next::kClose;
}

bool DistanceQuery::is_open(const Node& node, const NodeRef& ref, std::uint32_t max_depth) const {
    return ref.depth < max_depth && !(options_.boxes_for_leaves && TreeView::is_leaf(node));
}

DistanceQuery::Side DistanceQuery::reach(const PosedTree& body, const NodeRef& ref) const {
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
    switch (next(pair)) {
    case Next::kOpenA:
        return open<true>(pair);
    case Next::kOpenB:
        return open<false>(pair);
    case Next::kMeasure:
        return measure_all(pair);
    case Next::kClose:
        return close(pair);
    }
}

template <bool kOpensA>
void DistanceQuery::open(const Pair& pair) {
    const PosedTree& body = kOpensA ? a_ : b_;
    const NodeRef& ref = kOpensA ? pair.a : pair.b;
    const Side other = reach(kOpensA ? b_ : a_, kOpensA ? pair.b : pair.a);
    const Node& node = body.tree().node(ref);
    const auto add_child = [&](const NodeRef& child, double key) {
        key = std::max(pair.key, key);
        add(kOpensA ? Pair{key, child, pair.b, {}} : Pair{key, pair.a, child, {}});
    };
    if (TreeView::is_leaf(node)) {
        body.tree().prepare(ref);
        for (std::uint32_t i = ref.begin; i < ref.end; ++i) {
            const NodeRef child = TreeView::triangle_ref(ref, i);
            add_child(child, bound(reach(body, child), other));
        }
        return;
    }
    const auto refs = body.tree().children(ref, node);
    const auto keys = bounds_of_children<kOpensA>(refs, other);
    const std::size_t last = keys[0] < keys[1] ? 0 : 1; // of a stack, the next
    add_child(refs[1 - last], keys[1 - last]);
    add_child(refs[last], keys[last]);
}

// Two boxes against one are bounded at once.
template <bool kOpensA>
std::array<double, 2> DistanceQuery::bounds_of_children(const std::array<NodeRef, 2>& children,
                                                        const Side& other) {
    const PosedTree& body = kOpensA ? a_ : b_;
    if (children[0].is_triangle() || children[1].is_triangle() || other.ref.is_triangle()) {
        return {bound(reach(body, children[0]), other), bound(reach(body, children[1]), other)};
    }
    counts_.box_tests += 2;
    const TreeView& tree = body.tree();
    const BasicObb<Pack> boxes = body.boxes(tree.node(children[0]), tree.node(children[1]));
    const Pack squares = distance_square(boxes, broadcast(other.box), bound_);
    return {shrink_ * std::sqrt(squares[0]), shrink_ * std::sqrt(squares[1])};
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

double DistanceQuery::low_in_unit(double length, int exponent) const {
    return exponent == 0 && unit_ > 0 ? unit_ * length : scaled_down(length, exponent - exponent_);
}

double DistanceQuery::high_in_unit(double length, int exponent) const {
    return exponent == 0 && unit_ > 0 ? unit_ * length : scaled_up(length, exponent - exponent_);
}

bool DistanceQuery::is_settled(double key) const {
    double slack = kSettled * high_;
    if (counts_.exact_triangle_tests > kManyTies) {
        slack = std::max(slack, std::min(kSettledOfMany, 0x1p-20 * high_));
    }
    return high_ - key <= std::max(tolerance_, slack);
}

void DistanceQuery::add(const Pair& pair) {
    if (is_settled(pair.key)) {
        low_ = std::min(low_, pair.key);
    } else if (counts_.pops > kPatience && pair.features.kind == NearFeatures::Kind::kNone &&
               pair.a.triangle_count() + pair.b.triangle_count() <= kSmall) {
        stack_.push_back(pair);
    } else {
        queue_.push_back(pair);
        std::push_heap(queue_.begin(), queue_.end(), IsLater{});
    }
}

void DistanceQuery::measure_all(const Pair& pair) {
    a_.tree().prepare_triangles(pair.a, pair.a.triangle_count());
    b_.tree().prepare_triangles(pair.b, pair.b.triangle_count());
    std::array<Triangle, kBatch> of_b;
    for (std::uint32_t j = pair.b.begin; j < pair.b.end; ++j) {
        of_b[j - pair.b.begin] = b_.triangle(TreeView::triangle_ref(pair.b, j));
    }
    for (std::uint32_t i = pair.a.begin; i < pair.a.end; ++i) {
        const NodeRef ref_a = TreeView::triangle_ref(pair.a, i);
        const Triangle a = a_.triangle(ref_a);
        for (std::uint32_t j = pair.b.begin; j < pair.b.end; ++j) {
            const Triangle& b = of_b[j - pair.b.begin];
            const DistanceBound least = distance_bound(a, b);
            const double key = std::max(pair.key, low_in_unit(least.low, least.exponent));
            ++counts_.triangle_tests;
            if (is_settled(key)) {
                low_ = std::min(low_, key);
            } else {
                measure_one({key, ref_a, TreeView::triangle_ref(pair.b, j), {}}, a, b);
            }
        }
    }
}

void DistanceQuery::measure_one(const Pair& pair, const Triangle& a, const Triangle& b) {
    const TriangleDistance found = measure(a, b);
    Pair measured = pair;
    measured.key = std::max(pair.key, low_in_unit(found.low, found.exponent));
    if (measured.key == 0) {
        const TriangleVerdict verdict = test_triangles(a, b);
        counts_.exact_triangle_tests += verdict.exact ? 1 : 0;
        if (verdict.intersects) {
            touch(pair.a, pair.b);
            return;
        }
    }
    measured.features = found.features;
    take(found, pair.a, pair.b);
    add(measured);
}

void DistanceQuery::refine(const Pair& pair) {
    ++counts_.exact_triangle_tests;
    const TriangleDistance found =
        measure_finely(a_.triangle(pair.a), b_.triangle(pair.b), pair.features);
    take(found, pair.a, pair.b);
    low_ = std::min(low_, std::max(pair.key, low_in_unit(found.low, found.exponent)));
}

// Boxes that stand for what they hold: any of their triangles will do for an upper bound.
void DistanceQuery::close(const Pair& pair) {
    low_ = std::min(low_, pair.key);
    a_.tree().prepare_triangles(pair.a, 1);
    b_.tree().prepare_triangles(pair.b, 1);
    const Triangle a = a_.triangle(pair.a), b = b_.triangle(pair.b);
    ++counts_.triangle_tests;
    if (triangles_intersect(a, b)) {
        touch(pair.a, pair.b);
    } else {
        take(measure(a, b), pair.a, pair.b);
    }
}

void DistanceQuery::take(const TriangleDistance& found, const NodeRef& a, const NodeRef& b) {
    const double high = high_in_unit(found.high, found.exponent);
    const DistanceBounds one{0, 0, found.point_a, found.point_b, a_.id(a), b_.id(b)};
    if (high < high_ || (high == high_ && ids(one) < ids(best_))) {
        high_ = high;
        best_ = one;
    }
}

void DistanceQuery::touch(const NodeRef& a, const NodeRef& b) {
    const Vec3 point = common_point(a_.triangle(a), b_.triangle(b));
    low_ = high_ = 0;
    best_ = {0, 0, point, point, a_.id(a), b_.id(b)};
    queue_.clear();
    stack_.clear();
}

DistanceBounds DistanceQuery::bounds() const {
    double low = std::min(low_, high_);
    if (!queue_.empty()) {
        low = std::min(low, queue_.front().key);
    }
    for (const Pair& pair : stack_) {
        low = std::min(low, pair.key);
    }
    DistanceBounds result = best_;
    result.low = scaled_down(low, exponent_);
    result.high = scaled_up(high_, exponent_);
    if (!std::isfinite(result.high)) {
        throw std::domain_error("the distance exceeds the range of double");
    }
    return result;
}

} // namespace obb
