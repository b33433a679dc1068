// One triangle against four at a time: which of them are surely apart.
#pragma once

#include "lanes.hpp"
#include "triangle.hpp"

#include <array>
#include <cstddef>

namespace obb {

// Four triangles, vertex by vertex.
using FourTriangles = std::array<Vector3<Four>, 3>;

inline void set_lane(FourTriangles& triangles, std::size_t k, const Triangle& triangle) {
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            triangles[i][c][k] = triangle[i][c];
        }
    }
}

// Of which triangles neither is surely on one side of the other's plane, a bit each: the others
// have no point in common with the one. For all finite doubles, as triangles_intersect().
[[nodiscard]] unsigned crossing_planes(const Triangle& one, const FourTriangles& others);

} // namespace obb
