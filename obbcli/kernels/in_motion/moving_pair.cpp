#include "in_motion/moving_pair.hpp"

#include "in_motion/intersection_proof.hpp"
#include "nearest/closest_points.hpp"
#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace obb {

namespace {

// Rounding of a projection, times the 1-norms of what is projected: the spin's matrix, its product
// with the pose (5 u) and with positions (6 u), and sums over up to nine products (12 u).
constexpr double kRelative = Spin::kMatrixError + 36 * kUnitRoundoff;

} // namespace

MovingPair::MovingPair(const TreeView& a, const Pose& pose_a, const Screw& screw_a,
                       const TreeView& b, const Pose& pose_b, const Screw& screw_b, double duration,
                       double clearance)
    : a_(a, pose_a, screw_a), b_(b, pose_b, screw_b), seconds_(duration),
      mesh_clearance_(clearance) {
    set_units(duration, clearance);
    is_translation_ = a_.spin().is_still() && b_.spin().is_still();
}

// One power of two brings the largest length of the scene into [1/2, 1), another the duration.
void MovingPair::set_units(double duration, double clearance) {
    const Vec3 between = b_.screw().pivot - a_.screw().pivot;
    const Vec3 velocity = b_.screw().linear_velocity - a_.screw().linear_velocity;
    const double largest = std::max({a_.farthest(), b_.farthest(), norm_1(between)});
    if (!std::isfinite(largest) || !std::isfinite(norm_1(velocity))) {
        throw std::domain_error("positions or velocities exceed the range of double");
    }
    time_exponent_ = exponent_of(duration);
    length_exponent_ = exponent_of(largest);
    if (norm_1(velocity) > 0) {
        length_exponent_ =
            std::max(length_exponent_, exponent_of(norm_1(velocity)) + time_exponent_);
    }
    if (length_exponent_ > 1020) {
        throw std::domain_error("positions would exceed the range of double (about 1e307)");
    }
    a_.set_units(length_exponent_, time_exponent_);
    b_.set_units(length_exponent_, time_exponent_);
    set_motion();
    pivot_between_ = scaled(between, -length_exponent_);
    closing_velocity_ = scaled(velocity, time_exponent_ - length_exponent_);
    duration_ = scaled_time(duration);
    clearance_ = scaled_length(clearance);
    relative_ = kRelative;
    between_error_ =
        8 * kUnitRoundoff * (norm_1(pivot_between_) + duration_ * norm_1(closing_velocity_)) +
        0x1p-380;
}

void MovingPair::set_motion() {
    const Spin &a = a_.spin(), &b = b_.spin();
    motion_->velocity = either(a.velocity(), b.velocity());
    motion_->axis = either(a.axis(), b.axis());
    motion_->speed = either(a.speed(), b.speed());
    const auto square = [](double speed) { return (1 + 0x1p-40) * speed * speed; };
    motion_->square = either(square(a.speed()), square(b.speed()));
    motion_->node_scale = either(a_.node_scale(), b_.node_scale());
    for (std::size_t j = 0; j < 3; ++j) {
        motion_->columns[j] = either(a_.rotation().column(j), b_.rotation().column(j));
    }
    motion_->offset = either(a_.offset(), b_.offset());
    motion_->skew = std::max(a_.skew(), b_.skew());
}

LinearMotion MovingPair::linear_motion() const {
    return {a_.screw().linear_velocity, b_.screw().linear_velocity, seconds_};
}

double MovingPair::scaled_time(double seconds) const {
    return std::ldexp(seconds, -time_exponent_);
}
double MovingPair::seconds(double scaled_time) const {
    return std::ldexp(scaled_time, time_exponent_);
}
double MovingPair::scaled_length(double length) const {
    return std::ldexp(length, -length_exponent_);
}
double MovingPair::mesh_length(double scaled_length) const {
    return std::ldexp(scaled_length, length_exponent_);
}

Vec3 MovingPair::in_world(Vec3 point, double seconds) const {
    const Vec3 pivot = a_.screw().pivot + seconds * a_.screw().linear_velocity;
    return pivot + scaled(point, length_exponent_);
}

void MovingPair::turn_to(double time) {
    time_ = time;
    a_.set_time(time);
    b_.set_time(time);
    set_turns(*motion_, a_.turn(), b_.turn());
}

void MovingPair::place(const std::array<NodeRef, 2>& a, const std::array<NodeRef, 2>& b) {
    const auto node = [](const MovingTree& body, const NodeRef& ref) {
        return ref.is_triangle() ? &kNoBox : &body.tree().node(ref);
    };
    place_boxes(*motion_, {node(a_, a[0]), node(b_, b[0]), node(a_, a[1]), node(b_, b[1])},
                *boxes_);
    place_triangles(a_, a, kLaneOfA);
    place_triangles(b_, b, kLaneOfB);
}

// A triangle has no box of its own and gets one; the same triangle twice gets one box for both.
void MovingPair::place_triangles(const MovingTree& body, const std::array<NodeRef, 2>& parts,
                                 const std::array<std::size_t, 2>& lanes) {
    const auto is_triangle = [&](std::size_t k) { return parts[k].is_triangle(); };
    if (is_triangle(0)) {
        boxes_->set(lanes[0], body.box(parts[0]));
    }
    if (is_triangle(1)) {
        const bool is_same = is_triangle(0) && parts[0].begin == parts[1].begin;
        boxes_->set(lanes[1], is_same ? boxes_->box(lanes[0]) : body.box(parts[1]));
    }
}

PlacedTriangles MovingPair::triangles_at(const PairRef& pair, double time) {
    set_time(time);
    const SpinningTriangle a(a_.triangle(pair.a), a_.spin());
    const SpinningTriangle b(b_.triangle(pair.b), b_.spin());
    const Vec3 between = pivot_between_ + time * closing_velocity_;
    Triangle moved = b.points;
    for (Vec3& p : moved) {
        p = p + between;
    }
    return {a, b, moved, triangle_error(a, b)};
}

// Each triangle's coordinates are off by the error, so that the distance is off by twice that.
Gap MovingPair::gap_at(const PairRef& pair, double time) {
    const PlacedTriangles placed = triangles_at(pair, time);
    const TriangleDistance closest = measure(placed.a.points, placed.moved_b);
    const bool is_apart = closest.low > 0;
    const double low = is_apart ? std::ldexp(closest.low, closest.exponent) : 0.0;
    const double high = is_apart ? std::ldexp(closest.high, closest.exponent) : 0.0;
    const double error = 2 * placed.error;
    return {mesh_length(low - error), mesh_length(high + error),
            is_apart ? closest.point_b - closest.point_a : Vec3{0, 0, 0}};
}

bool MovingPair::surely_intersect_at(const PairRef& pair, double time) {
    const PlacedTriangles placed = triangles_at(pair, time);
    return surely_intersect(placed.a.points, placed.moved_b, placed.error);
}

} // namespace obb
