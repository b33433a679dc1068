// A bound on how deep points of a cell lie in a solid that is linear in the point: who goes
// straight along a direction is out of the solid after at most so much.
#pragma once

#include "overlap/height_gaps.hpp"
#include "overlap/winding_number.hpp"
#include "shapes/extremes.hpp"

#include <array>
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

// Whoever goes straight along `up` from any point of the cell, or back, meets the surface between
// these heights: on whichever side of it the point is, it is no further away than reach().
struct CrossingRow {
    Vec3 up;
    double low, high;

    [[nodiscard]] double reach(const Vec3& p) const {
        const double height = dot(up, p);
        return larger(high - height, height - low);
    }
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

    // A triangle that the row found last is as high as, or lower by no more than it is rounded.
    [[nodiscard]] NodeRef under(const EscapeRow& row) const { return heights_.under(row.height); }

    // The best row along a direction for the convex cell of these corners, none for a direction of
    // no length. A row for a cell holds for every cell within it. Shadows are tightest where `side`
    // is an edge of the cell that is not along `up`; any vector will do.
    [[nodiscard]] std::optional<EscapeRow> find(std::span<const Vec3> corners, const Vec3& up,
                                                const Vec3& side, const RowEffort& effort);

    // The same for points on either side of the surface. `useful` counts from the cell both ways.
    [[nodiscard]] std::optional<CrossingRow> find_crossing(std::span<const Vec3> corners,
                                                           const Vec3& up, const Vec3& side,
                                                           const RowEffort& effort);

    [[nodiscard]] std::uint64_t rays() const { return windings_.rays(); }

  private:
    [[nodiscard]] bool set_shadow(std::span<const Vec3> corners, const Vec3& up, const Vec3& side);
    [[nodiscard]] std::optional<Winding> winding_in(const HeightGap& gap);

    // Of the present cell: its shadow and its range of heights.
    Prism prism_;
    std::array<double, 2> middle_{0, 0};
    double bottom_ = 0, top_ = 0;

    HeightSearch heights_;
    WindingSearch windings_;
};

} // namespace obb
