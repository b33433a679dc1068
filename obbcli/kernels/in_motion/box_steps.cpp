#include "in_motion/box_steps.hpp"

namespace obb {

namespace {

// Square of what a computed spin axis may be off by.
constexpr double kAxisError = 0x1p-100;

// What all axes need of the boxes whose axes they are (own) and of the others, across the gap.
struct alignas(kAlignment<Four>) Sides {
    BasicObb<Four> other;
    std::array<Vector3<Four>, 3> other_velocity;             // W x axes of the others
    alignas(kAlignment<Four>) std::array<Four, 3> along_own; // own spin axis . own axes
    Vector3<Four> other_axis;                                // spin axis of the others
    Vector3<Four> between, velocity;                         // from own to other
    Vector3<Four> circles;                                   // between the circles' centres
    Vector3<Four> drift;                                     // closing velocity of the pivots
    Four span, other_span;     // reach of the boxes along their own spin axes
    Four pull, other_pull;     // |W|^2 times the distance of the farthest point from the axis
    Four radius, other_radius; // that distance
    FourMask other_is_still;
    Four error, velocity_error, drift_error;
};

Four radius_along(const BasicObb<Four>& box, const Vector3<Four>& n,
                  const std::array<Vector3<Four>, 3>& axes) {
    const Vector3<Four>& h = box.half_extents;
    return h.x * absolute(dot(n, axes[0])) + h.y * absolute(dot(n, axes[1])) +
           h.z * absolute(dot(n, axes[2]));
}

// One axis a lane; what the own boxes add along it is known.
struct alignas(kAlignment<Four>) OwnReach {
    Four width, velocity_spread;
    Four lever_square; // |n x k|^2 of the own spin axis k, rounded up
};

Four step_along(const Vector3<Four>& n, const OwnReach& own, const Sides& s,
                const LaneMotion& motion, bool is_long) {
    const Four zero = every(0.0, own.width);
    const Four offset = dot(n, s.between);
    const Four gap =
        absolute(offset) - own.width - radius_along(s.other, n, s.other.axes) - s.error;
    const auto is_open = gap > zero;
    if (is_none(is_open)) {
        return zero;
    }
    const Four w = flipped(dot(n, s.velocity), offset) - own.velocity_spread -
                   radius_along(s.other, n, s.other_velocity) - s.velocity_error;
    const Four along_other = dot(n, s.other_axis);
    const Four other_square = 1.0 + 0x1p-48 + motion.skew - along_other * along_other;
    const Four lever = square_root(select(own.lever_square > zero, own.lever_square, zero));
    const Four other_lever = square_root(select(other_square > zero, other_square, zero));
    Four h = closing_time(gap, w, s.pull * lever + s.other_pull * other_lever);
    if (is_long) {
        const Four own_circle = select(motion.is_still, own.width,
                                       absolute(dot(n, motion.axis)) * s.span + s.radius * lever);
        const Four other_circle =
            select(s.other_is_still, radius_along(s.other, n, s.other.axes),
                   absolute(along_other) * s.other_span + s.other_radius * other_lever);
        const Four circle_gap =
            flipped(dot(n, s.circles), offset) - own_circle - other_circle - s.error;
        const Four drift = flipped(dot(n, s.drift), offset) - s.drift_error;
        const Four still = closing_time(circle_gap, drift, zero);
        h = select(circle_gap > zero, maximum(still, h), h);
    }
    return select(is_open, h, zero);
}

Sides sides_of(const LaneMotion& motion, const BasicObb<Four>& boxes, const MovingFrame& frame,
               bool is_long) {
    Sides s;
    s.other = swapped(boxes);
    std::array<Vector3<Four>, 3> velocities;
    for (std::size_t j = 0; j < 3; ++j) {
        velocities[j] = cross(motion.velocity, boxes.axes[j]);
        s.other_velocity[j] = swapped(velocities[j]);
        s.along_own[j] = dot(motion.axis, boxes.axes[j]);
    }
    s.other_axis = swapped(motion.axis);
    const Vector3<Four> pivots = halves(frame.between, -frame.between);
    s.between = s.other.center - boxes.center + pivots;
    const Vector3<Four> center_velocity = cross(motion.velocity, boxes.center);
    s.drift = halves(frame.closing_velocity, -frame.closing_velocity);
    s.velocity = swapped(center_velocity) - center_velocity + s.drift;
    const Vector3<Four> h = boxes.half_extents;
    const Vector3<Four> from_axis = cross(motion.axis, boxes.center);
    s.radius = (1.0 + 0x1p-26) * (square_root(dot(from_axis, from_axis)) + square_root(dot(h, h)));
    s.pull = motion.square * s.radius;
    s.other_pull = swapped(s.pull);
    const Four extents = h.x + h.y + h.z;
    const Four own_sizes = absolute_sum(boxes.center) + extents;
    const Four sizes = own_sizes + swapped(own_sizes);
    const Four slant = 4.0 * motion.skew * (extents + swapped(extents));
    s.error = frame.relative * sizes + slant + frame.absolute;
    const Four speeds = motion.speed + swapped(motion.speed);
    const double drift_error = frame.relative * norm_1(frame.closing_velocity);
    s.velocity_error = speeds * (frame.relative * sizes + slant) + drift_error;
    if (is_long) {
        s.drift_error = every(drift_error, sizes);
        s.other_is_still = FourMask{motion.is_still[2], motion.is_still[3], motion.is_still[0],
                                    motion.is_still[1]};
        s.other_radius = swapped(s.radius);
        s.span = h.x * absolute(s.along_own[0]) + h.y * absolute(s.along_own[1]) +
                 h.z * absolute(s.along_own[2]);
        s.other_span = swapped(s.span);
        const Four along = dot(motion.axis, boxes.center);
        Vector3<Four> center;
        for (std::size_t k = 0; k < 3; ++k) {
            center[k] = select(motion.is_still, boxes.center[k], along * motion.axis[k]);
        }
        s.circles = swapped(center) - center + pivots;
    }
    return s;
}

} // namespace

OBB_WIDE void set_turns(LaneMotion& motion, const Turn& a, const Turn& b) {
    const Four sine = halves(a.sine, b.sine), cosine = halves(a.cosine, b.cosine);
    const Vector3<Four> k = motion.axis;
    const Vector3<Four> s = sine * k, v = (1.0 - cosine) * k;
    const std::array<Vector3<Four>, 3> spun{
        {{cosine + v.x * k.x, v.x * k.y - s.z, v.x * k.z + s.y},
         {v.x * k.y + s.z, cosine + v.y * k.y, v.y * k.z - s.x},
         {v.x * k.z - s.y, v.y * k.z + s.x, cosine + v.z * k.z}}};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            motion.matrix[i][j] = dot(spun[i], motion.columns[j]);
        }
        motion.shift[i] = dot(spun[i], motion.offset);
    }
}

OBB_WIDE std::array<double, 2> box_steps(const LaneMotion& motion, const BasicObb<Four>& boxes,
                                         const MovingFrame& frame, double wanted) {
    const double speeds = frame.spin_a->speed() + frame.spin_b->speed();
    // Circles say more than parabolas only where much turning is asked about, or left at all.
    const bool is_long = speeds * wanted > 0.5 || speeds * frame.remaining > 8;
    const Sides s = sides_of(motion, boxes, frame, is_long);
    const Vector3<Four> h = boxes.half_extents;
    Four longest = every(0.0, h.x);
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        // An axis of a box meets the box itself in one half extent, and of W x the two others it
        // sees what W has along the third: the skew makes up for axes that are not orthonormal.
        const Four square = 1.0 + 0x1p-48 + motion.skew - s.along_own[k] * s.along_own[k];
        const OwnReach own{
            h[k],
            motion.speed * (h[k1] * absolute(s.along_own[k2]) + h[k2] * absolute(s.along_own[k1])),
            square};
        longest = maximum(longest, step_along(boxes.axes[k], own, s, motion, is_long));
    }
    if (is_long) {
        const Four zero = every(0.0, h.x);
        const Four error = every(kAxisError, h.x);
        longest = maximum(longest, step_along(motion.axis, {s.span, zero, error}, s, motion, true));
    }
    longest = maximum(longest, swapped(longest));
    return {longest[0], longest[1]};
}

} // namespace obb
