// One triangle against four at a time: which of them are surely apart.
#pragma once

#include "primitives/predicates.hpp"
#include "shapes/lanes.hpp"
#include "shapes/pose.hpp"
#include "shapes/triangle.hpp"

#include <array>
#include <cstddef>

namespace obb {

// Four triangles, vertex by vertex.
using FourTriangles = std::array<Vector3<Four>, 3>;

// Where the vertices of four triangles are.
using FourCorners = std::array<std::array<const Vec3*, 3>, 4>;

void gather_triangles(const FourCorners& corners, FourTriangles& triangles);

// The same, posed, with the bits of posed().
void pose_triangles(const Pose& pose, const FourCorners& corners, FourTriangles& triangles);

[[nodiscard]] inline Triangle lane(const FourTriangles& triangles, std::size_t k) {
    return {lane(triangles[0], k), lane(triangles[1], k), lane(triangles[2], k)};
}

// For each vertex of a triangle whether it is surely above a plane, and below: all bits or none.
struct FourSides {
    alignas(kAlignment<Four>) std::array<FourMask, 3> above, below;

    [[nodiscard]] PlaneSides lane(std::size_t k) const {
        PlaneSides sides;
        for (std::size_t i = 0; i < 3; ++i) {
            sides.above |= static_cast<unsigned>(above[i][k] & (1 << i));
            sides.below |= static_cast<unsigned>(below[i][k] & (1 << i));
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
