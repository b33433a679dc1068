// Shapes brought to a size at which nothing overflows or underflows, for what is only as good as
// rounding: places and directions.
#pragma once

#include "numbers/vec.hpp"
#include "shapes/extremes.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace obb {

// Power of two that brings the largest magnitude below one.
[[nodiscard]] inline int exponent_of(double magnitude) {
    int exponent = 0;
    std::frexp(magnitude, &exponent);
    return magnitude == 0 ? 0 : exponent;
}

[[nodiscard]] inline Vec3 scaled(const Vec3& v, int exponent) {
    return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

[[nodiscard]] inline Vec3 origin_of(const Triangle& t) { return t[0]; }
[[nodiscard]] inline Vec3 origin_of(const Obb& box) { return box.center; }

// The shape scaled, relative to an origin that was scaled already, then moved.
[[nodiscard]] inline Triangle placed(const Triangle& t, const Vec3& origin, const Vec3& way,
                                     int exponent) {
    return {(scaled(t[0], exponent) - origin) + way, (scaled(t[1], exponent) - origin) + way,
            (scaled(t[2], exponent) - origin) + way};
}
[[nodiscard]] inline Obb placed(const Obb& box, const Vec3& origin, const Vec3& way, int exponent) {
    return {(scaled(box.center, exponent) - origin) + way, box.axes,
            scaled(box.half_extents, exponent)};
}

// The direction of a vector. A power of two scales it, which rounds nothing: shapes in any unit
// have the same directions, bit for bit.
[[nodiscard]] inline Vec3 unit_by_powers(const Vec3& v, const Vec3& otherwise) {
    const double size = largest_coordinate(v);
    if (!(size > 0)) {
        return otherwise;
    }
    const Vec3 w = scaled(v, -exponent_of(size));
    return (1 / norm(w)) * w;
}

// From the two shorter edges: of a needle the others cancel.
[[nodiscard]] inline Vec3 unit_normal(const Triangle& t, const Vec3& otherwise) {
    const std::array<Vec3, 3> e{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k) {
        longest = dot(e[k], e[k]) > dot(e[longest], e[longest]) ? k : longest;
    }
    const Vec3& u = e[(longest + 1) % 3];
    const Vec3& v = e[(longest + 2) % 3];
    return unit_by_powers(cross(scaled(u, -exponent_of(largest_coordinate(u))),
                                scaled(v, -exponent_of(largest_coordinate(v)))),
                          otherwise);
}

} // namespace obb
