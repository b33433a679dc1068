#include "screws/relative_screw.hpp"

#include "numbers/double_double.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace obb {

namespace {

// Slack beyond the nearness asked for, of the extent of the smaller body, with which images still
// tell surfaces apart that glide along each other.
constexpr double kMostExcess = 0x1p-10;

// a b - c d: zero for certain where both products are the same.
double product_difference(double a, double b, double c, double d) {
    const DoubleDouble p = two_product(a, b), q = two_product(c, d);
    return (p.high - q.high) + (p.low - q.low);
}

Vec3 careful_cross(Vec3 a, Vec3 b) {
    return {product_difference(a.y, b.z, a.z, b.y), product_difference(a.z, b.x, a.x, b.z),
            product_difference(a.x, b.y, a.y, b.x)};
}

// Any unit vector across a unit vector.
Vec3 across(Vec3 k) {
    const Vec3 h = abs(k);
    const Vec3 least = h.x <= h.y && h.x <= h.z ? Vec3{1, 0, 0}
                       : h.y <= h.z             ? Vec3{0, 1, 0}
                                                : Vec3{0, 0, 1};
    const Vec3 e = cross(k, least);
    return (1 / norm(e)) * e;
}

} // namespace

// Both bodies turn about one axis and slide along it if W_A x W_B = 0, if V = V_B - V_A has no part
// across the axis, and, where both turn, if the line between their pivots has none. Whatever is
// missing bounds how far a point of B strays from where the screw has it, at any time up to T:
//   V_perp:     by T |V_perp|;
//   K_perp:     by |K_perp|, the distance between the axes;
//   W_A x W_B:  the part of either spin across W = W_B - W_A has the length |W_A x W_B| / |W|, and
//               two rotations at constant velocities that differ by w are no further apart than
//               T w at a distance of 1: T |W_A x W_B| / |W| (L_A + L_B), L the reaches.
// Rounding, with u = 2^-53, L = L_A + L_B and K the line between the pivots, is charged as well:
//   - Positions: a vertex less its pivot is off by u of either, the shift and the products with
//     axis, across and third, which are orthonormal to 4 u, by 8 u of the result, and the axis by
//     4 u from W, which is a change of frame and does not grow with turns. That is below
//     16 u (L + |K|); it is charged as 1024 u, which covers cut triangles too (6 u more).
//   - pitch * speed is off by 12 u |V| from the velocity along the axis, and the way by T times
//     that: charged as 32 u T |V|.
//   - The angle speed * t is off by 4 u of itself, as are speed and product: charged as 16 u of the
//     sweep. This is no error of z - pitch * angle: at a contact both sides of that differ by
//     pitch times whole turns and by T times the error of pitch * speed alone.
// Positions at the smallest scales are off by what underflows: 2^-380, as in MovingPair.
std::optional<RelativeScrew> relative_screw(const MotionOfTwo& m) {
    const Vec3 w = m.spin_b - m.spin_a; // each component to u, whatever cancels
    const double speed = norm(w), sweep = speed * m.duration;
    if (!(sweep >= kLeastSweep)) {
        return std::nullopt;
    }
    constexpr Vec3 kStill{0, 0, 0};
    const bool turns_a = m.spin_a != kStill, turns_b = m.spin_b != kStill;
    RelativeScrew screw{};
    screw.axis = (1 / speed) * w;
    screw.across = across(screw.axis);
    screw.third = cross(screw.axis, screw.across);
    screw.speed = speed;
    screw.sweep = sweep;
    screw.angle_error = 0x1p-49 * sweep;

    const double along = dot(m.closing_velocity, screw.axis);
    const double drift = m.duration * norm(m.closing_velocity - along * screw.axis);
    const double height = dot(m.between, screw.axis);
    const double offset = turns_a && turns_b ? norm(m.between - height * screw.axis) : 0;
    const double reach = (1 + 0x1p-10) * (m.reach_a + m.reach_b); // poses may be a little skew
    const double tilt = turns_a && turns_b
                            ? m.duration * norm(careful_cross(m.spin_a, m.spin_b)) / speed * reach
                            : 0;
    const double rounding = 0x1p-43 * (reach + norm_1(m.between)) +
                            0x1p-48 * m.duration * norm_1(m.closing_velocity) + 0x1p-380;
    screw.excess = (1 + 0x1p-30) * (drift + offset + tilt) + rounding;

    screw.pitch = along / speed;
    const double travel = std::fabs(screw.pitch) * sweep;
    if (travel <= 0x1p-48 * reach) { // a hinge, but for less than rounding
        screw.excess += travel;
        screw.pitch = 0;
    }
    screw.lead = 2 * std::numbers::pi * screw.pitch;
    // Of two points that are near each other the middle is half as far from either.
    screw.slack = 0.5 * (screw.excess + (1 + 0x1p-30) * m.near);
    if (turns_a && turns_b) {
        screw.shift_b = height * screw.axis;
    } else if (turns_a) {
        screw.shift_b = m.between;
    } else {
        screw.shift_a = -m.between;
    }
    const double extent = std::min(m.extent_a, m.extent_b);
    // A comparison with NaN, as after an overflow, declines.
    return screw.excess <= kMostExcess * extent ? std::optional(screw) : std::nullopt;
}

} // namespace obb
