// What the passes over small and over large ranges share while a tree is built.
#pragma once

#include "fit/fit.hpp"
#include "numbers/scale.hpp"
#include "tree/tree.hpp"
#include "tree/zeroed_array.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace obb {

enum class Split { kMedian, kCenter, kCompact };

struct BuildOptions {
    Fit fit = Fit::kTriangles;
    Split split = Split::kCompact;
    // A range of at most this many triangles is a leaf.
    std::uint32_t leaf_size = 1;
    // A node this deep is a leaf, whatever it holds; the root's depth is 0.
    std::uint32_t max_depth = std::numeric_limits<std::uint32_t>::max();

    [[nodiscard]] bool is_leaf(const NodeRef& ref) const {
        return ref.triangle_count() <= leaf_size || ref.depth >= max_depth;
    }
};

// The mesh in the tree's unit: see scaled().
struct UnitMesh {
    std::span<const Vec3> vertices;
    std::span<const Corners> corners;
    int scale_exponent;
    std::array<double, 2> factors;

    UnitMesh(std::span<const Vec3> all_vertices, std::span<const Corners> all_corners, int exponent)
        : vertices(all_vertices), corners(all_corners), scale_exponent(exponent),
          factors{std::ldexp(1.0, -exponent / 2), std::ldexp(1.0, -exponent - -exponent / 2)} {}

    [[nodiscard]] Vec3 vertex(std::uint32_t index) const {
        return factors[1] * (factors[0] * vertices[index]);
    }
    [[nodiscard]] Triangle triangle(std::uint32_t id) const {
        const Corners& c = corners[id];
        return {vertex(c[0]), vertex(c[1]), vertex(c[2])};
    }
};

// The tree's own arrays. A triangle's place is settled once no split can move it any more; until
// then `ids` holds those of its range in any order, ascending.
struct TreeSlots {
    ZeroedArray<Node> nodes;
    ZeroedArray<Corners> corners;
    ZeroedArray<std::uint32_t> ids;

    void settle(const UnitMesh& mesh, std::uint32_t position, std::uint32_t id) {
        ids[position] = id;
        corners[position] = mesh.corners[id];
    }
};

// The children of a node that is parted at `split`.
[[nodiscard]] inline std::array<NodeRef, 2> parted(const NodeRef& ref, std::uint32_t split) {
    return {{{ref.begin, split, ref.slot + 1, ref.depth + 1},
             {split, ref.end, ref.slot + (split - ref.begin), ref.depth + 1}}};
}

// Indices of the axes, longest first; equal lengths keep their order.
[[nodiscard]] inline std::array<std::size_t, 3> longest_first(Vec3 h) {
    std::array<std::size_t, 3> order{0, 1, 2};
    const auto swap_if_longer = [&](std::size_t i, std::size_t k) {
        if (h[order[k]] > h[order[i]]) {
            std::swap(order[i], order[k]);
        }
    };
    swap_if_longer(0, 1);
    swap_if_longer(1, 2);
    swap_if_longer(0, 1);
    return order;
}

[[nodiscard]] inline float rounded_up(double value) {
    const auto nearest = static_cast<float>(value);
    if (static_cast<double>(nearest) >= value) {
        return nearest;
    }
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(nearest) + 1); // of what is positive
}

// What rounding may take from half extents: the projections and the axes' defect of a few ulps,
// relative to the box's own size; the centre's last places; products of the tiniest coordinates.
[[nodiscard]] inline double rounding_margin(double total_extent, Vec3 center) {
    constexpr double kRelativeMargin = 0x1p-45;
    constexpr double kCenterMargin = 0x1p-50;
    constexpr double kUnderflowMargin = 0x1p-900;
    return kRelativeMargin * total_extent + kCenterMargin * norm_1(center) + kUnderflowMargin;
}

} // namespace obb
