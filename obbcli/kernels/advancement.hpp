// How long two shapes that are apart stay apart: steps on separating axes that hold for a while.
//
// Along a fixed n a point of a body at pivot K_t has the coordinate n.(K_t + R y). Its velocity is
// n.(V + W x R y), its acceleration at most |W| |n x W| rho, with rho the point's distance from the
// body's axis. So a gap g that closes at rate -w stays open for the positive root h of
// g + w h - a h^2 / 2 = 0. And however often the body turns, the point stays on its circle: centre
// n.(K_t + (k.Ry) k), radius rho |n x k|. Each is a proof for all of [t, t + h).
#pragma once

#include "obb.hpp"
#include "pack.hpp"
#include "screw.hpp"

#include <limits>

namespace obb {

// Both bodies at one time, as the steps need them. Positions are relative to each body's own pivot;
// the pivots' own motion is what B's does beyond A's.
struct MovingFrame {
    Vec3 between;          // B's pivot less A's at this time
    Vec3 closing_velocity; // B's linear velocity less A's
    const Spin* spin_a;
    const Spin* spin_b;
    double remaining; // time left
    double relative;  // rounding of a projection, times the sizes in play
    double absolute;  // rounding of the positions themselves, plus the clearance asked for
};

// The positive root of g + w h - a h^2 / 2 for g > 0 and a >= 0: infinite where the gap never
// closes. Written so that nothing cancels; 2^-48 covers its rounding.
template <typename Real>
[[nodiscard]] inline Real closing_time(Real g, Real w, Real a) {
    const Real root = square_root(w * w + 2.0 * a * g);
    const auto opens = w > every(0.0, w);
    const Real numerator = select(opens, root + w, 2.0 * g);
    const Real denominator = select(opens, a, root - w);
    return (1.0 - 0x1p-48) * numerator / denominator;
}

// One side of a pair of boxes: what every axis needs of it.
template <typename Real>
struct SpinningBox {
    const BasicObb<Real>* box;
    Vector3<Real> center_velocity;              // W x center
    std::array<Vector3<Real>, 3> axis_velocity; // W x axes[i]
    Real radius;                                // bounds the distance of its points from the axis
    const Spin* spin;

    SpinningBox(const BasicObb<Real>& b, const Spin& s) : box(&b), spin(&s) {
        const Vec3 w = s.velocity(), k = s.axis();
        center_velocity = crossed(w, b.center);
        for (std::size_t i = 0; i < 3; ++i) {
            axis_velocity[i] = crossed(w, b.axes[i]);
        }
        const Vector3<Real> c = crossed(k, b.center);
        const Vector3<Real> h = b.half_extents;
        radius = (1.0 + 0x1p-26) * (square_root(dot(c, c)) + square_root(dot(h, h)));
    }

    [[nodiscard]] Real reach_along(const Vector3<Real>& n) const { return reach(n, box->axes); }
    // The most that the box's extent adds to the velocity of its points along n.
    [[nodiscard]] Real velocity_spread(const Vector3<Real>& n) const {
        return reach(n, axis_velocity);
    }
    // |n x k|, rounded up: how far points at distance 1 from the axis get along n.
    [[nodiscard]] Real lever_along(const Vector3<Real>& n) const {
        const Vector3<Real> c = crossed(spin->axis(), n);
        return square_root(dot(c, c)) * (1.0 + 0x1p-26) + 0x1p-50;
    }
    // What the whole turning box covers along n: a middle, and half the width about it.
    [[nodiscard]] Real circle_center(const Vector3<Real>& n) const {
        return spin->is_still() ? dot(n, box->center)
                                : dot_with(n, spin->axis()) * dot_with(box->center, spin->axis());
    }
    [[nodiscard]] Real circle_reach(const Vector3<Real>& n, Real lever) const {
        if (spin->is_still()) {
            return reach_along(n);
        }
        const Vector3<Real> h = box->half_extents;
        const Real spread = h.x * absolute(dot_with(box->axes[0], spin->axis())) +
                            h.y * absolute(dot_with(box->axes[1], spin->axis())) +
                            h.z * absolute(dot_with(box->axes[2], spin->axis()));
        return absolute(dot_with(n, spin->axis())) * spread + radius * lever;
    }

  private:
    [[nodiscard]] static Vector3<Real> crossed(Vec3 u, Vector3<Real> v) {
        return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    }
    [[nodiscard]] static Real dot_with(const Vector3<Real>& n, Vec3 v) {
        return n.x * v.x + n.y * v.y + n.z * v.z;
    }
    [[nodiscard]] Real reach(const Vector3<Real>& n,
                             const std::array<Vector3<Real>, 3>& along) const {
        const Vector3<Real> h = box->half_extents;
        return h.x * absolute(dot(n, along[0])) + h.y * absolute(dot(n, along[1])) +
               h.z * absolute(dot(n, along[2]));
    }
};

// A time for which two boxes are proven apart from now on: 0 where no face axis shows a gap,
// infinite where they never meet. Axes must be unit up to 2^-28.
template <typename Real>
[[nodiscard]] inline Real time_apart(const BasicObb<Real>& a, const BasicObb<Real>& b,
                                     const MovingFrame& frame) {
    const SpinningBox<Real> moving_a(a, *frame.spin_a), moving_b(b, *frame.spin_b);
    const auto with = [](Vector3<Real> v, Vec3 u) {
        return Vector3<Real>{v.x + u.x, v.y + u.y, v.z + u.z};
    };
    const Vector3<Real> d = with(b.center - a.center, frame.between);
    const Vector3<Real> velocity =
        with(moving_b.center_velocity - moving_a.center_velocity, frame.closing_velocity);
    const Vector3<Real> ha = a.half_extents, hb = b.half_extents;
    const Real sizes = absolute_sum(a.center) + absolute_sum(b.center) + (ha.x + ha.y + ha.z) +
                       (hb.x + hb.y + hb.z);
    const Real e = frame.relative * sizes + frame.absolute;
    const double speeds = frame.spin_a->speed() + frame.spin_b->speed();
    const Real e_velocity = frame.relative * (speeds * sizes + norm_1(frame.closing_velocity));
    const double e_drift = frame.relative * norm_1(frame.closing_velocity);
    // Circles say more than parabolas only where much turning is left.
    const bool is_long = speeds * frame.remaining > 0.5;

    const double square_a = frame.spin_a->speed() * frame.spin_a->speed() * (1 + 0x1p-40);
    const double square_b = frame.spin_b->speed() * frame.spin_b->speed() * (1 + 0x1p-40);

    Real longest = every(0.0, d.x);
    const auto try_axis = [&](Vector3<Real> n) {
        const Real offset = dot(n, d);
        const auto flips = offset < every(0.0, offset);
        n = {select(flips, -n.x, n.x), select(flips, -n.y, n.y), select(flips, -n.z, n.z)};
        const Real gap = absolute(offset) - moving_a.reach_along(n) - moving_b.reach_along(n) - e;
        const auto is_open = gap > every(0.0, gap);
        if (is_none(is_open)) {
            return;
        }
        const Real w = dot(n, velocity) - moving_a.velocity_spread(n) -
                       moving_b.velocity_spread(n) - e_velocity;
        const Real lever_a = moving_a.lever_along(n), lever_b = moving_b.lever_along(n);
        const Real acceleration =
            square_a * moving_a.radius * lever_a + square_b * moving_b.radius * lever_b;
        Real h = closing_time(gap, w, acceleration);
        if (is_long) {
            const Real between =
                n.x * frame.between.x + n.y * frame.between.y + n.z * frame.between.z;
            const Real circle_gap = between + moving_b.circle_center(n) -
                                    moving_a.circle_center(n) - moving_a.circle_reach(n, lever_a) -
                                    moving_b.circle_reach(n, lever_b) - e;
            const Real drift = n.x * frame.closing_velocity.x + n.y * frame.closing_velocity.y +
                               n.z * frame.closing_velocity.z - e_drift;
            const Real still = closing_time(circle_gap, drift, every(0.0, drift));
            h = select(circle_gap > every(0.0, circle_gap), maximum(still, h), h);
        }
        longest = select(is_open, maximum(longest, h), longest);
    };
    for (std::size_t i = 0; i < 3; ++i) {
        try_axis(a.axes[i]);
    }
    for (std::size_t j = 0; j < 3; ++j) {
        try_axis(b.axes[j]);
    }
    if (is_long) {
        const auto same = [&](Vec3 k) {
            return Vector3<Real>{every(k.x, d.x), every(k.y, d.x), every(k.z, d.x)};
        };
        for (const Spin* spin : {frame.spin_a, frame.spin_b}) {
            if (!spin->is_still()) {
                try_axis(same(spin->axis()));
            }
        }
    }
    return longest;
}

} // namespace obb
