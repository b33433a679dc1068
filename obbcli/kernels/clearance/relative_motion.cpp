#include "clearance/relative_motion.hpp"

#include <algorithm>

namespace obb {

namespace {

// A length computed by norm() is off by a few units of roundoff, and by underflow where it is far
// below all that counts in units in which positions are about 1.
constexpr double kUp = 1 + 0x1p-40;
[[nodiscard]] double length_up(Vec3 v) { return kUp * norm(v) + 0x1p-500; }

// Spins whose cross product is this small, as a share of both, are parallel up to twice this
// angle: what that leaves of the third derivative is added.
constexpr double kParallel = 0x1p-49;

} // namespace

RelativeMotion::RelativeMotion(const MovingFrame& frame, bool is_seen_from_a) {
    const Spin& own = is_seen_from_a ? *frame.spin_a : *frame.spin_b;
    const Spin& other = is_seen_from_a ? *frame.spin_b : *frame.spin_a;
    between_ = is_seen_from_a ? frame.between : -frame.between;
    velocity_ = is_seen_from_a ? frame.closing_velocity : -frame.closing_velocity;
    const Vec3 zero{0, 0, 0};
    const bool is_common = own.velocity() == other.velocity() && velocity_ == zero &&
                           cross(between_, own.velocity()) == zero;
    if (is_common) {
        return; // both turn about one line together: nothing moves as seen from X
    }
    own_ = own.velocity();
    other_ = other.velocity();
    turning_ = other_ - own_;
    axis_ = other.axis();
    own_speed_ = kUp * own.speed();
    both_speeds_ = kUp * (own.speed() + other.speed());
    turning_speed_ = turning_ == zero ? 0 : length_up(turning_);
    is_parallel_ = norm_1(cross(own_, other_)) <= kParallel * own.speed() * other.speed();
}

// n . (W x r) = (n x W) . r, so that every cross product with r moves over to n.
MotionForms RelativeMotion::forms(Vec3 n) const {
    const Vec3 by_own = cross(n, own_), by_other = cross(n, other_);
    const Vec3 by_own_twice = cross(by_own, own_);
    return {cross(n, turning_),
            cross(by_other, other_) - 2.0 * cross(by_own, other_) + by_own_twice,
            dot(n, velocity_) - dot(by_own, between_),
            dot(by_own_twice, between_) - 2 * dot(by_own, velocity_)};
}

MovingPoint RelativeMotion::point(Vec3 r) const {
    const Vec3 z = between_ + r;
    const Vec3 u = velocity_ + cross(other_, r);
    return {z, u - cross(own_, z),
            cross(other_, cross(other_, r)) - 2.0 * cross(own_, u) + cross(own_, cross(own_, z))};
}

MovingPoint RelativeMotion::direction(Vec3 r) const {
    const Vec3 u = cross(other_, r);
    return {r, cross(turning_, r),
            cross(other_, u) - 2.0 * cross(own_, u) + cross(own_, cross(own_, r))};
}

double RelativeMotion::turning_jerk(double radius, double axis_radius) const {
    const double any = turning_speed_ * both_speeds_ * both_speeds_ * radius;
    if (!is_parallel_) {
        return kUp * any;
    }
    // Wx is a multiple of Wy's axis plus less than 2 kParallel |Wx|, which changes each of the
    // operator's factors by as much.
    const double tilt = 16 * kParallel * both_speeds_ * both_speeds_ * both_speeds_ * radius;
    const double cube = turning_speed_ * turning_speed_ * turning_speed_;
    return kUp * std::min(any, cube * axis_radius + tilt);
}

double RelativeMotion::jerk(double radius, double axis_radius, double h) const {
    if (own_speed_ == 0) {
        return turning_jerk(radius, axis_radius);
    }
    // What is across Wx of a vector v is |Wx x v| / |Wx|.
    const double square = own_speed_ * own_speed_;
    const double drift = own_speed_ * length_up(cross(own_, velocity_)); // |Wx|^2 |V_perp|
    const double offset = square * length_up(cross(own_, between_));     // |Wx|^3 |D_perp|
    return turning_jerk(radius, axis_radius) + kUp * (3 * drift + offset + own_speed_ * drift * h);
}

double RelativeMotion::axis_radius(Vec3 r, double radius) const {
    return axis_ == Vec3{0, 0, 0} ? 0 : std::min(length_up(cross(axis_, r)), radius);
}

double RelativeMotion::speed(Vec3 r, double radius) const {
    return norm(point(r).z1) + turning_speed_ * radius;
}

} // namespace obb
