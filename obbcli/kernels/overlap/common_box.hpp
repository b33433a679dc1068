// Where two solids can overlap: the box that branch and bound begins with.
#pragma once

#include "overlap/cell_box.hpp"
#include "overlap/solid_surface.hpp"

#include <optional>

namespace obb {

// A box that holds every point common to both solids, none where their own boxes are apart. Its
// axes are those in which most of the surface near there lies flat or upright: for walls the walls,
// for a pin in a hole its axis.
[[nodiscard]] std::optional<CellBox> common_box(const SolidSurface& a, const SolidSurface& b);

} // namespace obb
