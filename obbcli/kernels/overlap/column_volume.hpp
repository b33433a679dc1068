// How much space two closed posed surfaces have in common.
#pragma once

#include "overlap/column_sums.hpp"
#include "overlap/shadow_pairs.hpp"

#include <cstdint>
#include <optional>

namespace obb {

// Let w be the winding numbers of a closed surface, s the sign of a triangle's normal along an axis
// and h its height. Above a place of the plane across the axis, w is the sum of s over the
// triangles further up. So the integral of w_A w_B over space is the sum, over pairs of a triangle
// of A and one of B, of s_A s_B times the integral of min(h_A, h_B) over the shadow they share;
// upright triangles have none. Every term is continuous in the coordinates: faces that coincide,
// slivers and touching are no special cases, a pair missed or kept by rounding has a term of the
// size of rounding. Heights count from the floor of the space that both extents have in common, and
// places within it: beyond, w_A w_B = 0.
//
// Of solids that do not overlap themselves w is 0 or, with the sign of the surface, 1 or -1: the
// magnitude of the integral is the volume of what both have in common.
//
// Bits of the result do not depend on the order of the bodies, nor on trees but for the root's box.
class ColumnVolume {
  public:
    // The trees must outlive the query. Throws std::domain_error where posed coordinates would
    // leave the range of double.
    ColumnVolume(const TreeView& a, const Pose& pose_a, const TreeView& b, const Pose& pose_b);
    ColumnVolume(const ColumnVolume&) = delete;
    ColumnVolume& operator=(const ColumnVolume&) = delete;

    // Takes at most so many pairs of nodes off the stack, fewer where they take long (see
    // SliceClock); true when the answer is complete.
    bool advance(std::uint64_t max_pops);

    // The magnitude of the integral of w_A w_B, in mesh units to the third power: proven, also
    // before the answer is complete: then, for solids that do not overlap themselves, by the space
    // that their extents have in common.
    [[nodiscard]] Bracket bounds() const;
    // The integral itself, with its sign; everything before the answer is complete.
    [[nodiscard]] Bracket integral() const;
    struct Centroid {
        Vec3 point;   // mesh units
        double error; // proven: the true one is at most so far away
    };
    // The mean place of w_A w_B, once the answer is complete and not 0.
    [[nodiscard]] std::optional<Centroid> centroid() const;
    // The space that both have in common by their extents, in mesh units; no inside, no overlap.
    [[nodiscard]] Bounds window() const;
    [[nodiscard]] const WalkCounts& counts() const { return pairs_.counts(); }

  private:
    int exponent_; // of the unit
    ColumnBody a_, b_;
    Bounds window_;
    ColumnFrame frame_;
    ShadowPairs pairs_;
    ColumnSums sums_;
    bool is_complete_ = false;
};

} // namespace obb
