#include "overlap/triangles_in_box.hpp"

#include "descent/box_tests.hpp"

#include <algorithm>

namespace obb {

namespace {

[[nodiscard]] double skew_of(const Obb& box) {
    return skew_of(Mat3{{Vec3{box.axes[0].x, box.axes[1].x, box.axes[2].x},
                         Vec3{box.axes[0].y, box.axes[1].y, box.axes[2].y},
                         Vec3{box.axes[0].z, box.axes[1].z, box.axes[2].z}}});
}

[[nodiscard]] Obb grown(Obb box, double pad) {
    box.half_extents = box.half_extents + Vec3{pad, pad, pad};
    return box;
}

// Of two boxes whose axes are products of s off orthonormal, a projection's radius is off by s of
// the half extents, and what is expressed in one box's axes by 3 s of its length. Triangles are
// within kPlaceError, which rounding's share covers.
[[nodiscard]] RoundingBound bound_of(double skew, double absolute) {
    return {64 * kUnitRoundoff + 8 * skew, absolute + 0x1p-900};
}

} // namespace

bool may_meet(const Obb& box, const Triangle& triangle, double pad) {
    return !are_separated(grown(box, pad), triangle, bound_of(skew_of(box), 2 * kPlaceError));
}

bool BoxSearch::find(const Obb& box, double pad, std::size_t most, std::vector<NodeRef>& found) {
    const TreeView& tree = surface_->tree();
    const double skew = skew_of(box);
    const Obb large = grown(box, pad);
    const RoundingBound for_boxes = bound_of(skew + surface_->skew(), surface_->blur());
    const RoundingBound for_triangles = bound_of(skew, 2 * kPlaceError);
    std::size_t count = 0;
    const auto look_at = [&](const NodeRef& ref) {
        if (!are_separated(large, surface_->triangle(ref), for_triangles)) {
            ++count;
            if (count <= most) {
                found.push_back(ref);
            }
        }
    };
    stack_.assign(1, tree.root());
    while (!stack_.empty() && count <= most) {
        const NodeRef ref = stack_.back();
        stack_.pop_back();
        if (ref.is_triangle()) {
            look_at(ref);
            continue;
        }
        const Node& node = tree.node(ref);
        if (are_separated(large, surface_->box(ref), for_boxes)) {
            continue;
        }
        tree.prepare(ref);
        if (!TreeView::is_leaf(node)) {
            const auto children = tree.children(ref, node);
            stack_.insert(stack_.end(), {children[1], children[0]});
            continue;
        }
        for (std::uint32_t k = ref.begin; k < ref.end && count <= most; ++k) {
            look_at(TreeView::triangle_ref(ref, k));
        }
    }
    return count <= most;
}

bool BoxSearch::is_met(const Obb& box, double pad) {
    one_.clear();
    return !find(box, pad, 0, one_);
}

} // namespace obb
