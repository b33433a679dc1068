#include "in_motion/moving_tree.hpp"

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

// Middle of the root, posed, and a radius about it that holds the body; mesh units.
struct Ball {
    Vec3 center;
    double radius;
};

Ball ball_around(const TreeView& tree, const Pose& pose) {
    if (tree.triangle_count() == 1) {
        const Triangle t = posed(pose, tree.triangle(0));
        const Vec3 c = (1.0 / 3.0) * t[0] + (1.0 / 3.0) * t[1] + (1.0 / 3.0) * t[2];
        return {c, std::max({norm_1(t[0] - c), norm_1(t[1] - c), norm_1(t[2] - c)})};
    }
    const Node& root = tree.node(tree.root());
    const Vec3 h = half_extents_of(root);
    return {posed(pose, scaled(root.center, tree.scale_exponent)),
            std::ldexp(h.x + h.y + h.z, tree.scale_exponent)};
}

} // namespace

MovingTree::MovingTree(const TreeView& tree, const Pose& pose, const Screw& screw)
    : tree_(&tree), pose_(pose), screw_(screw), spin_(screw.angular_velocity) {
    // Axes that the matrix turns have a defect of their own, which is rounding.
    skew_ = 3 * skew_of(pose.rotation) + 0x1p-45;
    const Ball ball = ball_around(tree, pose);
    if (spin_.is_still()) {
        screw_.pivot = ball.center;
    }
    extent_ = ball.radius;
    farthest_ = norm_1(ball.center - screw_.pivot) + ball.radius;
}

void MovingTree::set_units(int length_exponent, int time_exponent) {
    length_exponent_ = length_exponent;
    spin_ = Spin(scaled(screw_.angular_velocity, time_exponent));
    node_scale_ = std::ldexp(1.0, tree_->scale_exponent - length_exponent);
    pivot_ = scaled(screw_.pivot, -length_exponent);
    const Vec3 translation = scaled(pose_.translation, -length_exponent);
    offset_ = translation - pivot_;
    box_error_ = 32 * kUnitRoundoff * (4 * node_scale_ + norm_1(translation) + norm_1(pivot_));
}

Obb MovingTree::box(const NodeRef& ref) const {
    if (ref.is_triangle()) {
        return box_around(triangle(ref));
    }
    const Node& node = tree_->node(ref);
    const Mat3 spun = spin_.matrix(turn_), matrix = spun * pose_.rotation;
    Obb box{matrix * (node_scale_ * node.center) + spun * offset_, axes_of(node.rotation),
            node_scale_ * half_extents_of(node)};
    for (Vec3& axis : box.axes) {
        axis = matrix * axis;
    }
    return box;
}

Triangle MovingTree::posed_triangle(const NodeRef& ref) const {
    const Triangle t = tree_->triangle(ref);
    return pose_.is_identity() ? t : posed(pose_, t);
}

Triangle MovingTree::triangle(const NodeRef& ref) const {
    const Mat3 spun = spin_.matrix(turn_);
    Triangle t = posed_triangle(ref);
    for (Vec3& v : t) {
        v = spun * about_pivot(v);
    }
    return t;
}

// Along the longest edge and across it in the plane; orthonormal to rounding whatever the shape.
Obb box_around(const Triangle& t) {
    const std::array<Vec3, 3> edges{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    const auto longest = std::max_element(edges.begin(), edges.end(),
                                          [](Vec3 u, Vec3 v) { return norm_1(u) < norm_1(v); }) -
                         edges.begin();
    Obb box{t[0], {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}};
    const Vec3 e = edges[static_cast<std::size_t>(longest)];
    const double length = norm(e);
    if (length > 0x1p-400) { // shorter ones are points to any bound used here
        const Vec3 u = (1.0 / length) * e;
        const Vec3 f = edges[static_cast<std::size_t>((longest + 1) % 3)];
        Vec3 v = f - dot(f, u) * u;
        if (!(norm(v) > 0x1p-20 * norm(f))) { // a needle: any direction across does
            const std::size_t k = std::fabs(u.x) < 0.6 ? 0 : std::fabs(u.y) < 0.6 ? 1 : 2;
            Vec3 axis{0, 0, 0};
            axis[k] = 1;
            v = axis - dot(axis, u) * u;
        }
        v = (1.0 / norm(v)) * v;
        v = v - dot(v, u) * u;
        v = (1.0 / norm(v)) * v;
        box.axes = {u, v, cross(u, v)};
    }
    double total = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        double low = 0, high = 0;
        for (const Vec3& p : t) {
            const double y = dot(box.axes[k], p - t[0]);
            low = std::min(low, y);
            high = std::max(high, y);
        }
        box.half_extents[k] = 0.5 * (high - low);
        total += box.half_extents[k];
        box.center = box.center + (0.5 * (low + high)) * box.axes[k];
    }
    const double margin = 0x1p-45 * total + 0x1p-48 * norm_1(box.center) + 0x1p-390;
    box.half_extents = box.half_extents + Vec3{margin, margin, margin};
    return box;
}

} // namespace obb
