// Triangles in doubles, stored coordinate by coordinate, some of them at a time.
#pragma once

#include "numbers/registers.hpp"
#include "numbers/vec.hpp"

#include <cstddef>

namespace obb {

// The first of the nine coordinates stands at `first`, the others `stride` apart; relative to a
// point.
template <std::size_t kBytes>
OBB_INLINE LaneTriangles<Doubles<kBytes>> triangles_at(const double* first, std::size_t stride,
                                                       Vec3 origin) {
    LaneTriangles<Doubles<kBytes>> t;
    unrolled<9>(
        [&](auto k) { t[k / 3][k % 3] = Doubles<kBytes>::at(first + k * stride) - origin[k % 3]; });
    return t;
}

} // namespace obb
