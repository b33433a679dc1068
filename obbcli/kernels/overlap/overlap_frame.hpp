// The coordinates in which two solids are compared: those of the world, moved and scaled.
#pragma once

#include "numbers/scale.hpp"
#include "numbers/vec.hpp"
#include "shapes/pose.hpp"
#include "tree/tree.hpp"

namespace obb {

// x -> x * 2^-exponent - origin, so that no coordinate of either body exceeds 1. Axes keep their
// directions and lengths their ratios: a length of the frame times 2^exponent is one in mesh units.
// The origin is 0 unless the bodies stand far from it.
struct OverlapFrame {
    Vec3 origin{0, 0, 0}; // in the frame's unit
    int exponent = 0;

    [[nodiscard]] Vec3 to_frame(const Vec3& world) const {
        return scaled(world, -exponent) - origin;
    }
    [[nodiscard]] Vec3 to_world(const Vec3& place) const {
        return scaled(place + origin, exponent);
    }
    friend bool operator==(const OverlapFrame&, const OverlapFrame&) = default;
};

// How far to_frame() moves a point or a corner, as a length of the frame: one rounding of each of
// three coordinates of at most 1 is sqrt(3) u, and what underflows is far below that. A distance
// of a point from a triangle changes by at most twice as much, 3.5 u.
inline constexpr double kPlaceError = 4 * kUnitRoundoff;

// The same frame for both orders of two bodies. Throws std::domain_error where posed coordinates
// would leave the range of double.
[[nodiscard]] OverlapFrame overlap_frame(const TreeView& a, const Pose& pose_a, const TreeView& b,
                                         const Pose& pose_b);

} // namespace obb
