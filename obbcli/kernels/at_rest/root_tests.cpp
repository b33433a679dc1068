#include "at_rest/root_tests.hpp"

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace obb {

namespace {

// Squares of lengths between 2^-340 and 2^301 are normal numbers.
constexpr int kMostExponent = 300;
// Poses are orthonormal to 1e-9, and motions carry them no further than 3e-9.
constexpr double kMostSkew = 0x1p-20;
// Of the sizes; see are_apart().
constexpr double kMargin = 0x1p-40;

} // namespace

RootBox root_box(const TreeView& tree, const Pose& pose) {
    RootBox box;
    if (tree.root().is_triangle() || tree.nodes.empty() ||
        std::abs(tree.scale_exponent) > kMostExponent) {
        return box;
    }
    const Node& root = tree.nodes.front();
    const double unit = power_of_two(tree.scale_exponent);
    const Vec3 center = unit * root.center;
    const std::array<Vec3, 3> axes = axes_of(root.rotation);
    box.half_extents = unit * half_extents_of(root);
    box.center = pose.rotation * center + pose.translation;
    double skew = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        box.axes[i] = pose.rotation * axes[i];
        for (std::size_t j = 0; j <= i; ++j) {
            skew = std::max(skew, std::fabs(dot(box.axes[i], box.axes[j]) - (i == j ? 1.0 : 0.0)));
        }
    }
    // With E the matrix of the axes, |E y|^2 = y . E^T E y <= (1 + 3 skew) |y|^2.
    box.radius = (1 + 2 * skew) * norm(box.half_extents);
    // std::max() may pass over a NaN among the axes, as a damaged tree can have: it spoils the sum.
    const double numbers = norm_1(center) + norm_1(box.half_extents) + norm_1(pose.translation) +
                           0.0 * (norm_1(box.axes[0]) + norm_1(box.axes[1]) + norm_1(box.axes[2]));
    if (skew <= kMostSkew && numbers <= power_of_two(kMostExponent)) {
        box.size = numbers;
    }
    return box;
}

// What is to be apart are the rounded posed vertices. With S the sum of both sizes, u = 2^-53, and
// all axes at most 1 + 2^-20 long, the following may be lost, each along any axis in use:
//  - a vertex is posed with 4 roundings a coordinate, of sums of at most size + |half extents|:
//  less
//    than 16 u S for both bodies together;
//  - the tree's proof takes a box for { |axes . (p - center)| <= half extents }, which differs from
//    { center + sum y axes } by what the axes, that differ from orthonormal by a few u, make of the
//    extents: less than 64 u S;
//  - center and axes are placed with 4 roundings a coordinate: 8 u S for the centers, and 16 u of
//    the extents for the axes;
//  - products with an axis and sums of the six terms of the radii: 32 u S;
//  - in the test of spheres, two squares and their comparison: 8 u of lengths that are at most
//    2 S, for the sphere's radius is at most the sum of the half extents.
// Altogether that is less than 2^8 u S. The margin, 2^13 u S, is 32 times as wide.
// Underflow loses less than 100 times 2^-1074, times the 2^300 that scales may undo, and S is at
// least 2^-300: far below the margin. Comparisons are such that a NaN separates nothing.
bool are_apart(const RootBox& a, const RootBox& b) {
    const double sizes = a.size + b.size;
    if (!(sizes >= power_of_two(-kMostExponent) && sizes <= power_of_two(kMostExponent))) {
        return false;
    }
    const double margin = kMargin * sizes;
    const Vec3 d = b.center - a.center;
    const double reach = a.radius + b.radius + margin;
    if (dot(d, d) > reach * reach) {
        return true;
    }
    // Any vector would do for an axis: nothing here needs axes to be orthonormal.
    const auto radius = [](const RootBox& box, Vec3 axis) {
        return box.half_extents.x * std::fabs(dot(axis, box.axes[0])) +
               box.half_extents.y * std::fabs(dot(axis, box.axes[1])) +
               box.half_extents.z * std::fabs(dot(axis, box.axes[2]));
    };
    for (const RootBox* box : {&a, &b}) {
        // A box at a time, as which of its axes separates is as good as random.
        bool is_apart = false;
        for (const Vec3& axis : box->axes) {
            is_apart |= std::fabs(dot(axis, d)) > radius(a, axis) + radius(b, axis) + margin;
        }
        if (is_apart) {
            return true;
        }
    }
    return false;
}

} // namespace obb
