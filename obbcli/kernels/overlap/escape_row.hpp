// A bound on how deep points of a cell lie in a solid that is linear in the point: who goes
// straight along a direction is out of the solid after at most so much.
#pragma once

#include "overlap/height_gaps.hpp"
#include "overlap/winding_number.hpp"

#include <optional>
#include <span>

namespace obb {

// For every point p of the cell that lies in the solid, its distance from the solid's surface is at
// most `height` - up . p, computed as reach(). Where that is negative the point is outside. All
// rounding is in the height already, but for that of the point p itself.
struct EscapeRow {
    Vec3 up;
    double height;

    [[nodiscard]] double reach(const Vec3& p) const { return height - dot(up, p); }
};

// What a row may cost.
struct RowEffort {
    double thin;            // boxes at most so high stand for what they hold
    std::size_t most = 256; // boxes to look at
    double useful;          // rows that say no less than this for the lowest corner are of no use
};

class EscapeSearch {
  public:
    // The surface must outlive it.
    explicit EscapeSearch(const SolidSurface& surface) : heights_(surface), windings_(surface) {}

    // The best row along a direction for the convex cell of these corners, none for a direction of
    // no length. A row for a cell holds for every cell within it. Shadows are tightest where `side`
    // is an edge of the cell that is not along `up`; any vector will do.
    [[nodiscard]] std::optional<EscapeRow> find(std::span<const Vec3> corners, const Vec3& up,
                                                const Vec3& side, const RowEffort& effort);

    [[nodiscard]] std::uint64_t rays() const { return windings_.rays(); }

  private:
    [[nodiscard]] bool is_outside(const Prism& prism, const HeightGap& gap);

    HeightSearch heights_;
    WindingSearch windings_;
};

} // namespace obb
