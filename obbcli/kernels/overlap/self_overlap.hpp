// Does a closed surface wind about some space more than once?
#pragma once

#include "overlap/column_sums.hpp"
#include "overlap/shadow_pairs.hpp"

#include <cstdint>
#include <optional>

namespace obb {

// With w the winding numbers of a closed surface, the integral of w^2 is that of w_A w_B with the
// surface in both places (see ColumnVolume), and the integral of w is the sum of the columns under
// its own triangles. With w turned so that the latter is positive, the excess w^2 - w is 0 where w
// is 0 or 1 and at least 2 elsewhere: where it is 0, the surface is that of a solid which does not
// overlap itself, and none of its parts is turned the other way.
class SelfOverlap {
  public:
    // Of space along an axis upwards from a box along the axes of the world, mesh units: whatever
    // the axis, the box is part of it. Of all space where there is no box. The tree must outlive
    // the query. Throws std::domain_error where posed coordinates would leave the range of double.
    SelfOverlap(const TreeView& tree, const Pose& pose, const std::optional<Bounds>& within);
    SelfOverlap(const SelfOverlap&) = delete;
    SelfOverlap& operator=(const SelfOverlap&) = delete;

    // As ColumnVolume::advance().
    bool advance(std::uint64_t max_pops);

    // Proven brackets in mesh units to the third power; before the answer is complete, they know
    // but that the excess is not negative.
    //
    // The integral of w: the volume, negative where the surface is turned inward.
    [[nodiscard]] Bracket volume() const;
    // The integral of w^2 - w. The space that the surface winds about neither once nor not at all
    // takes at most half of it.
    [[nodiscard]] Bracket excess() const;
    [[nodiscard]] const WalkCounts& counts() const { return pairs_.counts(); }

  private:
    int exponent_; // of the unit
    ColumnBody body_;
    ColumnFrame frame_;
    ShadowPairs pairs_;
    ColumnSum volume_, square_;
    bool is_complete_ = false;
};

} // namespace obb
