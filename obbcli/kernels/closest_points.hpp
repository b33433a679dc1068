// How far apart two closed triangles are: points that are so near, and a proof that none are nearer.
#pragma once

#include "triangle.hpp"
#include "vec.hpp"

namespace obb {

// Bounds on the distance of two triangles, in mesh units times 2^-exponent (a distance may be
// larger than any double, or smaller), and where it is attained. `high` bounds the distance of two
// points that lie on the triangles exactly; `point_a` and `point_b` are these points rounded to
// double, in mesh units. For triangles that intersect `low` is 0 and nothing else is of use.
struct TriangleDistance {
    double low;
    double high;
    int exponent;
    Vec3 point_a, point_b;
};

// A lower bound that is cheap: gaps between the bounding boxes and along the two normals, in mesh
// units times 2^-exponent.
struct DistanceBound {
    double low;
    int exponent;
};
[[nodiscard]] DistanceBound distance_bound(const Triangle& a, const Triangle& b);

// In doubles: the bounds lie a few units of roundoff of the pair's extent apart in ordinary cases.
// Degenerate triangles are shapes like any other.
[[nodiscard]] TriangleDistance measure(const Triangle& a, const Triangle& b);

// With twice the digits: the bounds lie a unit or two in the last place of the *distance* apart, as
// long as that exceeds about 2^-45 of the pair's extent and no angle is below about 1e-12.
[[nodiscard]] TriangleDistance measure_finely(const Triangle& a, const Triangle& b);

} // namespace obb
