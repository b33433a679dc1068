// How one body moves as seen from the other, over a short time around one moment.
//
// X and Y are the two bodies. Coordinates turn with X, which rests in them, and agree with the
// world's axes at the moment. D leads from X's pivot to Y's, V is its velocity, Wx and Wy are the
// spins, O = Wy - Wx; a point of Y lies at r from Y's pivot and at z = D + r from X's. After a time
// s
//
//     z(s) = R(-s Wx) (D + s V) + R(-s Wx) R(s Wy) r,
//
// of which the first two derivatives at s = 0 are linear in r:
//
//     z1 = V + Wy x r - Wx x z
//     z2 = Wy x (Wy x r) - 2 Wx x (V + Wy x r) + Wx x (Wx x z).
//
// The third is R(-s Wx) (Wx x (Wx x u) - 2 Wx x (Wy x u) + Wy x (Wy x u)) with u = O x R(s Wy) r,
// of length at most |O| (|Wx| + |Wy|)^2 |r|, plus that of the pivots, which is at most
// 3 |Wx|^2 |V_perp| + |Wx|^3 |D_perp|. Where the spins are parallel, R(-s Wx) R(s Wy) turns by s O
// about the common axis, and the first part is |O|^3 times the distance of r from it.
#pragma once

#include "in_motion/advancement.hpp"
#include "numbers/vec.hpp"

namespace obb {

// n . z1 and n . z2 as functions of r: constant + form . r.
struct MotionForms {
    Vec3 first, second;
    double first_constant, second_constant;
};

// Where a point of Y is and how it moves, as seen from X.
struct MovingPoint {
    Vec3 z, z1, z2;
};

class RelativeMotion {
  public:
    // Nothing moves.
    RelativeMotion() = default;
    // Seen from A: X is A and Y is B; else the other way round.
    RelativeMotion(const MovingFrame& frame, bool is_seen_from_a);

    [[nodiscard]] Vec3 between() const { return between_; }
    [[nodiscard]] MotionForms forms(Vec3 n) const;
    [[nodiscard]] MovingPoint point(Vec3 r) const;
    // The same of a vector that turns with Y: z is itself.
    [[nodiscard]] MovingPoint direction(Vec3 r) const;

    // Bounds the third derivative of z for |s| <= h and all points within `radius` of Y's pivot and
    // `axis_radius` of Y's axis.
    [[nodiscard]] double jerk(double radius, double axis_radius, double h) const;
    // The same of a vector that turns with Y, of this length.
    [[nodiscard]] double turning_jerk(double radius, double axis_radius) const;
    // Bounds the distance of a point from Y's axis, given that from its pivot.
    [[nodiscard]] double axis_radius(Vec3 r, double radius) const;
    // Bounds the speed of a point within `radius` of the one at r.
    [[nodiscard]] double speed(Vec3 r, double radius) const;

  private:
    Vec3 between_{0, 0, 0}, velocity_{0, 0, 0};
    Vec3 own_{0, 0, 0}, other_{0, 0, 0}, turning_{0, 0, 0};
    Vec3 axis_{0, 0, 0};                                         // unit, of Y's spin
    double own_speed_ = 0, both_speeds_ = 0, turning_speed_ = 0; // rounded up
    bool is_parallel_ = true;
};

} // namespace obb
