#include "at_rest/root_tests.hpp"

#include "numbers/registers.hpp"
#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace obb {

namespace {

// Squares of lengths between 2^-340 and 2^301 are normal numbers.
constexpr int kMostExponent = 300;
// Poses are orthonormal to 1e-9, and motions carry them no further than 3e-9.
constexpr double kMostSkew = 0x1p-20;
// Of the sizes; see compare_roots().
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
    const double extents = norm_1(box.half_extents);
    // With E the matrix of the axes, |E y|^2 = y . E^T E y <= (1 + 3 skew) |y|^2.
    box.radius = (1 + 2 * skew) * norm(box.half_extents);
    // std::max() may pass over a NaN among the axes, as a damaged tree can have: it spoils the sum.
    const double numbers = norm_1(center) + extents + norm_1(pose.translation) +
                           0.0 * (norm_1(box.axes[0]) + norm_1(box.axes[1]) + norm_1(box.axes[2]));
    if (skew <= kMostSkew && numbers <= power_of_two(kMostExponent)) {
        box.size = numbers;
        box.error = kMargin * numbers + 4 * skew * extents;
    }
    return box;
}

// What is to be apart are the rounded posed vertices. With S the sum of both sizes, u = 2^-53, and
// all axes at most 1 + 2^-20 long, the following may be lost, each along any axis in use:
//  - a vertex is posed with 4 roundings a coordinate, of sums of at most size + |half extents|:
//    less than 16 u S for both bodies together;
//  - the tree's proof takes a box for { |axes . (p - center)| <= half extents }, which differs from
//    { center + sum y axes } by what the axes, that differ from orthonormal by a few u, make of the
//    extents: less than 64 u S;
//  - center and axes are placed with 4 roundings a coordinate: 8 u S for the centers, and 16 u of
//    the extents for the axes;
//  - products with an axis and sums of the terms of the radii: 32 u S, and twice that on an axis of
//    two edges, which is made of such products;
//  - in the test of spheres, two squares and their comparison: 8 u of lengths that are at most
//    2 S, for the sphere's radius is at most the sum of the half extents.
// Altogether that is less than 2^8 u S. The margin, 2^13 u S, is 32 times as wide.
//
// Axes are orthonormal but for the skew e: |A_i . A_k| differs from 0 or 1 by e at most. Any vector
// would do for an axis, so what counts is the reach of the boxes along the vector that is taken:
//  - along A_i a box of extents h reaches h_i + e |h|, with |h| the sum of the extents;
//  - along L = c_1j A_2 - c_2j A_1, where c_ij = A_i . B_j and 1 and 2 follow i, A reaches
//    |c_1j| h_2 + |c_2j| h_1 and up to 2.1 e |h| more, for |c| < 1.01; B reaches
//    sum_k |c_1j c_2k - c_2j c_1k| h_k, whatever its axes are, and d, with t_i = A_i . d,
//    c_1j t_2 - c_2j t_1. But for the skew, L is the product of the edges A_i and B_j.
// So 4 e |h| is added for each body.
//
// Underflow loses less than 100 times 2^-1074, times the 2^300 that scales may undo, and S is at
// least 2^-300: far below the margin. Comparisons are such that a NaN separates nothing.
RootVerdict compare_roots(const RootBox& a, const RootBox& b) {
    const double sizes = a.size + b.size;
    if (!(sizes >= power_of_two(-kMostExponent) && sizes <= power_of_two(kMostExponent))) {
        return RootVerdict::kUnknown;
    }
    const double margin = a.error + b.error;
    const Vec3 d = b.center - a.center;
    const double reach = a.radius + b.radius + margin;
    if (dot(d, d) > reach * reach) {
        return RootVerdict::kApart;
    }
    const Vec3 ha = a.half_extents, hb = b.half_extents;
    std::array<Vec3, 3> c, r; // c[i][j] = A_i . B_j, and its magnitude
    Vec3 t;                   // t[i] = A_i . d
    bool is_apart = false;
    unrolled<3>([&](auto i) {
        const Vec3& axis = a.axes[i];
        c[i] = {dot(axis, b.axes[0]), dot(axis, b.axes[1]), dot(axis, b.axes[2])};
        r[i] = {std::fabs(c[i].x), std::fabs(c[i].y), std::fabs(c[i].z)};
        t[i] = dot(axis, d);
        is_apart |= std::fabs(t[i]) > ha[i] + dot(hb, r[i]) + margin;
    });
    // A box at a time, as which of its axes separates is as good as random.
    if (is_apart) {
        return RootVerdict::kApart;
    }
    unrolled<3>([&](auto j) {
        const double of_a = dot(ha, Vec3{r[0][j], r[1][j], r[2][j]});
        is_apart |= std::fabs(dot(b.axes[j], d)) > of_a + hb[j] + margin;
    });
    if (is_apart) {
        return RootVerdict::kApart;
    }
    unrolled<3>([&](auto i) {
        constexpr std::size_t kOne = (i + 1) % 3, kTwo = (i + 2) % 3;
        const Vec3 minors = cross(c[kOne], c[kTwo]);
        const Vec3 m{std::fabs(minors.x), std::fabs(minors.y), std::fabs(minors.z)};
        unrolled<3>([&](auto j) {
            constexpr std::size_t kNext = (j + 1) % 3, kLast = (j + 2) % 3;
            const double distance = std::fabs(t[kTwo] * c[kOne][j] - t[kOne] * c[kTwo][j]);
            const double of_a = ha[kOne] * r[kTwo][j] + ha[kTwo] * r[kOne][j];
            const double of_b = hb[kNext] * m[kLast] + hb[kLast] * m[kNext];
            is_apart |= distance > of_a + of_b + margin;
        });
    });
    return is_apart ? RootVerdict::kApart : RootVerdict::kMayMeet;
}

} // namespace obb
