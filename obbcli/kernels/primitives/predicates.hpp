// Exact answers about shapes at rest, for all finite doubles.
#pragma once

#include "shapes/triangle.hpp"

#include <bit>
#include <cstddef>

namespace obb {

struct TriangleVerdict {
    bool intersects;
    bool exact; // rounding could not decide, big integers did
};

// Whether two closed triangles have a point in common: exact from subnormals to the largest
// doubles, and for triangles that are segments or points. Nothing here rounds its way to a
// verdict: signs beyond proven bounds, then integers.
[[nodiscard]] TriangleVerdict test_triangles(const Triangle& a, const Triangle& b);

// Which vertices of a triangle are surely above and surely below another's plane, a bit each.
struct PlaneSides {
    unsigned above = 0;
    unsigned below = 0;

    [[nodiscard]] bool all_same() const { return above == 7 || below == 7; }
    [[nodiscard]] bool all_sure() const { return (above | below) == 7; }
    // Of sure sides that differ, the vertex that stands alone and whether it is below.
    [[nodiscard]] bool lone_is_below() const { return (below & (below - 1)) == 0; }
    [[nodiscard]] std::size_t lone() const {
        return static_cast<std::size_t>(std::countr_zero(lone_is_below() ? below : above));
    }
};

// The same for triangles of which these sides are known, neither all the same.
[[nodiscard]] TriangleVerdict test_triangles(const Triangle& a, const Triangle& b,
                                             const PlaneSides& sides_a, const PlaneSides& sides_b);

[[nodiscard]] bool triangles_intersect(const Triangle& a, const Triangle& b);

} // namespace obb
