// A tree in rigid motion: its boxes and triangles at any time, relative to its pivot.
#pragma once

#include "numbers/scale.hpp"
#include "shapes/obb.hpp"
#include "shapes/pose.hpp"
#include "shapes/screw.hpp"
#include "tree/tree.hpp"

namespace obb {

// Lengths are scaled by one power of two for the whole query, times by another, so that nothing
// overflows and scaled scenes give the same bits.
class MovingTree {
  public:
    // The motion's pivot matters only to a body that turns; another's is put in its middle, where
    // rounding is least.
    MovingTree(const TreeView& tree, const Pose& pose, const Screw& screw);

    // Bounds the distance of any point from the pivot, mesh units.
    [[nodiscard]] double farthest() const { return farthest_; }
    // A radius that holds the body, mesh units.
    [[nodiscard]] double extent() const { return extent_; }
    [[nodiscard]] const Screw& screw() const { return screw_; }
    void set_units(int length_exponent, int time_exponent);

    [[nodiscard]] const TreeView& tree() const { return *tree_; }
    [[nodiscard]] const Spin& spin() const { return spin_; }
    [[nodiscard]] std::uint32_t id(const NodeRef& ref) const { return tree_->row_of(ref); }
    // By how much a box may miss a vertex: what posing and shifting it rounded away.
    [[nodiscard]] double box_error() const { return box_error_; }

    // The nodes' unit in the query's.
    [[nodiscard]] double node_scale() const { return node_scale_; }
    // Bounds how far from orthonormal the axes of boxes are once turned.
    [[nodiscard]] double skew() const { return skew_; }

    // The tree at time 0 in coordinates about the pivot: x -> rotation * x + offset.
    [[nodiscard]] const Mat3& rotation() const { return pose_.rotation; }
    [[nodiscard]] Vec3 offset() const { return offset_; }

    // Where a vertex of the mesh is at time 0, about the pivot.
    [[nodiscard]] Vec3 start_of(Vec3 vertex) const { return about_pivot(posed_vertex(vertex)); }

    // All that follows is at this time.
    void set_time(double time) { turn_ = spin_.turn(time); }
    [[nodiscard]] const Turn& turn() const { return turn_; }
    [[nodiscard]] Obb box(const NodeRef& ref) const;
    [[nodiscard]] Triangle triangle(const NodeRef& ref) const;

    // A triangle's posed vertices, the input of every exact question, in mesh units.
    [[nodiscard]] Triangle posed_triangle(const NodeRef& ref) const;

  private:
    [[nodiscard]] Vec3 posed_vertex(Vec3 vertex) const {
        return pose_.is_identity() ? vertex : posed(pose_, vertex);
    }
    [[nodiscard]] Vec3 about_pivot(Vec3 posed_vertex) const {
        return scaled(posed_vertex, -length_exponent_) - pivot_;
    }

    const TreeView* tree_;
    Pose pose_;
    Screw screw_;
    Spin spin_;
    double farthest_ = 0, extent_ = 0;
    double box_error_ = 0;
    double skew_ = 0;
    int length_exponent_ = 0;
    double node_scale_ = 1;
    Vec3 pivot_{0, 0, 0};  // scaled
    Vec3 offset_{0, 0, 0}; // of the pose, from the pivot
    Turn turn_;
};

// A box around a triangle, for tests that take boxes only.
[[nodiscard]] Obb box_around(const Triangle& triangle);

} // namespace obb
