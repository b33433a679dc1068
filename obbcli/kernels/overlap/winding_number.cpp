#include "overlap/winding_number.hpp"

#include "at_rest/ray_crossing.hpp"
#include "primitives/predicates.hpp"
#include "shapes/extremes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace obb {

namespace {

using PlacedBox = SolidSurface::PlacedBox;

// A ray along an axis of the world, one way or the other.
struct Ray {
    std::size_t axis = 2;
    bool is_down = false;

    // Whether it may meet, from a point on, what the box holds. A NaN does.
    [[nodiscard]] bool may_meet(const PlacedBox& placed, const Vec3& point) const {
        const Vec3 d = point - placed.box.center;
        const double along = is_down ? -d[axis] : d[axis];
        const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
        return !(std::fabs(d[i]) > placed.reach[i] || std::fabs(d[j]) > placed.reach[j] ||
                 along > placed.reach[axis]);
    }
    // With the axis for the last coordinate.
    [[nodiscard]] Vec3 turned(const Vec3& v) const {
        return {v[(axis + 1) % 3], v[(axis + 2) % 3], v[axis]};
    }
    [[nodiscard]] Triangle turned(const Triangle& t) const {
        return {turned(t[0]), turned(t[1]), turned(t[2])};
    }
};

// The ray that leaves the box around all soonest comes by the fewest boxes.
[[nodiscard]] Ray shortest_ray(const PlacedBox& root, const Vec3& point) {
    Ray best;
    double least = HUGE_VAL;
    const Vec3 d = point - root.box.center;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool is_down : {false, true}) {
            const double way = root.reach[axis] + (is_down ? d[axis] : -d[axis]);
            if (way < least) {
                least = way;
                best = {axis, is_down};
            }
        }
    }
    return best;
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
    if (tree.root().is_triangle()) {
        winding.is_on_surface = is_on(surface_->world_triangle(tree.root()), world);
        return winding;
    }
    const Ray ray = shortest_ray(surface_->placed(tree.root()), place);
    const Vec3 from = ray.turned(world);
    const auto count = [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t k = begin; k < end; ++k) {
            const Triangle t = surface_->world_triangle({k, k + 1, 0, 0});
            winding.number += ray_crossing(ray.turned(t), from, ray.is_down).turn;
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
        if (!ray.may_meet(surface_->placed(ref), place)) {
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
