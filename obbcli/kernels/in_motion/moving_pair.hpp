// Both trees in motion at one time, in one unit of length and one of time: their boxes and
// triangles, how long these stay apart, and proofs of contact.
#pragma once

#include "in_motion/box_steps.hpp"
#include "in_motion/moving_tree.hpp"
#include "in_motion/triangle_advancement.hpp"
#include "primitives/touch.hpp"

#include <array>
#include <limits>
#include <memory>

namespace obb {

// A node or triangle of each body.
struct PairRef {
    NodeRef a, b;
};

// Bounds on the distance of two triangles, mesh units, and the direction from A's nearest point to
// B's; zeros where they may intersect.
struct Gap {
    double low, high;
    Vec3 direction;
};

// Two triangles about A's pivot at one time, and what each of their coordinates may be off by.
struct PlacedTriangles {
    SpinningTriangle a, b;
    Triangle moved_b; // b lies about B's pivot, this about A's
    double error;
};

// Lengths are scaled by one power of two and times by another, so that positions and the duration
// are at most about 1. "Scaled" below means in these units.
class MovingPair {
  public:
    // The trees must outlive it. Duration in s, clearance in mesh units. Throws std::domain_error
    // where positions would leave the range of double.
    MovingPair(const TreeView& a, const Pose& pose_a, const Screw& screw_a, const TreeView& b,
               const Pose& pose_b, const Screw& screw_b, double duration, double clearance);

    [[nodiscard]] const MovingTree& a() const { return a_; }
    [[nodiscard]] const MovingTree& b() const { return b_; }
    [[nodiscard]] double duration() const { return duration_; }   // scaled
    [[nodiscard]] double clearance() const { return clearance_; } // scaled
    [[nodiscard]] double mesh_clearance() const { return mesh_clearance_; }
    [[nodiscard]] bool is_translation() const { return is_translation_; }
    [[nodiscard]] Vec3 closing_velocity() const { return closing_velocity_; }
    // The angle by which the two turn, rad.
    [[nodiscard]] double turning() const {
        return (a_.spin().speed() + b_.spin().speed()) * duration_;
    }
    // What the motion is where neither turns, in mesh units and s.
    [[nodiscard]] LinearMotion linear_motion() const;

    // Mesh units times 2^-length_exponent() are scaled.
    [[nodiscard]] int length_exponent() const { return length_exponent_; }
    [[nodiscard]] double scaled_time(double seconds) const;
    [[nodiscard]] double seconds(double scaled_time) const;
    [[nodiscard]] double scaled_length(double length) const;
    [[nodiscard]] double mesh_length(double scaled_length) const;
    // A point about A's pivot, scaled, in the world at a time in s.
    [[nodiscard]] Vec3 in_world(Vec3 point, double seconds) const;

    // The largest half extent of a node, scaled; 0 for triangles.
    [[nodiscard]] static double size_of(const MovingTree& body, const NodeRef& ref) {
        return ref.is_triangle()
                   ? 0
                   : body.node_scale() * norm_inf(half_extents_of(body.tree().node(ref)));
    }

    // The motion from a time on. `absolute` is what positions are off by beyond rounding.
    [[nodiscard]] MovingFrame frame(double absolute, double time) const {
        return {pivot_between_ + time * closing_velocity_,
                closing_velocity_,
                &a_.spin(),
                &b_.spin(),
                duration_ - time,
                relative_,
                between_error_ + clearance_ + absolute,
                clearance_ > kWideClearance};
    }
    // The same for boxes, with a margin to spare.
    [[nodiscard]] MovingFrame box_frame(double time, double margin = 0) const {
        return frame(a_.box_error() + b_.box_error() + margin, time);
    }

    void set_time(double time) {
        if (time != time_) {
            turn_to(time);
        }
    }
    // Puts the boxes of two parts of each body where they are at the present time.
    void place(const std::array<NodeRef, 2>& a, const std::array<NodeRef, 2>& b);
    [[nodiscard]] const PlacedBoxes& boxes() const { return *boxes_; }
    // How long the placed boxes stay apart, pair by pair, as box_steps() says.
    [[nodiscard]] std::array<double, 2> steps(const MovingFrame& frame, double wanted) const {
        return box_steps(*motion_, *boxes_, frame, wanted);
    }

    // Triangles at a time; this sets the time.
    [[nodiscard]] PlacedTriangles triangles_at(const PairRef& pair, double time);
    [[nodiscard]] Gap gap_at(const PairRef& pair, double time);
    [[nodiscard]] bool surely_intersect_at(const PairRef& pair, double time);
    [[nodiscard]] double triangle_error(const SpinningTriangle& a,
                                        const SpinningTriangle& b) const {
        return relative_ * (a.size + b.size) + between_error_;
    }

  private:
    // Scaled. Boxes are looked at along their nearest points where the clearance is wider than
    // this: one that stands for what legs of a path are off by gains nothing from it.
    static constexpr double kWideClearance = 0x1p-20;

    void set_units(double duration, double clearance);
    void set_motion();
    void turn_to(double time);
    void place_triangles(const MovingTree& body, const std::array<NodeRef, 2>& parts,
                         const std::array<std::size_t, 2>& lanes);

    MovingTree a_, b_;
    // On the heap: what is to lie within lines of a cache wants more alignment than the objects
    // that hold queries have.
    std::unique_ptr<LaneMotion> motion_ = std::make_unique<LaneMotion>();
    std::unique_ptr<PlacedBoxes> boxes_ = std::make_unique<PlacedBoxes>(); // of the parts
    int length_exponent_ = 0, time_exponent_ = 0;
    double duration_ = 0, clearance_ = 0;
    Vec3 pivot_between_{0, 0, 0}, closing_velocity_{0, 0, 0};
    double relative_ = 0, between_error_ = 0;
    bool is_translation_ = false;
    double seconds_, mesh_clearance_; // the duration, and the clearance as given
    double time_ = -1;                // that the bodies are at
};

} // namespace obb
