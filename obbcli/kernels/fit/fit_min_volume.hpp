// Orientation of the box of least volume. Eberly 2008 §6.1.1.
#pragma once

#include "numbers/vec.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace obb {

// How far the search goes.
struct MinVolumeEffort {
    std::size_t searched_vertices; // of a hull with more, those farthest out are searched
    std::size_t shortlisted;       // so many of the boxes found are judged by the whole hull
    bool refines;                  // whether those are turned on until nothing near is smaller
};

// Axes of a box of small volume about the points, right-handed. In place of the paper's general
// minimisation: a side of the least box lies on a facet of the hull or two rest on edges, but for
// one case (O'Rourke 1985; Jylanki 2015). So every facet's normal and the common normal of every
// two opposite edges is tried as an axis, with the least rectangle about the shadow along it. The
// axes of hull_axes() and those of the coordinates are tried too, so that no box of theirs is
// smaller. Refining covers the case left out: it tries the axes across any three edges near the
// sides of a good box, and the rectangles along its axes. A planar set gets its least rectangle.
//
// What judges is the hull's 4,096 vertices farthest out.
[[nodiscard]] std::array<Vec3, 3> min_volume_axes(std::span<const Vec3> points,
                                                  const MinVolumeEffort& effort);

} // namespace obb
