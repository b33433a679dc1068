// The direction in which a triangle faces, for choosing directions to look along.
#pragma once

#include "numbers/vec.hpp"
#include "shapes/triangle.hpp"

#include <array>
#include <cstddef>

namespace obb {

// Of length 1 to rounding, 0 for a triangle of no area. From the two shorter edges: of a needle the
// others cancel. It only chooses directions, and no bound rests on it. Coordinates of an overlap
// query's frame are at most 1, so that it scales nothing, unlike unit_normal() of
// shapes/scaled_shapes.hpp.
[[nodiscard]] inline Vec3 unit_normal(const Triangle& t) {
    const std::array<Vec3, 3> e{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k) {
        longest = dot(e[k], e[k]) > dot(e[longest], e[longest]) ? k : longest;
    }
    return unit_or(
        cross(unit_or(e[(longest + 1) % 3], {0, 0, 0}), unit_or(e[(longest + 2) % 3], {0, 0, 0})),
        {0, 0, 0});
}

} // namespace obb
