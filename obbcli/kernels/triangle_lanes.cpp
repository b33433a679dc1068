#include "triangle_lanes.hpp"

#include "orientation.hpp"

namespace obb {
namespace {

[[nodiscard]] Four reach(const Vector3<Four>& v) {
    return maximum(maximum(absolute(v.x), absolute(v.y)), absolute(v.z));
}

[[nodiscard]] Vector3<Four> broadcast(const Vec3& v) {
    return {every(v.x, Four{}), every(v.y, Four{}), every(v.z, Four{})};
}

// Whether all points are above a plane, or all below, beyond rounding: triple_error() in lanes.
[[nodiscard]] FourMask on_one_side(const FourTriangles& plane, const FourTriangles& other) {
    const Vector3<Four> u = plane[1] - plane[0];
    const Vector3<Four> v = plane[2] - plane[0];
    const Vector3<Four> normal = cross(u, v);
    const Four sizes = absolute_sum(u) * absolute_sum(v);
    const Four factor = (kTripleError / 4) * (4.0 * sizes + 0x1p-960);
    FourMask above{-1, -1, -1, -1}, below{-1, -1, -1, -1};
    for (const Vector3<Four>& p : other) {
        const Vector3<Four> w = p - plane[0];
        const Four error = factor * reach(w) + 0x1p-1000;
        const Four value = dot(normal, w);
        above &= value > error;
        below &= value < -error;
    }
    return above | below;
}

} // namespace

OBB_WIDE unsigned crossing_planes(const Triangle& one, const FourTriangles& others) {
    const FourTriangles ones{broadcast(one[0]), broadcast(one[1]), broadcast(one[2])};
    const FourMask apart = on_one_side(ones, others) | on_one_side(others, ones);
    unsigned crossing = 0;
    for (unsigned k = 0; k < 4; ++k) {
        crossing |= static_cast<unsigned>(apart[k] == 0) << k;
    }
    return crossing;
}

} // namespace obb
