// A tree where its body stands: boxes in a frame that two bodies share, triangles in the world.
#pragma once

#include "descent/triangle_lanes.hpp"
#include "shapes/obb.hpp"
#include "shapes/pose.hpp"
#include "tree/tree.hpp"

#include <array>
#include <cstdint>

namespace obb {

// One body of a query: boxes in the query's frame for pruning, posed triangles for verdicts.
class PosedTree {
  public:
    PosedTree(const TreeView& tree, const Pose& pose)
        : tree_(&tree), pose_(pose), is_posed_(!pose.is_identity()) {}

    // The frame in which boxes are tested: x -> matrix * (x * 2^-exponent) + offset.
    void set_frame(const Mat3& matrix, Vec3 offset, int exponent);

    [[nodiscard]] const TreeView& tree() const { return *tree_; }
    [[nodiscard]] const Pose& pose() const { return pose_; }
    [[nodiscard]] bool is_posed() const { return is_posed_; } // other than as loaded
    [[nodiscard]] const Mat3& matrix() const { return matrix_; }
    [[nodiscard]] Vec3 offset() const { return offset_; }
    // The nodes' unit in the frame's.
    [[nodiscard]] double node_scale() const { return scale_; }
    [[nodiscard]] Obb box(const Node& node) const;
    [[nodiscard]] Triangle triangle_in_frame(const NodeRef& ref) const;
    [[nodiscard]] Triangle triangle(const NodeRef& ref) const;
    // A vertex of the tree, in the world.
    [[nodiscard]] Vec3 placed(const Vec3& vertex) const {
        return is_posed_ ? posed(pose_, vertex) : vertex;
    }
    // Some triangles of a range, at most four, for they stand in lanes; the first in those left
    // over.
    void place_triangles(std::uint32_t begin, std::uint32_t count, FourTriangles& placed) const;
    [[nodiscard]] std::uint32_t id(const NodeRef& ref) const;

  private:
    const TreeView* tree_;
    Pose pose_;
    bool is_posed_;
    Mat3 matrix_ = Mat3::identity();
    Vec3 offset_{0, 0, 0};
    bool is_moved_ = false;
    // Nodes are in the tree's unit; vertices in mesh units need two factors, as one may overflow.
    double scale_ = 1;
    std::array<double, 2> vertex_scales_{1, 1};
};

} // namespace obb
