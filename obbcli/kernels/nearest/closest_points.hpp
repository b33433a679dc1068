// How far apart two closed triangles are: points that are so near, and a proof that none are
// nearer.
#pragma once

#include "numbers/twofold.hpp"
#include "numbers/vec.hpp"
#include "shapes/triangle.hpp"

#include <cstdint>

namespace obb {

// Which parts of two triangles are nearest: a corner of one and the face of the other, or an edge
// of each (and with it their ends). Edge k runs from corner k to the next.
struct NearFeatures {
    enum class Kind : std::uint8_t { kNone, kFaceOfA, kFaceOfB, kEdges };
    Kind kind = Kind::kNone;
    std::uint8_t part_a = 0, part_b = 0; // corner or edge; of no use for the one with the face
};

// Bounds on the distance of two triangles, in mesh units times 2^-exponent (a distance may be
// larger than any double, or smaller), and where it is attained. `high` bounds the distance of two
// points that lie on the triangles exactly; `point_a` and `point_b` are these points rounded to
// double, in mesh units. Triangles that intersect have a `low` of 0, and nothing else of them is of
// use: where an edge passes through a face no features are near.
struct TriangleDistance {
    double low;
    double high;
    int exponent;
    NearFeatures features;
    Vec3 point_a, point_b;
};

// In doubles: the bounds lie a few units of roundoff of the pair's extent apart in ordinary cases.
// Degenerate triangles are shapes like any other.
[[nodiscard]] TriangleDistance measure(const Triangle& a, const Triangle& b);

// With twice the digits: the bounds lie a unit or two in the last place of the *distance* apart, as
// long as that exceeds about 2^-45 of the pair's extent and no angle is below about 1e-12. The
// features are where to look first, as measure() found them.
[[nodiscard]] TriangleDistance measure_finely(const Triangle& a, const Triangle& b,
                                              const NearFeatures& features);

// About the direction from A to B in which they are nearest, as measure() found it, with twice the
// digits and a largest entry of about 1; 0 where they do not tell.
[[nodiscard]] Vector3<Twofold> near_direction(const Triangle& a, const Triangle& b,
                                              const NearFeatures& features);

// A point of two triangles that intersect, rounded to double.
[[nodiscard]] Vec3 common_point(const Triangle& a, const Triangle& b);

// A total order of triangles. A function that takes two triangles in this order returns the same
// digits when they are swapped.
[[nodiscard]] bool precedes(const Triangle& a, const Triangle& b);

} // namespace obb
