// A posed tree for those who look along an axis: boxes and triangles in world coordinates.
#pragma once

#include "descent/posed_tree.hpp"
#include "numbers/vec.hpp"
#include "shapes/pose.hpp"
#include "shapes/triangle.hpp"
#include "tree/tree.hpp"

#include <cstdint>

namespace obb {

// A box along the axes of the world.
struct Bounds {
    Vec3 low, high;
};

// Lengths are in the query's unit: mesh units times 2^-exponent. Triangles are the posed vertices,
// rounded to double, times that power of two.
class ColumnBody {
  public:
    // The tree must outlive the body; no coordinate or translation may exceed 2^exponent.
    ColumnBody(const TreeView& tree, const Pose& pose, int exponent);

    // The exponent of a unit that serves a posed tree. Throws std::domain_error where posed
    // coordinates would leave the range of double.
    [[nodiscard]] static int exponent_for(const TreeView& tree, const Pose& pose);

    [[nodiscard]] const TreeView& tree() const { return body_.tree(); }
    [[nodiscard]] Triangle triangle(std::uint32_t position) const;

    // Holds all triangles under a node, which has to be there; tight where that is one triangle.
    [[nodiscard]] Bounds around(const NodeRef& ref) const;
    // Holds all triangles of the body, and is tight unless that takes too many looks.
    [[nodiscard]] Bounds extent() const;

  private:
    PosedTree body_;
    int exponent_;
};

// Of a node of more than one triangle, the two parts of its range: its children, or the halves of a
// leaf, which have the leaf's box.
[[nodiscard]] std::array<NodeRef, 2> parts_of(const TreeView& tree, const NodeRef& ref);

} // namespace obb
