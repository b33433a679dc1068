// Powers of two: the only factors that change no digit of a coordinate.
#pragma once

#include "vec.hpp"

#include <cmath>

namespace obb {

// v times 2^exponent, in two factors, since one alone may overflow (subnormal meshes).
[[nodiscard]] inline Vec3 scaled(Vec3 v, int exponent) {
    const double first = std::ldexp(1.0, exponent / 2);
    const double second = std::ldexp(1.0, exponent - exponent / 2);
    return second * (first * v);
}

// The least k with value < 2^k; 0 for zero.
[[nodiscard]] inline int exponent_of(double value) {
    int exponent = 0;
    (void)std::frexp(value, &exponent);
    return exponent;
}

} // namespace obb
