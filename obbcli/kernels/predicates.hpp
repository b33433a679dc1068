// Exact answers about shapes at rest, for all finite doubles.
#pragma once

#include "triangle.hpp"

namespace obb {

struct TriangleVerdict {
    bool intersects;
    bool exact; // rounding could not decide, big integers did
};

// Whether two closed triangles have a point in common: exact from subnormals to the largest
// doubles, and for triangles that are segments or points. Nothing here rounds its way to a
// verdict: signs beyond proven bounds, then integers.
[[nodiscard]] TriangleVerdict test_triangles(const Triangle& a, const Triangle& b);

[[nodiscard]] bool triangles_intersect(const Triangle& a, const Triangle& b);

} // namespace obb
