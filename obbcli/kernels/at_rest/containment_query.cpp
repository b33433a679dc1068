#include "at_rest/containment_query.hpp"

#include "exact/orientation.hpp"
#include "numbers/scale.hpp"
#include "shapes/extremes.hpp"
#include "work/slice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace obb {

namespace {

// The side of the edge from a to b that p is on, seen from above, with p moved by (e, e^2, 0) for
// an infinitely small e: then a ray meets no edge, and edges that two triangles share are passed on
// one side of both (Edelsbrunner and Muecke 1990, Simulation of simplicity). 0 only for edges that
// are parallel to the ray: their triangles it does not meet.
[[nodiscard]] Orientation moved_side(const Vec3& a, const Vec3& b, const Vec3& p) {
    const Orientation found = orientation_xy(a, b, p);
    if (found.sign != 0) {
        return found;
    }
    const int by_x = (b.y < a.y) - (b.y > a.y);
    return {by_x != 0 ? by_x : (b.x > a.x) - (b.x < a.x), found.exact};
}

} // namespace

ContainmentQuery::ContainmentQuery(const TreeView& tree, const Pose& pose, std::vector<Vec3> points)
    : body_(tree, pose), points_(std::move(points)) {
    // A translation of zero has no length to count.
    const double shift = norm_inf(pose.translation);
    exponent_ = shift > 0 ? std::max(tree.scale_exponent, exponent_of(shift)) : tree.scale_exponent;
    body_.set_frame(pose.rotation, scaled(pose.translation, -exponent_), exponent_);
    begin_point();
}

void ContainmentQuery::begin_point() {
    if (point_ < points_.size()) {
        scaled_point_ = scaled(points_[point_], -exponent_);
        winding_ = 0;
        stack_.push_back(body_.tree().root());
    }
}

bool ContainmentQuery::advance(std::uint64_t max_pops) {
    SliceClock clock;
    for (; !stack_.empty() && max_pops > 0 && !clock.is_over(); --max_pops) {
        ++counts_.pops;
        visit();
        if (!stack_.empty()) {
            continue;
        }
        if (winding_ != 0) {
            inside_ = point_;
            return true;
        }
        ++point_;
        begin_point();
    }
    return stack_.empty();
}

void ContainmentQuery::visit() {
    constexpr std::uint32_t kTrianglesAPop = 64;
    const NodeRef ref = stack_.back();
    stack_.pop_back();
    if (ref.is_triangle()) {
        count(body_.triangle(ref));
        return;
    }
    const Node& node = body_.tree().node(ref);
    ++counts_.box_tests;
    if (!may_meet(node)) {
        return;
    }
    body_.tree().prepare(ref);
    if (!TreeView::is_leaf(node)) {
        const auto children = body_.tree().children(ref, node);
        stack_.insert(stack_.end(), {children[1], children[0]});
        return;
    }
    // Leaves may hold whole meshes: what is left of one stays on the stack, its box to be met anew.
    NodeRef rest = ref;
    rest.begin += std::min(kTrianglesAPop, ref.triangle_count() - 1);
    for (std::uint32_t i = ref.begin; i < rest.begin; ++i) {
        count(body_.triangle(TreeView::triangle_ref(ref, i)));
    }
    stack_.push_back(rest);
}

// Whether the ray may meet a triangle of the node. No coordinate or translation exceeds 1 here:
// 2^-46 is 128 units of roundoff, and 8 covers the box's own defect of a few ulps, the posing of
// its centre and axes, and the rounding of the posed vertices. What is 2^-900 of the scene
// vanishes.
bool ContainmentQuery::may_meet(const Node& node) const {
    constexpr double kMargin = 0x1p-46 * 8.0 + 0x1p-900;
    const Obb box = body_.box(node);
    const auto reach_along = [&](std::size_t k) {
        double sum = kMargin;
        for (std::size_t i = 0; i < 3; ++i) {
            sum += box.half_extents[i] * std::fabs(box.axes[i][k]);
        }
        return sum;
    };
    const Vec3 from_center = scaled_point_ - box.center;
    return std::fabs(from_center.x) <= reach_along(0) &&
           std::fabs(from_center.y) <= reach_along(1) && from_center.z <= reach_along(2);
}

void ContainmentQuery::count(const Triangle& t) {
    const Vec3& p = points_[point_];
    if (p.x < smallest(t[0].x, t[1].x, t[2].x) || p.x > largest(t[0].x, t[1].x, t[2].x) ||
        p.y < smallest(t[0].y, t[1].y, t[2].y) || p.y > largest(t[0].y, t[1].y, t[2].y) ||
        p.z > largest(t[0].z, t[1].z, t[2].z)) {
        return;
    }
    ++counts_.triangle_tests;
    int turn = 0; // anticlockwise, seen from above
    bool is_exact = false;
    bool is_met = true;
    for (std::size_t k = 0; k < 3 && is_met; ++k) {
        const Orientation side = moved_side(t[k], t[(k + 1) % 3], p);
        is_exact = is_exact || side.exact;
        is_met = side.sign != 0 && (k == 0 || side.sign == turn);
        turn = side.sign;
    }
    if (is_met) {
        // The line meets the triangle, whose plane is not parallel to it, at p moved as at p: and
        // p, which is not on the triangle, is above or below by more than it was moved.
        const Orientation height = orientation(t[0], t[1], t[2], p);
        is_exact = is_exact || height.exact;
        winding_ += height.sign == -turn ? turn : 0;
    }
    counts_.exact_triangle_tests += is_exact ? 1 : 0;
}

} // namespace obb
