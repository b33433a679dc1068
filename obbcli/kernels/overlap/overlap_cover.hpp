// Boxes that hold all space which two closed solids have in common, none larger than wanted.
#pragma once

#include "overlap/cell_box.hpp"
#include "overlap/solid_surface.hpp"
#include "overlap/triangles_in_box.hpp"
#include "overlap/winding_number.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace obb {

// The common box is halved again and again. A part is left out where it is proven to lie outside a
// solid: no triangle of that solid meets it, and one of its points is outside. Where few triangles
// do, a part is cut down: what lies beyond all of them along a direction is outside where one of
// its points is; and it is left out where along one direction all of A comes before all of B.
//
// At any moment the boxes kept and those that wait hold all of what both solids share, but for what
// is flat: two solids may touch where there is no box.
class OverlapCover {
  public:
    // The surfaces must outlive it. Boxes are no longer than `size`, in the frame's unit.
    OverlapCover(const SolidSurface& a, const SolidSurface& b, double size);

    // Looks at one box, if one waits; false when none did.
    bool look_at_one();

    struct Cell {
        Vec3 low, high;      // in the axes of the common box
        std::uint8_t inside; // a bit for each solid that holds all of it
    };
    [[nodiscard]] const std::vector<Cell>& kept() const { return kept_; }
    [[nodiscard]] const std::vector<Cell>& waiting() const { return stack_; }
    [[nodiscard]] const std::array<Vec3, 3>& axes() const { return axes_; }

  private:
    // A triangle within a box: a polygon, in the axes of the common box.
    struct Patch {
        static constexpr std::size_t kMost = 12;
        std::array<Vec3, kMost> corners;
        std::size_t count = 0;
        Vec3 normal; // of the triangle, of any length
    };
    enum class Place : std::uint8_t { kUnknown, kInside, kOutside };

    struct Probe {
        const SolidSurface* surface;
        BoxSearch boxes;
        WindingSearch windings;
        std::vector<NodeRef> found{};
        std::vector<Patch> patches{}; // of the present box
        bool are_all = false;         // whether these are all of the body's in it
    };

    [[nodiscard]] CellBox box_of(const Cell& cell) const { return {axes_, cell.low, cell.high}; }
    [[nodiscard]] bool is_outside(Cell& cell);
    void find_patches(const Cell& cell, Probe& probe);
    [[nodiscard]] Patch clipped(const Triangle& triangle, const Cell& cell) const;
    [[nodiscard]] Place place_of(Probe& probe, const Vec3& local, double room);
    [[nodiscard]] bool cut_down(Cell& cell, Probe& probe);
    [[nodiscard]] bool are_parted(const Cell& cell);
    [[nodiscard]] bool are_parted_along(const Cell& cell, const Vec3& direction);
    [[nodiscard]] bool ends_at(const Cell& cell, Probe& probe, const Vec3& direction, double end);
    void split(const Cell& cell, std::size_t axis);

    std::array<Vec3, 3> axes_;
    std::array<Probe, 2> probes_;
    double size_;
    std::vector<Cell> stack_, kept_;
};

} // namespace obb
