#include "in_motion/box_steps.hpp"

#include "numbers/lane_moves.hpp"
#include "numbers/lane_vectors.hpp"

namespace obb {

namespace {

// Square of what a computed spin axis may be off by.
constexpr double kAxisError = 0x1p-100;

template <typename Real>
using Axes = std::array<Lanes3<Real>, 3>;

// A way from A to B as either body sees it.
template <typename Real>
OBB_INLINE Lanes3<Real> either_way(const Vec3& v) {
    return {alternating<Real>(v.x, -v.x), alternating<Real>(v.y, -v.y),
            alternating<Real>(v.z, -v.z)};
}

// From each lane the box across the gap.
template <typename Real>
OBB_INLINE Real across(const Real& own) {
    return shuffled<1, 0>(own);
}
template <typename Real>
OBB_INLINE Lanes3<Real> across(const Lanes3<Real>& own) {
    return {across(own[0]), across(own[1]), across(own[2])};
}

template <typename Real>
OBB_INLINE Real radius_along(const Lanes3<Real>& h, const Lanes3<Real>& n, const Axes<Real>& axes) {
    return h[0] * magnitude(inner(n, axes[0])) + h[1] * magnitude(inner(n, axes[1])) +
           h[2] * magnitude(inner(n, axes[2]));
}

// The same of each of three.
template <typename Real, typename Of>
OBB_INLINE auto each(const std::array<Real, 3>& all, const Of& of) {
    return std::array{of(all[0]), of(all[1]), of(all[2])};
}

// What all axes need of the boxes whose axes they are.
template <typename Real>
struct Own {
    Lanes3<Real> center, half_extents;
    Axes<Real> axes, velocity; // W x axes
    Lanes3<Real> along_spin;   // spin axis . axes
    Lanes3<Real> spin_axis;
    Lanes3<Real> center_velocity; // W x center
    Real radius;                  // distance of the farthest point from the spin axis
    Real pull;                    // |W|^2 times that
    Real sizes, extents, speed;
};

// The boxes across the gap.
template <typename Real>
struct Facing {
    Lanes3<Real> half_extents;
    Axes<Real> axes, box_velocity; // W x axes
    Lanes3<Real> spin_axis;
    Lanes3<Real> pivots, drift;     // from own pivot to the other, and its velocity
    Lanes3<Real> between, velocity; // the same of the centres
    Real pull, error, velocity_error, drift_error;
    double skew; // bounds how far from orthonormal the axes of either are
};

// One axis a lane; what the own boxes add along it is known.
template <typename Real>
struct OwnReach {
    Real width, velocity_spread;
    Real lever_square; // |n x k|^2 of the own spin axis k, rounded up
};

// Where the two end along an axis, how far they reach around their spins, and the step by
// parabolas.
template <typename Real>
struct Ends {
    Real offset, width, other_width, along_other, lever, other_lever;
    Real step;
};

template <typename Real>
OBB_INLINE Own<Real> own_of(const LaneMotion& motion, const PlacedBoxes& boxes) {
    const Lanes3<Real> h = lanes_at<Real>(boxes.half_extents);
    const Lanes3<Real> center = lanes_at<Real>(boxes.center);
    const Lanes3<Real> spin_axis = lanes_at<Real>(motion.axis);
    const Lanes3<Real> w = lanes_at<Real>(motion.velocity);
    const auto turned = [&](const PairLanes3& axis) __attribute__((always_inline)) {
        return outer(w, lanes_at<Real>(axis));
    };
    const auto along = [&](const PairLanes3& axis) __attribute__((always_inline)) {
        return inner(spin_axis, lanes_at<Real>(axis));
    };
    const auto axis = [](const PairLanes3& lanes)
                          __attribute__((always_inline)) { return lanes_at<Real>(lanes); };
    const Lanes3<Real> from_axis = outer(spin_axis, center);
    const Real radius =
        Real(1.0 + 0x1p-26) * (root_of(inner(from_axis, from_axis)) + root_of(inner(h, h)));
    const Real extents = h[0] + h[1] + h[2];
    return {center,
            h,
            each(boxes.axes, axis),
            each(boxes.axes, turned),
            each(boxes.axes, along),
            spin_axis,
            outer(w, center),
            radius,
            Real::at(motion.square.data()) * radius,
            absolute_sum(center) + extents,
            extents,
            Real::at(motion.speed.data())};
}

template <typename Real>
OBB_INLINE Facing<Real> facing(const Own<Real>& own, const LaneMotion& motion,
                               const MovingFrame& frame) {
    const auto other = [](const auto& lanes)
                           __attribute__((always_inline)) { return across(lanes); };
    const Lanes3<Real> pivots = either_way<Real>(frame.between);
    const Lanes3<Real> drift = either_way<Real>(frame.closing_velocity);
    const Real sizes = own.sizes + other(own.sizes);
    const Real slant = Real(4.0 * motion.skew) * (own.extents + other(own.extents));
    const Real rounding = Real(frame.relative) * sizes + slant;
    const Real speeds = own.speed + other(own.speed);
    const Real drift_error(frame.relative * norm_1(frame.closing_velocity));
    return {other(own.half_extents),
            each(own.axes, other),
            each(own.velocity, other),
            other(own.spin_axis),
            pivots,
            drift,
            sum(difference(other(own.center), own.center), pivots),
            sum(difference(other(own.center_velocity), own.center_velocity), drift),
            other(own.pull),
            rounding + Real(frame.absolute),
            speeds * rounding + drift_error,
            drift_error,
            motion.skew};
}

// What only bounds by whole circles need.
template <typename Real>
struct Circles {
    Lanes3<Real> ways;     // from the middle of the centre's circle to that of the other's
    Real span, other_span; // reach of the boxes along their spin axes
    typename Real::Mask is_still, other_is_still;
    bool matter = false; // whether the motion is so long that they are asked for
};

template <typename Real>
OBB_INLINE Circles<Real> circles_of(const Own<Real>& own, const Facing<Real>& f) {
    const Lanes3<Real>& h = own.half_extents;
    const auto is_still = own.speed <= Real{};
    const Real along = inner(own.spin_axis, own.center);
    const Lanes3<Real> middle{select(is_still, own.center[0], along * own.spin_axis[0]),
                              select(is_still, own.center[1], along * own.spin_axis[1]),
                              select(is_still, own.center[2], along * own.spin_axis[2])};
    const Real span = h[0] * magnitude(own.along_spin[0]) + h[1] * magnitude(own.along_spin[1]) +
                      h[2] * magnitude(own.along_spin[2]);
    return {sum(difference(across(middle), middle), f.pivots),
            span,
            across(span),
            is_still,
            across(own.speed) <= Real{},
            true};
}

// The longer step, by whole circles or by parabolas, where circles leave a gap open along n.
template <typename Real>
OBB_INLINE Real circle_step(const Lanes3<Real>& n, const Ends<Real>& ends, const Own<Real>& own,
                            const Facing<Real>& f, const Circles<Real>& circles) {
    const Real own_circle =
        select(circles.is_still, ends.width,
               magnitude(inner(n, own.spin_axis)) * circles.span + own.radius * ends.lever);
    const Real other_circle = select(circles.other_is_still, ends.other_width,
                                     magnitude(ends.along_other) * circles.other_span +
                                         across(own.radius) * ends.other_lever);
    const Real gap =
        flipped(inner(n, circles.ways), ends.offset) - own_circle - other_circle - f.error;
    const Real drift = flipped(inner(n, f.drift), ends.offset) - f.drift_error;
    const Real still = closing_time(gap, drift, Real{});
    return select(gap > Real{}, upper(still, ends.step), ends.step);
}

template <typename Real>
OBB_INLINE Real step_along(const Lanes3<Real>& n, const OwnReach<Real>& reach, const Own<Real>& own,
                           const Facing<Real>& f, const Circles<Real>& circles) {
    const Real zero{};
    const Real offset = inner(n, f.between);
    const Real other_width = radius_along(f.half_extents, n, f.axes);
    const Real gap = magnitude(offset) - reach.width - other_width - f.error;
    const auto is_open = gap > zero;
    if (bits_of<Real>(is_open) == 0) {
        return zero;
    }
    const Real w = flipped(inner(n, f.velocity), offset) - reach.velocity_spread -
                   radius_along(f.half_extents, n, f.box_velocity) - f.velocity_error;
    const Real along_other = inner(n, f.spin_axis);
    const Real other_square = Real(1.0 + 0x1p-48 + f.skew) - along_other * along_other;
    const Real lever = root_of(select(reach.lever_square > zero, reach.lever_square, zero));
    const Real other_lever = root_of(select(other_square > zero, other_square, zero));
    Real step = closing_time(gap, w, own.pull * lever + f.pull * other_lever);
    if (circles.matter) {
        step = circle_step(
            n, {offset, reach.width, other_width, along_other, lever, other_lever, step}, own, f,
            circles);
    }
    return select(is_open, step, zero);
}

// Unit directions from own boxes to those across, between points that are nearly the nearest; 0
// where these meet. Any direction would do, shorter than 1 by more than its rounding.
template <typename Real>
OBB_INLINE Lanes3<Real> near_direction(const Own<Real>& own, const Facing<Real>& f) {
    const auto clamped = [](const Real& value, const Real& radius) __attribute__((always_inline)) {
        return upper(lower(value, radius), Real{} - radius);
    };
    const auto stretched = [](const Lanes3<Real>& v, const Real& factor)
                               __attribute__((always_inline)) {
                                   return Lanes3<Real>{factor * v[0], factor * v[1], factor * v[2]};
                               };
    Lanes3<Real> p{}; // own point nearest the other's centre, from the own centre
    unrolled<3>([&](auto k) __attribute__((always_inline)) {
        const Real y = clamped(inner(own.axes[k], f.between), own.half_extents[k]);
        p = sum(p, stretched(own.axes[k], y));
    });
    const Lanes3<Real> back = difference(p, f.between);
    Lanes3<Real> q = f.between; // the other's point nearest to that one
    unrolled<3>([&](auto k) __attribute__((always_inline)) {
        const Real z = clamped(inner(f.axes[k], back), f.half_extents[k]);
        q = sum(q, stretched(f.axes[k], z));
    });
    Lanes3<Real> n{};
    unrolled<3>([&](auto k) __attribute__((always_inline)) {
        const Real w = inner(own.axes[k], q);
        n = sum(n, stretched(own.axes[k], w - clamped(w, own.half_extents[k])));
    });
    const Real square = inner(n, n);
    return stretched(
        n, select(square > Real(0x1p-400), Real(1.0 - 0x1p-48) / root_of(square), Real{}));
}

// Each lane of the pairs says what its own box's axes prove; the longest of both is the pair's.
template <typename Real>
OBB_INLINE Real longest_step(const Own<Real>& own, const LaneMotion& motion,
                             const MovingFrame& frame, bool is_long) {
    const Facing<Real> f = facing(own, motion, frame);
    const Circles<Real> circles = is_long ? circles_of(own, f) : Circles<Real>{};
    const Lanes3<Real>& h = own.half_extents;
    Real longest{};
    unrolled<3>([&](auto k) __attribute__((always_inline)) {
        const std::size_t k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        // An axis of a box meets the box itself in one half extent, and of W x the two others it
        // sees what W has along the third: the skew makes up for axes that are not orthonormal.
        const OwnReach<Real> reach{
            h[k],
            own.speed *
                (h[k1] * magnitude(own.along_spin[k2]) + h[k2] * magnitude(own.along_spin[k1])),
            Real(1.0 + 0x1p-48 + motion.skew) - own.along_spin[k] * own.along_spin[k]};
        longest = upper(longest, step_along(own.axes[k], reach, own, f, circles));
    });
    if (circles.matter) {
        const OwnReach<Real> reach{circles.span, Real{}, Real(kAxisError)};
        longest = upper(longest, step_along(own.spin_axis, reach, own, f, circles));
    }
    // Boxes that pass each other at the clearance are mostly apart along no axis of theirs.
    if (frame.seeks_near) {
        const Lanes3<Real> n = near_direction(own, f);
        const Real along = inner(n, own.spin_axis);
        const OwnReach<Real> reach{radius_along(h, n, own.axes), radius_along(h, n, own.velocity),
                                   Real(1.0 + 0x1p-48 + motion.skew) - along * along};
        longest = upper(longest, step_along(n, reach, own, f, circles));
    }
    return upper(longest, across(longest));
}

// Circles say more than parabolas only where much turning is asked about, or left at all.
bool is_long_motion(const MovingFrame& frame, double wanted) {
    const double speeds = frame.spin_a->speed() + frame.spin_b->speed();
    return speeds * wanted > 0.5 || speeds * frame.remaining > 8;
}

} // namespace

std::array<double, 2> box_steps(const LaneMotion& motion, const PlacedBoxes& boxes,
                                const MovingFrame& frame, double wanted) {
    const bool is_long = is_long_motion(frame, wanted);
    std::array<double, 2> steps{};
    in_registers([&]<std::size_t kBytes>() {
        using Real = Doubles<kBytes>;
        const Real longest = longest_step(own_of<Real>(motion, boxes), motion, frame, is_long);
        steps = {longest[kLaneOfA[0]], longest[kLaneOfA[1]]};
    });
    return steps;
}

} // namespace obb
