// On which side? Signs of determinants of points, filtered and exact, for all finite doubles.
#pragma once

#include "numbers/vec.hpp"
#include "shapes/extremes.hpp"

#include <cmath>
#include <cstdint>

namespace obb {

// A triple product of three differences, each rounded once, is off by at most gamma_8 times its
// permanent; 16 u covers the rounding of the bound itself.
inline constexpr double kTripleError = 16 * kUnitRoundoff;

// The error of a triple product (u x v) . w. The product of the sizes is made four times too large
// so that it overflows, and no sign is sure, before any part of the triple product does. What
// underflows loses at most 2^-1074, then multiplied by w: the constants cover that.
[[nodiscard]] inline double triple_error(double sizes_of_u_and_v, double reach_of_w) {
    return kTripleError / 4 * ((4 * sizes_of_u_and_v + 0x1p-960) * reach_of_w) + 0x1p-1000;
}

enum class Sign : std::int8_t { kUnsure, kNegative, kPositive };

// The side of the directed plane through a, b, c that d is on.
[[nodiscard]] inline Sign side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a;
    const Vec3 v = c - a;
    const Vec3 w = d - a;
    const double error = triple_error(norm_1(u) * norm_1(v), largest_coordinate(w));
    const double value = dot(cross(u, v), w);
    return value > error ? Sign::kPositive : value < -error ? Sign::kNegative : Sign::kUnsure;
}

struct Orientation {
    int sign;   // of the determinant: 1, -1 or, where the points lie in a plane or line, 0
    bool exact; // rounding could not decide, big integers did
};

// The sign of ((b - a) x (c - a)) . (d - a): positive where d sees a, b, c turn anticlockwise.
[[nodiscard]] Orientation orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// The same in the plane of x and y: positive where p is to the left of the line from a to b.
[[nodiscard]] Orientation orientation_xy(const Vec3& a, const Vec3& b, const Vec3& p);

} // namespace obb
