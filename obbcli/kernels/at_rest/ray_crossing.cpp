#include "at_rest/ray_crossing.hpp"

#include "exact/orientation.hpp"
#include "shapes/extremes.hpp"

#include <cstddef>

namespace obb {

namespace {

// The side of the edge from a to b that p is on, seen from above, with p moved by (e, e^2, 0) for
// an infinitely small e: then a ray meets no edge, and edges that two triangles share are passed on
// one side of both (Edelsbrunner and Muecke 1990, Simulation of simplicity). 0 only for edges that
// are parallel to the ray: their triangles it does not meet.
[[nodiscard]] Orientation moved_side(const Vec3& a, const Vec3& b, const Vec3& p) {
    const Orientation found = orientation_xy(a, b, p);
    if (found.sign != 0) {
        return found;
    }
    const int by_x = (b.y < a.y) - (b.y > a.y);
    return {by_x != 0 ? by_x : (b.x > a.x) - (b.x < a.x), found.exact};
}

} // namespace

RayCrossing ray_crossing(const Triangle& t, const Vec3& p, bool is_down) {
    RayCrossing crossing;
    if (p.x < smallest(t[0].x, t[1].x, t[2].x) || p.x > largest(t[0].x, t[1].x, t[2].x) ||
        p.y < smallest(t[0].y, t[1].y, t[2].y) || p.y > largest(t[0].y, t[1].y, t[2].y) ||
        (is_down ? p.z < smallest(t[0].z, t[1].z, t[2].z)
                 : p.z > largest(t[0].z, t[1].z, t[2].z))) {
        return crossing;
    }
    crossing.is_tested = true;
    int turn = 0; // anticlockwise, seen from above
    bool is_met = true;
    for (std::size_t k = 0; k < 3 && is_met; ++k) {
        const Orientation side = moved_side(t[k], t[(k + 1) % 3], p);
        crossing.is_exact = crossing.is_exact || side.exact;
        is_met = side.sign != 0 && (k == 0 || side.sign == turn);
        turn = side.sign;
    }
    if (is_met) {
        // The line meets the triangle, whose plane is not parallel to it, at p moved as at p: and
        // p, which is not on the triangle, is above or below by more than it was moved.
        const Orientation height = orientation(t[0], t[1], t[2], p);
        crossing.is_exact = crossing.is_exact || height.exact;
        crossing.turn =
            is_down ? (height.sign == turn ? -turn : 0) : (height.sign == -turn ? turn : 0);
    }
    return crossing;
}

} // namespace obb
