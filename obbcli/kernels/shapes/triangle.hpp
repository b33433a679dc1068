// A triangle by its three vertices; points and segments are triangles with repeated or collinear
// ones.
#pragma once

#include "numbers/vec.hpp"

#include <array>

namespace obb {

using Triangle = std::array<Vec3, 3>;

} // namespace obb
