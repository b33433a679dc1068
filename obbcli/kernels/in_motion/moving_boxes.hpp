// Boxes of two moving trees at one time, two of A and two of B at once.
#pragma once

#include "shapes/obb.hpp"
#include "shapes/screw.hpp"
#include "tree/node.hpp"

#include <array>
#include <cstddef>

namespace obb {

// Doubles in the order of lanes: of A, of B, of A, of B. Nothing is said of alignment, as what
// holds them may be anywhere.
using PairLanes = std::array<double, 4>;
using PairLanes3 = std::array<PairLanes, 3>;

[[nodiscard]] inline PairLanes either(double a, double b) { return {a, b, a, b}; }
[[nodiscard]] inline PairLanes3 either(const Vec3& a, const Vec3& b) {
    return {either(a.x, b.x), either(a.y, b.y), either(a.z, b.z)};
}
[[nodiscard]] inline Vec3 lane(const PairLanes3& lanes, std::size_t k) {
    return {lanes[0][k], lanes[1][k], lanes[2][k]};
}

// The lane of A's i-th box or of B's.
inline constexpr std::array<std::size_t, 2> kLaneOfA{0, 2}, kLaneOfB{1, 3};

// Each about its own body's pivot.
struct alignas(32) PlacedBoxes {
    PairLanes3 center, half_extents;
    std::array<PairLanes3, 3> axes;

    void set(std::size_t lane, const Obb& box);
    [[nodiscard]] Obb box(std::size_t lane) const;
};

// Both bodies' motions at one time.
struct alignas(32) LaneMotion {
    // From the coordinates of either tree to those about its pivot, at the present time:
    // x -> matrix * (node_scale * x) + shift.
    std::array<PairLanes3, 3> matrix; // rows
    PairLanes3 shift;
    // Constant.
    PairLanes node_scale;
    std::array<PairLanes3, 3> columns; // of the poses' rotations
    PairLanes3 offset;                 // of the poses, from the pivots
    PairLanes3 velocity;               // of the spins
    PairLanes3 axis;                   // unit; zero where still
    PairLanes speed, square;           // of the spins; the square rounded up
    double skew;                       // bounds how far from orthonormal axes of either body are
};

// Sets the frame to where both have turned, with the bits of Spin::matrix().
void set_turns(LaneMotion& motion, const Turn& a, const Turn& b);

// In the order of the lanes.
using FourPlaced = std::array<const Node*, 4>;

void place_boxes(const LaneMotion& motion, const FourPlaced& nodes, PlacedBoxes& boxes);

} // namespace obb
