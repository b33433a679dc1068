#include "in_motion/intersection_proof.hpp"

#include <array>
#include <vector>

namespace obb {

namespace {

// The side of the plane through a, b, c that d is on: +1 or -1, or 0 where an error of `e` in each
// point, or rounding, leaves it open. A triple product of differences that are off by 2 e each is
// off by 2 e times the sum of the products of their pairs, and higher orders that the factor
// covers.
int sure_side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double e) {
    const Vec3 u = b - a, v = c - a, w = d - a;
    const double nu = norm_1(u) + 2 * e, nv = norm_1(v) + 2 * e, nw = norm_1(w) + 2 * e;
    const double error =
        4 * e * (nu * nv + nv * nw + nw * nu) + 32 * kUnitRoundoff * nu * nv * nw + 0x1p-900;
    const double value = dot(cross(u, v), w);
    return value > error ? 1 : value < -error ? -1 : 0;
}

bool surely_pierces(const Vec3& p, const Vec3& q, const Triangle& t, double e) {
    const int above = sure_side(t[0], t[1], t[2], p, e);
    if (above == 0 || sure_side(t[0], t[1], t[2], q, e) != -above) {
        return false;
    }
    // The line passes all three edges on one side.
    const int turn = sure_side(p, q, t[0], t[1], e);
    return turn != 0 && sure_side(p, q, t[1], t[2], e) == turn &&
           sure_side(p, q, t[2], t[0], e) == turn;
}

// Whether a triangle of the patch has an edge in this direction.
bool has_edge(std::span<const Triangle> patch, const Vec3& from, const Vec3& to) {
    for (const Triangle& t : patch) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (t[k] == from && t[(k + 1) % 3] == to) {
                return true;
            }
        }
    }
    return false;
}

// The line passes all edges of the patch's border on one side: seen along it, the border winds
// around it, and no surface with such a border avoids it. It meets a triangle of the patch, and
// each has the ends on both sides of its plane: in between.
bool surely_pierces(const Vec3& p, const Vec3& q, std::span<const Triangle> all, double e) {
    std::vector<Triangle> patch;
    for (const Triangle& t : all) {
        const int above = sure_side(t[0], t[1], t[2], p, e);
        if (above != 0 && sure_side(t[0], t[1], t[2], q, e) == -above) {
            patch.push_back(t);
        }
    }
    int turn = 0;
    for (const Triangle& t : patch) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 &from = t[k], &to = t[(k + 1) % 3];
            if (has_edge(patch, to, from)) {
                continue;
            }
            const int side = sure_side(p, q, from, to, e);
            if (side == 0 || (turn != 0 && side != turn)) {
                return false;
            }
            turn = side;
        }
    }
    return turn != 0;
}

} // namespace

bool surely_intersects_patch(const Triangle& a, std::span<const Triangle> patch, double error) {
    return surely_pierces(a[0], a[1], patch, error) || surely_pierces(a[1], a[2], patch, error) ||
           surely_pierces(a[2], a[0], patch, error);
}

// Triangles that overlap by more than the error show an edge of one that surely pierces the other.
bool surely_intersect(const Triangle& a, const Triangle& b, double error) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (surely_pierces(a[k], a[(k + 1) % 3], b, error) ||
            surely_pierces(b[k], b[(k + 1) % 3], a, error)) {
            return true;
        }
    }
    return false;
}

} // namespace obb
