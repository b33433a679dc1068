#include "overlap/winding_number.hpp"

#include "at_rest/ray_crossing.hpp"
#include "primitives/predicates.hpp"
#include "shapes/extremes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace obb {

namespace {

// Whether the ray from the point towards +z may meet what the box holds. A NaN does.
[[nodiscard]] bool may_be_met(const Obb& box, const Vec3& point, double blur) {
    const Vec3 d = point - box.center;
    Vec3 reach{blur, blur, blur};
    for (std::size_t i = 0; i < 3; ++i) {
        reach = reach + box.half_extents[i] * abs(box.axes[i]);
    }
    return !(std::fabs(d.x) > reach.x || std::fabs(d.y) > reach.y || d.z > reach.z);
}

[[nodiscard]] bool is_on(const Triangle& t, const Vec3& p) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (p[k] < smallest(t[0][k], t[1][k], t[2][k]) ||
            p[k] > largest(t[0][k], t[1][k], t[2][k])) {
            return false;
        }
    }
    return triangles_intersect(t, {p, p, p});
}

} // namespace

Winding WindingSearch::find(const Vec3& world) {
    ++rays_;
    Winding winding;
    const TreeView& tree = surface_->tree();
    const Vec3 place = surface_->frame().to_frame(world);
    const auto count = [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t k = begin; k < end; ++k) {
            const Triangle t = surface_->world_triangle({k, k + 1, 0, 0});
            winding.number += ray_crossing(t, world).turn;
            winding.is_on_surface = winding.is_on_surface || is_on(t, world);
        }
    };
    stack_.assign(1, tree.root());
    while (!stack_.empty()) {
        const NodeRef ref = stack_.back();
        stack_.pop_back();
        if (ref.is_triangle()) {
            count(ref.begin, ref.end);
            continue;
        }
        const Node& node = tree.node(ref);
        if (!may_be_met(surface_->box(ref), place, surface_->blur())) {
            continue;
        }
        tree.prepare(ref);
        if (TreeView::is_leaf(node)) {
            count(ref.begin, ref.end);
        } else {
            const auto children = tree.children(ref, node);
            stack_.insert(stack_.end(), {children[1], children[0]});
        }
    }
    return winding;
}

} // namespace obb
