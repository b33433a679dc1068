// Functions that bound how deep a point lies in two solids, kept for many cells.
#pragma once

#include "overlap/cell_box.hpp"
#include "overlap/matrix_game.hpp"
#include "overlap/solid_surface.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace obb {

// At every point of the cell it was made for that lies in both solids, the distance from the nearer
// surface is at most the row's value. Convex in the point.
struct BoundRow {
    NodeRef triangle{};   // whose distance it is; of an escape row, where its direction comes from
    Vec3 normal{0, 0, 0}; // of the triangle, of length 1; of an escape row, the way up
    double height = 0;    // of an escape row
    Vec3 slope{0, 0, 0};  // of an escape row: of what is highest over the cell, across the way up
    std::uint8_t body = 0;
    bool is_escape = false;

    // At the corners of a cell; the triangle, in the frame, is of use to triangle rows only.
    void values(const CellBox::Corners& corners, const Triangle& t,
                MatrixGame::Values& values) const;
};

// Rows that several cells hold: each is kept as long as one does.
class RowStore {
  public:
    [[nodiscard]] std::uint32_t add(const BoundRow& row); // held once
    void hold(std::uint32_t id) { ++rows_[id].holders; }
    void drop(std::uint32_t id);
    [[nodiscard]] const BoundRow& operator[](std::uint32_t id) const { return rows_[id].row; }
    [[nodiscard]] std::size_t size() const { return rows_.size() - free_.size(); }

  private:
    struct Kept {
        BoundRow row;
        std::uint32_t holders;
    };
    std::vector<Kept> rows_;
    std::vector<std::uint32_t> free_;
};

} // namespace obb
