#include "descent/triangle_lanes.hpp"

#include "exact/orientation.hpp"

namespace obb {
namespace {

[[nodiscard]] Four largest_coordinate(const Vector3<Four>& v) {
    return maximum(maximum(absolute(v.x), absolute(v.y)), absolute(v.z));
}

[[nodiscard]] Vector3<Four> broadcast(const Vec3& v) {
    return {every(v.x, Four{}), every(v.y, Four{}), every(v.z, Four{})};
}

// Whether all points are above a plane, or all below, beyond rounding: triple_error() in lanes.
[[nodiscard]] FourMask on_one_side(const FourTriangles& plane, const FourTriangles& other,
                                   FourSides& sides) {
    const Vector3<Four> u = plane[1] - plane[0];
    const Vector3<Four> v = plane[2] - plane[0];
    const Vector3<Four> normal = cross(u, v);
    const Four sizes = absolute_sum(u) * absolute_sum(v);
    const Four factor = (kTripleError / 4) * (4.0 * sizes + 0x1p-960);
    for (std::size_t k = 0; k < 3; ++k) {
        const Vector3<Four> w = other[k] - plane[0];
        const Four error = factor * largest_coordinate(w) + 0x1p-1000;
        const Four value = dot(normal, w);
        sides.above[k] = value > error;
        sides.below[k] = value < -error;
    }
    return (sides.above[0] & sides.above[1] & sides.above[2]) |
           (sides.below[0] & sides.below[1] & sides.below[2]);
}

[[gnu::always_inline]] inline Vector3<Four> gathered(const FourCorners& corners, std::size_t i) {
    const Vec3 &p = *corners[0][i], &q = *corners[1][i], &r = *corners[2][i], &s = *corners[3][i];
    return {Four{p.x, q.x, r.x, s.x}, Four{p.y, q.y, r.y, s.y}, Four{p.z, q.z, r.z, s.z}};
}

} // namespace

OBB_WIDE void gather_triangles(const FourCorners& corners, FourTriangles& triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
        triangles[i] = gathered(corners, i);
    }
}

OBB_WIDE void pose_triangles(const Pose& pose, const FourCorners& corners,
                             FourTriangles& triangles) {
    const auto& rows = pose.rotation.rows;
    const std::array<Vector3<Four>, 3> q{broadcast(rows[0]), broadcast(rows[1]),
                                         broadcast(rows[2])};
    const Vector3<Four> shift = broadcast(pose.translation);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector3<Four> p = gathered(corners, i);
        triangles[i] = Vector3<Four>{dot(q[0], p), dot(q[1], p), dot(q[2], p)} + shift;
    }
}

OBB_WIDE unsigned crossing_planes(const Triangle& one, const FourTriangles& others,
                                  FourSides& sides_one, FourSides& sides_others) {
    const FourTriangles ones{broadcast(one[0]), broadcast(one[1]), broadcast(one[2])};
    const FourMask apart =
        on_one_side(ones, others, sides_others) | on_one_side(others, ones, sides_one);
    return bits_of(~apart);
}

} // namespace obb
