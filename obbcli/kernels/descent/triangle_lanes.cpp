#include "descent/triangle_lanes.hpp"

#include "exact/orientation.hpp"
#include "numbers/lane_moves.hpp"
#include "numbers/lane_vectors.hpp"

namespace obb {
namespace {

// Whether all points are above a plane, or all below, beyond rounding: triple_error() in lanes.
template <typename Real>
OBB_INLINE unsigned on_one_side(const LaneTriangles<Real>& plane, const LaneTriangles<Real>& other,
                                FourSides& sides) {
    const Lanes3<Real> u = difference(plane[1], plane[0]);
    const Lanes3<Real> v = difference(plane[2], plane[0]);
    const Lanes3<Real> normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                              u[0] * v[1] - u[1] * v[0]};
    const Real sizes = absolute_sum(u) * absolute_sum(v);
    const Real factor = Real(kTripleError / 4) * (Real(4.0) * sizes + Real(0x1p-960));
    for (std::size_t k = 0; k < 3; ++k) {
        const Lanes3<Real> w = difference(other[k], plane[0]);
        const Real reach = upper(upper(magnitude(w[0]), magnitude(w[1])), magnitude(w[2]));
        const Real error = factor * reach + Real(0x1p-1000);
        const Real value = inner(normal, w);
        sides.above[k] = bits_of<Real>(value > error);
        sides.below[k] = bits_of<Real>(value < Real{} - error);
    }
    return (sides.above[0] & sides.above[1] & sides.above[2]) |
           (sides.below[0] & sides.below[1] & sides.below[2]);
}

template <std::size_t kBytes>
OBB_INLINE void gather(const FourCorners& corners, std::size_t i, Lanes3<Doubles<kBytes>>& vertex) {
    gather_pairs<kBytes>([&](std::size_t k)
                             __attribute__((always_inline)) { return &corners[k][i]->x; },
                         vertex[0], vertex[1]);
    const std::array<double, 4> z{corners[0][i]->z, corners[1][i]->z, corners[2][i]->z,
                                  corners[3][i]->z};
    vertex[2] = Doubles<kBytes>::at(z.data());
}

template <std::size_t kBytes>
OBB_INLINE unsigned cross(const Triangle& one, const FourTriangles& others, FourSides& sides_one,
                          FourSides& sides_others) {
    using Real = Doubles<kBytes>;
    LaneTriangles<Real> ones, group;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            ones[i][k] = Real(one[i][k]);
            group[i][k] = Real::at(others[i][k].data());
        }
    }
    const unsigned apart =
        on_one_side(ones, group, sides_others) | on_one_side(group, ones, sides_one);
    return ~apart & 0b1111U;
}

} // namespace

void gather_triangles(const FourCorners& corners, FourTriangles& triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            triangles[i][0][k] = corners[k][i]->x;
            triangles[i][1][k] = corners[k][i]->y;
            triangles[i][2][k] = corners[k][i]->z;
        }
    }
}

void pose_triangles(const Pose& pose, const FourCorners& corners, FourTriangles& triangles) {
    in_registers([&]<std::size_t kBytes>() {
        using Real = Doubles<kBytes>;
        for (std::size_t i = 0; i < 3; ++i) {
            Lanes3<Real> p;
            gather<kBytes>(corners, i, p);
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3& row = pose.rotation.rows[k];
                const Real turned = inner(Lanes3<Real>{Real(row.x), Real(row.y), Real(row.z)}, p);
                (turned + Real(pose.translation[k])).store(triangles[i][k].data());
            }
        }
    });
}

unsigned crossing_planes(const Triangle& one, const FourTriangles& others, FourSides& sides_one,
                         FourSides& sides_others) {
    unsigned crossing = 0;
    in_registers([&]<std::size_t kBytes>() {
        crossing = cross<kBytes>(one, others, sides_one, sides_others);
    });
    return crossing;
}

} // namespace obb
