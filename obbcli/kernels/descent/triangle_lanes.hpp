// One triangle against four at a time: which of them are surely apart.
#pragma once

#include "primitives/predicates.hpp"
#include "shapes/pose.hpp"
#include "shapes/triangle.hpp"

#include <array>
#include <cstddef>

namespace obb {

// Four triangles: vertex by vertex, coordinate by coordinate.
using FourTriangles = std::array<std::array<std::array<double, 4>, 3>, 3>;

// Where the vertices of four triangles are.
using FourCorners = std::array<std::array<const Vec3*, 3>, 4>;

void gather_triangles(const FourCorners& corners, FourTriangles& triangles);

// The same, posed, with the bits of posed().
void pose_triangles(const Pose& pose, const FourCorners& corners, FourTriangles& triangles);

[[nodiscard]] inline Triangle lane(const FourTriangles& triangles, std::size_t k) {
    const auto vertex = [&](std::size_t i) {
        const auto& v = triangles[i];
        return Vec3{v[0][k], v[1][k], v[2][k]};
    };
    return {vertex(0), vertex(1), vertex(2)};
}

// For each vertex of a triangle whether it is surely above a plane, and below: a bit a lane.
struct FourSides {
    std::array<unsigned, 3> above, below;

    [[nodiscard]] PlaneSides lane(std::size_t k) const {
        PlaneSides sides;
        for (std::size_t i = 0; i < 3; ++i) {
            sides.above |= (above[i] >> k & 1U) << i;
            sides.below |= (below[i] >> k & 1U) << i;
        }
        return sides;
    }
};

// Of which triangles neither is surely on one side of the other's plane, a bit each: the others
// have no point in common with the one. For all finite doubles, as triangles_intersect(). Leaves
// the sides of the one's vertices and of the others'.
[[nodiscard]] unsigned crossing_planes(const Triangle& one, const FourTriangles& others,
                                       FourSides& sides_one, FourSides& sides_others);

} // namespace obb
