// Points on a grid of whole numbers, where the signs that a convex hull asks for are exact.
#pragma once

#include "exact/wide_int.hpp"
#include "numbers/vec.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace obb {

__extension__ using Int128 = __int128;

// Coordinates are whole numbers from 0 to 2^41 held in doubles: differences are exact, a cross
// product's components stay below 2^83 and a triple product below 2^126.
[[nodiscard]] std::vector<Vec3> grid_points(std::span<const Vec3> points);

inline constexpr double kGridReach = 0x1p41;

struct GridVec {
    Int128 x, y, z;
    [[nodiscard]] bool is_zero() const { return x == 0 && y == 0 && z == 0; }
};

[[nodiscard]] inline GridVec exact(Vec3 difference) {
    return {static_cast<std::int64_t>(difference.x), static_cast<std::int64_t>(difference.y),
            static_cast<std::int64_t>(difference.z)};
}

[[nodiscard]] inline GridVec exact_cross(Vec3 a, Vec3 b) {
    const GridVec u = exact(a), v = exact(b);
    return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

// The sign of (u x v) . w.
[[nodiscard]] inline int exact_triple_sign(Vec3 u, Vec3 v, Vec3 w) {
    const GridVec n = exact_cross(u, v), d = exact(w);
    const Int128 triple = n.x * d.x + n.y * d.y + n.z * d.z;
    return triple > 0 ? 1 : triple < 0 ? -1 : 0;
}

// Any strict order that knows coordinates alone.
[[nodiscard]] inline bool comes_before(Vec3 a, Vec3 b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

} // namespace obb
