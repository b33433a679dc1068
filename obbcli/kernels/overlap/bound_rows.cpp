#include "overlap/bound_rows.hpp"

#include "overlap/point_triangle.hpp"

namespace obb {

void BoundRow::values(const CellBox::Corners& corners, const Triangle& t,
                      MatrixGame::Values& values) const {
    if (!is_escape) {
        distances_from(t, corners, values);
        return;
    }
    for (std::size_t k = 0; k < corners.size(); ++k) {
        values[k] = height - dot(normal, corners[k]);
    }
}

std::uint32_t RowStore::add(const BoundRow& row) {
    if (free_.empty()) {
        rows_.push_back({row, 1});
        return static_cast<std::uint32_t>(rows_.size() - 1);
    }
    const std::uint32_t id = free_.back();
    free_.pop_back();
    rows_[id] = {row, 1};
    return id;
}

void RowStore::drop(std::uint32_t id) {
    if (--rows_[id].holders == 0) {
        free_.push_back(id);
    }
}

} // namespace obb
