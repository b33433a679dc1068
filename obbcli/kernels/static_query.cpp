#include "static_query.hpp"

#include "predicates.hpp"
#include "scale.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace obb {

namespace {

// Inverse of a matrix that is orthonormal up to 1e-9, by its adjugate.
Mat3 inverse(const Mat3& m) {
    const Vec3 c0 = cross(m.rows[1], m.rows[2]);
    const Vec3 c1 = cross(m.rows[2], m.rows[0]);
    const Vec3 c2 = cross(m.rows[0], m.rows[1]);
    const double scale = 1.0 / dot(m.rows[0], c0);
    return {{scale * Vec3{c0.x, c1.x, c2.x}, scale * Vec3{c0.y, c1.y, c2.y},
             scale * Vec3{c0.z, c1.z, c2.z}}};
}

Mat3 product(const Mat3& a, const Mat3& b) {
    Mat3 result;
    for (std::size_t i = 0; i < 3; ++i) {
        result.rows[i] = {dot(a.rows[i], b.column(0)), dot(a.rows[i], b.column(1)),
                          dot(a.rows[i], b.column(2))};
    }
    return result;
}

// Largest entry of |M^T M - 1|.
double skew_of(const Mat3& m) {
    double skew = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            skew = std::fmax(skew, std::fabs(dot(m.column(i), m.column(j)) - (i == j ? 1.0 : 0.0)));
        }
    }
    return skew;
}

double longest(Vec3 half_extents) { return norm_inf(half_extents); }

Vec3 middle(const Triangle& t) { return (1.0 / 3.0) * (t[0] + t[1] + t[2]); }

// Coordinates of a posed mesh stay below three times its largest coordinate plus the translation.
void require_range(const PosedTree& body) {
    if (body.pose().is_identity()) {
        return;
    }
    const double largest = norm_inf(body.pose().translation);
    if (std::max(body.tree().scale_exponent, exponent_of(largest)) > 1020) {
        throw std::domain_error("posed coordinates would exceed the range of double (about 1e307)");
    }
}

} // namespace

void PosedTree::set_frame(const Mat3& matrix, Vec3 offset, int exponent) {
    matrix_ = matrix;
    offset_ = offset;
    is_moved_ = !(matrix == Mat3::identity() && offset == Vec3{0, 0, 0});
    exponent_ = exponent;
    scale_ = std::ldexp(1.0, tree_->scale_exponent - exponent);
}

Obb PosedTree::box(const NodeRef& ref) const {
    const Node& node = tree_->node(ref);
    Obb box{scale_ * node.center, axes_of(node.rotation), scale_ * half_extents_of(node)};
    if (is_moved_) {
        box.center = matrix_ * box.center + offset_;
        for (Vec3& axis : box.axes) {
            axis = matrix_ * axis;
        }
    }
    return box;
}

Triangle PosedTree::triangle_in_frame(const NodeRef& ref) const {
    Triangle t = tree_->triangle(ref.begin);
    for (Vec3& v : t) {
        v = scaled(v, -exponent_);
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
    require_range(a_);
    require_range(b_);
    set_frames();
    const Pair roots{a.root(), b.root()};
    if (!are_apart(shape_of(a_, roots.a), shape_of(b_, roots.b))) {
        stack_.push_back(roots);
    }
}

// Boxes are tested in A's own frame, scaled by one power of two so that nothing overflows and only
// what is 2^-900 of the scene can underflow. Overlap survives any affine map, so poses need not be
// exactly orthonormal: what they lack goes into the bound.
void StaticQuery::set_frames() {
    const Pose& pa = a_.pose();
    const Pose& pb = b_.pose();
    exponent_ =
        std::max({a_.tree().scale_exponent, b_.tree().scale_exponent,
                  exponent_of(norm_inf(pa.translation)), exponent_of(norm_inf(pb.translation))});
    const double tiny = 0x1p-900;
    if (pa == pb) {
        // A common pose moves no box against the other. It still rounds the triangles.
        a_.set_frame(Mat3::identity(), {0, 0, 0}, exponent_);
        b_.set_frame(Mat3::identity(), {0, 0, 0}, exponent_);
        const double rounding = pa.is_identity() ? 0.0 : 0x1p-46 * 8.0;
        bound_ = {64 * kUnitRoundoff, rounding + tiny};
        return;
    }
    const Mat3 to_a = inverse(pa.rotation);
    const Mat3 matrix = product(to_a, pb.rotation);
    const Vec3 offset =
        to_a * (scaled(pb.translation, -exponent_) - scaled(pa.translation, -exponent_));
    a_.set_frame(Mat3::identity(), {0, 0, 0}, exponent_);
    b_.set_frame(matrix, offset, exponent_);
    // No coordinate or translation exceeds 1 here: 2^-46 is 128 units of roundoff, 8 the sum over
    // both bodies of |vertex|_1 + |translation|.
    bound_ = {64 * kUnitRoundoff + 8 * skew_of(matrix), 0x1p-46 * 8.0 + tiny};
}

StaticQuery::Kind StaticQuery::kind_of(const PosedTree& body, const NodeRef& ref,
                                       std::uint32_t max_depth) const {
    if (ref.is_triangle()) {
        return Kind::kTriangle;
    }
    if (ref.depth >= max_depth) {
        return Kind::kBox;
    }
    const bool is_coarse = options_.boxes_for_leaves && TreeView::is_leaf(body.tree().node(ref));
    return is_coarse ? Kind::kBox : Kind::kOpen;
}

StaticQuery::Shape StaticQuery::shape_of(const PosedTree& body, const NodeRef& ref) {
    Shape shape;
    shape.is_triangle = ref.is_triangle();
    if (shape.is_triangle) {
        shape.triangle = body.triangle_in_frame(ref);
    } else {
        shape.box = body.box(ref);
    }
    return shape;
}

bool StaticQuery::are_apart(const Shape& a, const Shape& b) {
    if (a.is_triangle && b.is_triangle) {
        return false; // the exact test decides
    }
    ++counts_.box_tests;
    if (a.is_triangle) {
        return are_separated(b.box, a.triangle, bound_);
    }
    return b.is_triangle ? are_separated(a.box, b.triangle, bound_)
                         : are_separated(a.box, b.box, bound_);
}

bool StaticQuery::advance(std::uint64_t max_pops) {
    for (; !stack_.empty() && max_pops > 0; --max_pops) {
        const Pair pair = stack_.back();
        stack_.pop_back();
        ++counts_.pops;
        visit(pair);
    }
    if (stack_.empty() && !is_finished_) {
        finish();
    }
    return is_finished_;
}

// The larger box is opened. A node that cannot be opened leaves it to the other.
void StaticQuery::visit(const Pair& pair) {
    const Kind kind_a = kind_of(a_, pair.a, options_.max_depth_a);
    const Kind kind_b = kind_of(b_, pair.b, options_.max_depth_b);
    const Shape a = shape_of(a_, pair.a), b = shape_of(b_, pair.b);
    if (kind_a != Kind::kOpen && kind_b != Kind::kOpen) {
        meet(pair, a, b);
        return;
    }
    const bool opens_a =
        kind_b != Kind::kOpen ||
        (kind_a == Kind::kOpen && longest(a.box.half_extents) >= longest(b.box.half_extents));
    if (opens_a) {
        open<true>(pair, b);
    } else {
        open<false>(pair, a);
    }
}

// Pushes the children that are not proven apart from the other shape, the nearest last, so that it
// is visited first.
template <bool kOpensA>
void StaticQuery::open(const Pair& pair, const Shape& other) {
    const PosedTree& body = kOpensA ? a_ : b_;
    const NodeRef& ref = kOpensA ? pair.a : pair.b;
    const NodeRef& other_ref = kOpensA ? pair.b : pair.a;
    const auto push = [&](const NodeRef& child) {
        const Shape shape = shape_of(body, child);
        const bool apart = kOpensA ? are_apart(shape, other) : are_apart(other, shape);
        if (!apart) {
            stack_.push_back(kOpensA ? Pair{child, other_ref} : Pair{other_ref, child});
        }
        const Vec3 center = shape.is_triangle ? middle(shape.triangle) : shape.box.center;
        const Vec3 target = other.is_triangle ? middle(other.triangle) : other.box.center;
        return std::pair{!apart, norm_1(center - target)};
    };
    const Node& node = body.tree().node(ref);
    if (TreeView::is_leaf(node)) {
        for (std::uint32_t i = ref.begin; i < ref.end; ++i) {
            push(TreeView::triangle_ref(ref, i));
        }
        return;
    }
    const auto [left, right] = TreeView::children(ref, node);
    const auto [left_pushed, left_distance] = push(left);
    const auto [right_pushed, right_distance] = push(right);
    if (left_pushed && right_pushed && left_distance < right_distance) {
        std::swap(stack_[stack_.size() - 1], stack_[stack_.size() - 2]);
    }
}

// Each surface touches its box, so two boxes that meet hold surfaces no further apart than their
// diagonals. Shapes that every axis left undecided need not quite meet: a face axis is off by the
// bound e itself; an axis from nearly parallel edges, of length s, by e / s, but turning one shape
// until they are parallel moves nothing by more than s times its size, so the gap is below
// 4 sqrt(e size) whatever s is. With e = 2^-45 size + absolute that is the slack added here.
double StaticQuery::distance_bound(const Shape& a, const Shape& b) const {
    const auto diagonal = [](const Shape& s) {
        return s.is_triangle ? 0.0 : 2.0 * norm(s.box.half_extents);
    };
    const auto size = [&](const Shape& s) {
        const Triangle& t = s.triangle;
        return s.is_triangle ? norm(t[1] - t[0]) + norm(t[2] - t[0]) : diagonal(s);
    };
    const double both = size(a) + size(b);
    const double slack =
        0x1p-16 * both + 4.0 * std::sqrt(bound_.absolute * both) + 4.0 * bound_.absolute;
    const double bound = std::ldexp(diagonal(a) + diagonal(b) + slack, exponent_);
    return std::fmin(bound, std::numeric_limits<double>::max());
}

void StaticQuery::meet(const Pair& pair, const Shape& a, const Shape& b) {
    if (!a.is_triangle || !b.is_triangle) {
        is_by_boxes_ = true;
        error_bound_ = distance_bound(a, b);
        stack_.clear();
        return;
    }
    ++counts_.triangle_tests;
    const TriangleVerdict verdict = test_triangles(a_.triangle(pair.a), b_.triangle(pair.b));
    counts_.exact_triangle_tests += verdict.exact ? 1 : 0;
    if (!verdict.intersects) {
        return;
    }
    pairs_.push_back({a_.id(pair.a), b_.id(pair.b)});
    if (!options_.all_pairs || pairs_.size() >= options_.limit) {
        stack_.clear();
    }
}

void StaticQuery::finish() {
    std::sort(pairs_.begin(), pairs_.end());
    is_finished_ = true;
}

} // namespace obb
