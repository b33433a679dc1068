// Triangles looked at along an axis: their shadows, and how high they stand over a floor.
#pragma once

#include "numbers/vec.hpp"
#include "shapes/triangle.hpp"

#include <array>
#include <cstddef>

namespace obb {

// From here on u and v are the coordinates across the columns and w is the one along them, a cyclic
// permutation of x, y and z, so that it turns nothing over.
[[nodiscard]] inline Vec3 along_axis(Vec3 p, std::size_t axis) {
    return {p[(axis + 1) % 3], p[(axis + 2) % 3], p[axis]};
}

// The part of space in which columns are measured: a rectangle, from the floor upwards. Where it
// ends above does not matter, as nothing that counts is above it.
struct ColumnWindow {
    std::array<double, 2> low, high; // in u and v
    double floor = 0;
    double height = 0;
};

// A triangle as columns see it. Its corners are the posed vertices themselves, in the unit of the
// query, a power of two; heights are rounded once.
struct Shadow {
    std::array<double, 3> u, v; // corners
    std::array<double, 3> h;    // their heights over the floor
    double low_u, high_u, low_v, high_v;
    double low_h, high_h;
    double extent; // width plus breadth of the shadow: no two of its points are further apart
    // The turn of the corners seen from above, which is exact. 0: upright, it has no shadow.
    int sign;
    // Its edges, with the shadow to their left, each from one corner to the next; |u| + |v|.
    std::array<double, 3> along_u, along_v, along_sum;
    double area;    // twice that of the shadow, with its sign, as computed
    double inverse; // 1 / area, or 0
    double reach;   // the largest |h|
};

// The shadow of a triangle whose coordinates are u, v and w.
[[nodiscard]] Shadow shadow_of(const Triangle& corners, double floor);

// Whether shadows have a point in common, by the rectangles around them.
[[nodiscard]] inline bool may_share(const Shadow& a, const Shadow& b) {
    return !(a.low_u > b.high_u) && !(b.low_u > a.high_u) && !(a.low_v > b.high_v) &&
           !(b.low_v > a.high_v);
}
[[nodiscard]] inline bool may_share(const Shadow& a, const ColumnWindow& window) {
    return !(a.low_u > window.high[0]) && !(window.low[0] > a.high_u) &&
           !(a.low_v > window.high[1]) && !(window.low[1] > a.high_v) && !(a.high_h <= 0);
}

} // namespace obb
