#include "static_query.hpp"

#include "predicates.hpp"
#include "query_frame.hpp"
#include "scale.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace obb {

void PosedTree::set_frame(const Mat3& matrix, Vec3 offset, int exponent) {
    matrix_ = matrix;
    offset_ = offset;
    is_moved_ = !(matrix == Mat3::identity() && offset == Vec3{0, 0, 0});
    scale_ = std::ldexp(1.0, tree_->scale_exponent - exponent);
    const int half = -exponent / 2;
    vertex_scales_ = {std::ldexp(1.0, half), std::ldexp(1.0, -exponent - half)};
}

template <typename Real>
BasicObb<Real> PosedTree::in_frame(BasicObb<Real> box) const {
    const auto turned = [&](Vector3<Real> v) {
        const auto& m = matrix_.rows;
        return Vector3<Real>{m[0].x * v.x + m[0].y * v.y + m[0].z * v.z,
                             m[1].x * v.x + m[1].y * v.y + m[1].z * v.z,
                             m[2].x * v.x + m[2].y * v.y + m[2].z * v.z};
    };
    const auto scaled_by = [&](Vector3<Real> v) {
        return Vector3<Real>{scale_ * v.x, scale_ * v.y, scale_ * v.z};
    };
    box.center = scaled_by(box.center);
    box.half_extents = scaled_by(box.half_extents);
    if (is_moved_) {
        const Vector3<Real> c = turned(box.center);
        box.center = {c.x + offset_.x, c.y + offset_.y, c.z + offset_.z};
        for (Vector3<Real>& axis : box.axes) {
            axis = turned(axis);
        }
    }
    return box;
}

Obb PosedTree::box(const Node& node) const {
    return in_frame(Obb{node.center, axes_of(node.rotation), half_extents_of(node)});
}

BasicObb<Pack> PosedTree::boxes(const Node& first, const Node& second) const {
    const auto& p = first.rotation;
    const auto& q = second.rotation;
    return in_frame(BasicObb<Pack>{
        packed(first.center, second.center),
        axes_of_quaternion(Pack{p[0], q[0]}, Pack{p[1], q[1]}, Pack{p[2], q[2]}, Pack{p[3], q[3]}),
        packed(half_extents_of(first), half_extents_of(second))});
}

Triangle PosedTree::triangle_in_frame(const NodeRef& ref) const {
    Triangle t = tree_->triangle(ref.begin);
    for (Vec3& v : t) {
        v = vertex_scales_[1] * (vertex_scales_[0] * v);
        v = is_moved_ ? matrix_ * v + offset_ : v;
    }
    return t;
}

Triangle PosedTree::triangle(const NodeRef& ref) const {
    const Triangle t = tree_->triangle(ref.begin);
    return pose_.is_identity() ? t : posed(pose_, t);
}

std::uint32_t PosedTree::id(const NodeRef& ref) const { return tree_->triangle_ids[ref.begin]; }

StaticQuery::StaticQuery(const TreeView& a, const Pose& pose_a, const TreeView& b,
                         const Pose& pose_b, const StaticQueryOptions& options)
    : a_(a, pose_a), b_(b, pose_b), options_(options) {
    const QueryFrame frame = set_common_frame(a_, b_);
    bound_ = frame.bound;
    exponent_ = frame.exponent;
    Pair roots;
    reach(a_, a.root(), options.max_depth_a, roots.a);
    reach(b_, b.root(), options.max_depth_b, roots.b);
    if (!are_apart(roots.a, roots.b)) {
        stack_.push_back(roots);
    }
}

void StaticQuery::reach(const PosedTree& body, const NodeRef& ref, std::uint32_t max_depth,
                        Side& side) const {
    side.ref = ref;
    side.next = ref.begin;
    side.is_open = false;
    if (ref.is_triangle()) {
        side.triangle = body.triangle_in_frame(ref);
        return;
    }
    const Node& node = body.tree().node(ref);
    side.box = body.box(node);
    side.is_open = is_open(node, ref, max_depth);
}

bool StaticQuery::is_open(const Node& node, const NodeRef& ref, std::uint32_t max_depth) const {
    return ref.depth < max_depth && !(options_.boxes_for_leaves && TreeView::is_leaf(node));
}

Vec3 StaticQuery::middle(const Side& side) {
    const Triangle& t = side.triangle;
    return side.ref.is_triangle() ? (1.0 / 3.0) * (t[0] + t[1] + t[2]) : side.box.center;
}

bool StaticQuery::are_apart(const Side& a, const Side& b) {
    if (a.ref.is_triangle() && b.ref.is_triangle()) {
        return false; // the exact test decides
    }
    ++counts_.box_tests;
    if (a.ref.is_triangle()) {
        return are_separated(b.box, a.triangle, bound_);
    }
    return b.ref.is_triangle() ? are_separated(a.box, b.triangle, bound_)
                               : are_separated(a.box, b.box, bound_);
}

bool StaticQuery::advance(std::uint64_t max_pops) {
    for (; !stack_.empty() && max_pops > 0; --max_pops) {
        ++counts_.pops;
        visit();
    }
    if (stack_.empty() && !is_finished_) {
        finish();
    }
    return is_finished_;
}

// The larger box is opened. A node that cannot be opened leaves it to the other.
void StaticQuery::visit() {
    const Side &a = stack_.back().a, &b = stack_.back().b;
    if (!a.is_open && !b.is_open) {
        const Pair pair = stack_.back();
        stack_.pop_back();
        meet(pair);
    } else if (!b.is_open ||
               (a.is_open && norm_inf(a.box.half_extents) >= norm_inf(b.box.half_extents))) {
        open<true>();
    } else {
        open<false>();
    }
}

template <bool kOpensA>
void StaticQuery::push(const Side& child, const Side& other) {
    Pair& pair = stack_.emplace_back();
    (kOpensA ? pair.a : pair.b) = child;
    (kOpensA ? pair.b : pair.a) = other;
}

// Replaces the pair on top by those of its children that are not proven apart from the other side,
// the nearest on top.
template <bool kOpensA>
void StaticQuery::open() {
    const PosedTree& body = kOpensA ? a_ : b_;
    const NodeRef ref = kOpensA ? stack_.back().a.ref : stack_.back().b.ref;
    const Node& node = body.tree().node(ref);
    if (TreeView::is_leaf(node)) {
        open_leaf<kOpensA>();
        return;
    }
    const Side other = kOpensA ? stack_.back().b : stack_.back().a;
    stack_.pop_back();
    std::array<Side, 2> children;
    const auto apart = reach_children<kOpensA>(body.tree().children(ref, node), other, children);
    std::size_t last = 1;
    if (!apart[0] && !apart[1]) {
        const Vec3 m = middle(other);
        last = norm_1(middle(children[0]) - m) < norm_1(middle(children[1]) - m) ? 0 : 1;
    }
    for (const std::size_t k : {1 - last, last}) {
        if (!apart[k]) {
            push<kOpensA>(children[k], other);
        }
    }
}

// Pushes the leaf's next triangles and, while there are more, leaves the leaf below them: leaves
// may hold whole meshes, and neither the stack nor the time between two looks at the clock should.
template <bool kOpensA>
void StaticQuery::open_leaf() {
    constexpr std::uint32_t kTrianglesAPop = 64;
    const Side other = kOpensA ? stack_.back().b : stack_.back().a;
    Side& leaf = kOpensA ? stack_.back().a : stack_.back().b;
    const NodeRef ref = leaf.ref;
    const std::uint32_t begin = leaf.next;
    const std::uint32_t end = begin + std::min(kTrianglesAPop, ref.end - begin);
    leaf.next = end;
    if (end == ref.end) {
        stack_.pop_back();
    }
    Side child;
    for (std::uint32_t i = begin; i < end; ++i) {
        reach(kOpensA ? a_ : b_, TreeView::triangle_ref(ref, i), 0, child);
        if (!(kOpensA ? are_apart(child, other) : are_apart(other, child))) {
            push<kOpensA>(child, other);
        }
    }
}

// Two boxes against one are tested at once.
template <bool kOpensA>
std::array<bool, 2> StaticQuery::reach_children(const std::array<NodeRef, 2>& refs,
                                                const Side& other, std::array<Side, 2>& children) {
    const PosedTree& body = kOpensA ? a_ : b_;
    const std::uint32_t max_depth = kOpensA ? options_.max_depth_a : options_.max_depth_b;
    if (refs[0].is_triangle() || refs[1].is_triangle() || other.ref.is_triangle()) {
        std::array<bool, 2> apart;
        for (std::size_t k = 0; k < 2; ++k) {
            reach(body, refs[k], max_depth, children[k]);
            apart[k] = kOpensA ? are_apart(children[k], other) : are_apart(other, children[k]);
        }
        return apart;
    }
    const std::array<const Node*, 2> nodes{&body.tree().node(refs[0]), &body.tree().node(refs[1])};
    const BasicObb<Pack> boxes = body.boxes(*nodes[0], *nodes[1]);
    const BasicObb<Pack> twice = broadcast(other.box);
    const PackMask mask =
        kOpensA ? are_separated(boxes, twice, bound_) : are_separated(twice, boxes, bound_);
    counts_.box_tests += 2;
    for (std::size_t k = 0; k < 2; ++k) {
        if (mask[k] == 0) {
            children[k].ref = refs[k];
            children[k].next = refs[k].begin;
            children[k].is_open = is_open(*nodes[k], refs[k], max_depth);
            children[k].box = lane(boxes, k);
        }
    }
    return {mask[0] != 0, mask[1] != 0};
}

void StaticQuery::meet(const Pair& pair) {
    if (!pair.a.ref.is_triangle() || !pair.b.ref.is_triangle()) {
        is_by_boxes_ = true;
        error_bound_ = distance_bound(pair);
        stack_.clear();
        return;
    }
    ++counts_.triangle_tests;
    const TriangleVerdict verdict =
        test_triangles(a_.triangle(pair.a.ref), b_.triangle(pair.b.ref));
    counts_.exact_triangle_tests += verdict.exact ? 1 : 0;
    if (!verdict.intersects) {
        return;
    }
    pairs_.push_back({a_.id(pair.a.ref), b_.id(pair.b.ref)});
    if (!options_.all_pairs || pairs_.size() >= options_.limit) {
        stack_.clear();
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
    const auto diagonal = [&](const Side& s) {
        return s.ref.is_triangle() ? 0.0 : 2.0 * length(s.box.half_extents);
    };
    const auto extent = [&](const Side& s) {
        const Triangle& t = s.triangle;
        return s.ref.is_triangle() ? length(t[1] - t[0]) + length(t[2] - t[0]) : diagonal(s);
    };
    const double size = 8.0 * (extent(pair.a) + extent(pair.b) + bound_.absolute);
    const double e = bound_.relative * size + bound_.absolute;
    const double slack = 4.0 * (std::sqrt(e) * std::sqrt(size) + e);
    const double bound = std::ldexp(diagonal(pair.a) + diagonal(pair.b) + slack, exponent_);
    // Upwards, for subnormal bounds are rounded by more than the slack.
    const double largest = std::numeric_limits<double>::max();
    return std::fmin(std::nextafter(bound, std::numeric_limits<double>::infinity()), largest);
}

std::vector<StaticQuery> StaticQuery::divide(std::size_t count) {
    std::vector<Pair> wide = std::move(stack_);
    while (!wide.empty() && wide.size() < count) {
        std::vector<Pair> next;
        for (const Pair& pair : wide) {
            stack_.assign(1, pair);
            ++counts_.pops;
            visit();
            next.insert(next.end(), stack_.begin(), stack_.end());
        }
        wide = std::move(next);
    }
    stack_.clear();
    StaticQuery empty = *this;
    empty.pairs_.clear();
    empty.counts_ = {};
    std::vector<StaticQuery> parts(wide.size(), empty);
    for (std::size_t k = 0; k < wide.size(); ++k) {
        parts[k].stack_.assign(1, wide[k]);
    }
    return parts;
}

void StaticQuery::join(std::span<const StaticQuery> parts) {
    for (const StaticQuery& part : parts) {
        pairs_.insert(pairs_.end(), part.pairs_.begin(), part.pairs_.end());
        counts_.box_tests += part.counts_.box_tests;
        counts_.triangle_tests += part.counts_.triangle_tests;
        counts_.exact_triangle_tests += part.counts_.exact_triangle_tests;
        counts_.pops += part.counts_.pops;
    }
    finish();
}

void StaticQuery::finish() {
    std::sort(pairs_.begin(), pairs_.end());
    is_finished_ = true;
}

} // namespace obb
