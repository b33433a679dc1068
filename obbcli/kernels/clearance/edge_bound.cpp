#include "clearance/edge_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace obb {

namespace {

constexpr double kNothing = -1;
constexpr double kUp = 1 + 0x1p-20; // over the rounding of bounds that add up a few lengths

// Lengths of a vector and its derivatives anywhere in the interval.
struct Lengths {
    double value, first, second, third;
};

[[nodiscard]] Lengths lengths_of(const MovingPoint& p, double third, double h) {
    const double d0 = norm(p.z), d1 = norm(p.z1), d2 = norm(p.z2);
    return {kUp * (d0 + h * (d1 + h / 2 * (d2 + h / 3 * third))),
            kUp * (d1 + h * (d2 + h / 2 * third)), kUp * (d2 + h * third), kUp * third};
}

// The least of f0 + f1 s + f2 s^2 / 2 - third |s|^3 / 6 for |s| <= h.
[[nodiscard]] double least_of(double f0, double f1, double f2, double third, double h) {
    const double slope = std::fabs(f1);
    const double bend = kUp * third * h * h * h / 6;
    return (f2 > 0 && slope < f2 * h ? f0 - slope * slope / (2 * f2)
                                     : f0 - slope * h + 0.5 * f2 * h * h) -
           bend;
}

} // namespace

double bound_edges(const RelativeMotion& motion, double half, const EdgedTriangle& x,
                   const EdgedTriangle& y) {
    const double h = half;
    const MovingPoint edge = motion.direction(y.edge);
    const double length = (1 + 0x1p-40) * norm(y.edge);
    const double edge_jerk = motion.turning_jerk(length, motion.axis_radius(y.edge, length));
    MovingPoint normal{cross(x.edge, edge.z), cross(x.edge, edge.z1), cross(x.edge, edge.z2)};
    const double start = norm(normal.z);
    const double scale = norm(x.edge) * length; // what products of the edges are rounded by
    if (!(start > 0x1p-30 * scale) || !(scale > 0x1p-300)) {
        return kNothing; // parallel, or no edges
    }
    Vec3 n0 = (1 / start) * normal.z;
    if (dot(n0, motion.between() + y.corners[0] - x.corners[0]) < 0) {
        n0 = -n0;
        normal = {-normal.z, -normal.z1, -normal.z2};
    }
    std::array<MovingPoint, 3> corners;
    double gap = HUGE_VAL, sizes = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = motion.point(y.corners[k]);
        sizes = std::max(sizes, norm_1(motion.between()) + norm_1(y.corners[k]) +
                                    h * norm_1(corners[k].z1));
    }
    for (const Vec3& p : x.corners) {
        sizes = std::max(sizes, norm_1(p));
        for (const MovingPoint& q : corners) {
            gap = std::min(gap, dot(n0, q.z - p));
        }
    }
    if (!(gap > 0)) {
        return kNothing;
    }
    const double normal_jerk = (1 + 0x1p-40) * norm(x.edge) * edge_jerk;
    const Lengths n = lengths_of(normal, normal_jerk, h);
    const double along = start - h * (std::fabs(dot(n0, normal.z1)) +
                                      h / 2 * (std::fabs(dot(n0, normal.z2)) + h / 3 * n.third));
    const double least = (1 - 0x1p-20) * along - 0x1p-45 * scale; // of N . n0, and of |N|
    if (!(least > 0.25 * start)) {
        return kNothing; // N turns by too much
    }
    const double across = h * (norm(normal.z1) + h / 2 * (norm(normal.z2) + h / 3 * n.third));
    const double slant = kUp * across + 0x1p-48 * scale;
    const double excess = kUp * slant * slant / (2 * least) + 0x1p-50 * n.value;

    double lowest = HUGE_VAL;
    for (std::size_t k = 0; k < 3; ++k) {
        const double radius = (1 + 0x1p-40) * norm(y.corners[k]);
        const double jerk = motion.jerk(radius, motion.axis_radius(y.corners[k], radius), h);
        for (const Vec3& p : x.corners) {
            const MovingPoint w{corners[k].z - p - gap * n0, corners[k].z1, corners[k].z2};
            const Lengths l = lengths_of(w, jerk, h);
            // Leibniz: the third derivative of N . w.
            const double third = n.third * l.value + 3 * n.second * l.first +
                                 3 * n.first * l.second + n.value * l.third;
            lowest = std::min(
                lowest,
                least_of(dot(normal.z, w.z), dot(normal.z1, w.z) + dot(normal.z, w.z1),
                         dot(normal.z2, w.z) + 2 * dot(normal.z1, w.z1) + dot(normal.z, w.z2),
                         third, h));
        }
    }
    // Each of f's terms is a product of N, of which the rounding is a share of `scale`, and of a
    // place: about 30 operations on what is at most four times the sizes.
    const double rounding = 0x1p-45 * scale * (sizes + gap);
    const double rest = lowest - gap * excess - rounding;
    const double low = gap + rest / (rest < 0 ? least : n.value);
    return low - 0x1p-48 * (sizes + gap);
}

} // namespace obb
