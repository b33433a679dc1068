// Does any of some points lie inside a closed posed surface?
#pragma once

#include "at_rest/static_query.hpp"
#include "shapes/pose.hpp"
#include "tree/tree.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace obb {

// Counts, with signs, where the ray from each point towards +z passes through the surface: the
// winding number (Jacobson, Kavan and Sorkine-Hornung 2013, section 3). Inside is where it is not
// zero. Exact for the posed vertices, rounded to double: boxes rule out what rays miss with every
// rounding counted, signs of determinants decide the rest.
//
// Edges must be run through as often in either direction, and no point may lie on the surface.
// Advanced by so many pops at a time, as StaticQuery is.
class ContainmentQuery {
  public:
    // The tree must outlive the query; its posed coordinates must be in the range of double.
    ContainmentQuery(const TreeView& tree, const Pose& pose, std::vector<Vec3> points);

    // Takes at most so many nodes off the stack; true when the answer is complete.
    bool advance(std::uint64_t max_pops);

    // The number of the first point inside, of those asked about so far.
    [[nodiscard]] std::optional<std::size_t> inside() const { return inside_; }
    [[nodiscard]] const WalkCounts& counts() const { return counts_; }

  private:
    void begin_point();
    void visit();
    [[nodiscard]] bool may_meet(const Node& node) const;
    void count(const Triangle& triangle);

    PosedTree body_;
    std::vector<Vec3> points_;
    std::size_t point_ = 0;      // the one asked about
    Vec3 scaled_point_{};        // in the unit of the boxes
    std::int64_t winding_ = 0;   // of the triangles so far
    int exponent_ = 0;           // of that unit
    std::vector<NodeRef> stack_; // nodes that the present ray may meet; a leaf's triangles to come
    std::optional<std::size_t> inside_;
    WalkCounts counts_;
};

} // namespace obb
