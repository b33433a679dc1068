// The parts of a surface that hang together.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace obb {

// One triangle of each part, the first of it, in order. Triangles hang together where they share a
// corner; corners are numbers of positions, from 0 to below `position_count`.
[[nodiscard]] std::vector<std::int64_t>
first_triangles_of_parts(std::span<const std::array<std::int64_t, 3>> corners,
                         std::int64_t position_count);

} // namespace obb
