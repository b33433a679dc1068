// Least and greatest of a few doubles without branches or library calls, for numbers that are not
// NaN: std::fmax is a call on x86-64, and std::max of a list goes through memory.
#pragma once

#include "numbers/vec.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

namespace obb {

[[nodiscard]] constexpr double smaller(double a, double b) { return b < a ? b : a; }
[[nodiscard]] constexpr double larger(double a, double b) { return a < b ? b : a; }
[[nodiscard]] constexpr double smallest(double a, double b, double c) {
    return smaller(smaller(a, b), c);
}
[[nodiscard]] constexpr double largest(double a, double b, double c) {
    return larger(larger(a, b), c);
}

// The largest magnitude of a coordinate or length.
[[nodiscard]] inline double largest_coordinate(const Vec3& v) { return norm_inf(v); }
[[nodiscard]] inline double largest_coordinate(const Triangle& t) {
    return largest(largest_coordinate(t[0]), largest_coordinate(t[1]), largest_coordinate(t[2]));
}
[[nodiscard]] inline double largest_coordinate(const Obb& box) {
    return larger(largest_coordinate(box.center), largest_coordinate(box.half_extents));
}

} // namespace obb
