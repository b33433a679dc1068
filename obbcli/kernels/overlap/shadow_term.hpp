// What two triangles add to the volume that two solids share.
#pragma once

#include "overlap/shadow.hpp"

#include <array>

namespace obb {

// The integral of max(0, min(h_a, h_b)) over the shadow that two triangles share, in the window,
// times the signs of both; its first moments from the window's low corner and the floor.
struct ShadowTerm {
    double volume = 0;
    std::array<double, 3> moments{0, 0, 0}; // u, v and w
    // Proven: the volume is off by at most this, and each moment by at most twice this times the
    // window's size that way.
    double error = 0;
};

// The same bits for (b, a).
[[nodiscard]] ShadowTerm term_of(const Shadow& a, const Shadow& b, const ColumnWindow& window);

} // namespace obb
