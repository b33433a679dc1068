// An oriented box taken literally: { center + sum_i y_i axes[i] : |y_i| <= half_extents[i] }.
#pragma once

#include "numbers/vec.hpp"

#include <array>

namespace obb {

struct Obb {
    Vec3 center;
    std::array<Vec3, 3> axes;
    Vec3 half_extents;
};

} // namespace obb
