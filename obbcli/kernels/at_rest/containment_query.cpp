#include "at_rest/containment_query.hpp"

#include "at_rest/ray_crossing.hpp"
#include "numbers/scale.hpp"
#include "work/slice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace obb {

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

void ContainmentQuery::count(const Triangle& triangle) {
    const RayCrossing crossing = ray_crossing(triangle, points_[point_]);
    winding_ += crossing.turn;
    counts_.triangle_tests += crossing.is_tested ? 1 : 0;
    counts_.exact_triangle_tests += crossing.is_exact ? 1 : 0;
}

} // namespace obb
