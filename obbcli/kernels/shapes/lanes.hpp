// Four doubles treated as one, in registers as wide as the machine has.
#pragma once

#include "numbers/vec.hpp"
#include "shapes/obb.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

// A function is compiled for wider registers as well, and the loader chooses; both give the same
// bits. Its callees are drawn into it, which Clang cannot do together with the choice. Sanitizers
// come too late for it. With OBB_NARROW no register is wider than every machine's, for comparison.
#if !defined(OBB_NARROW) && defined(__x86_64__) && defined(__gnu_linux__) &&                       \
    !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) &&      \
    defined(__has_attribute)
#if __has_attribute(target_clones) && __has_attribute(flatten)
#define OBB_WIDE [[gnu::flatten, gnu::target_clones("avx2", "default")]]
#endif
#endif
#ifndef OBB_WIDE
#define OBB_WIDE
#endif

namespace obb {

// a with its sign flipped where b is negative.
[[nodiscard]] inline Four flipped(Four a, Four b) {
    constexpr std::int64_t kSign = std::numeric_limits<std::int64_t>::min();
    return reinterpret_cast<Four>(
        reinterpret_cast<FourMask>(a) ^
        (reinterpret_cast<FourMask>(b) & FourMask{kSign, kSign, kSign, kSign}));
}
// The lower half, then the upper one.
[[nodiscard]] inline Four halves(double low, double high) { return Four{low, low, high, high}; }
[[nodiscard]] inline Vector3<Four> halves(Vec3 low, Vec3 high) {
    return {halves(low.x, high.x), halves(low.y, high.y), halves(low.z, high.z)};
}
template <int... Order>
[[nodiscard]] inline Vector3<Four> shuffled(const Vector3<Four>& v) {
    return {shuffled<Order...>(v.x), shuffled<Order...>(v.y), shuffled<Order...>(v.z)};
}
template <int... Order>
[[nodiscard]] inline BasicObb<Four> shuffled(const BasicObb<Four>& b) {
    return {shuffled<Order...>(b.center),
            {shuffled<Order...>(b.axes[0]), shuffled<Order...>(b.axes[1]),
             shuffled<Order...>(b.axes[2])},
            shuffled<Order...>(b.half_extents)};
}
template <typename Lanes>
[[nodiscard]] inline Lanes swapped(const Lanes& lanes) {
    return shuffled<2, 3, 0, 1>(lanes);
}
[[nodiscard]] inline Vector3<Four> cross(const Vector3<Four>& a, const Vector3<Four>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline void set_lane(BasicObb<Four>& boxes, std::size_t k, const Obb& box) {
    for (std::size_t i = 0; i < 3; ++i) {
        boxes.center[i][k] = box.center[i];
        boxes.half_extents[i][k] = box.half_extents[i];
        for (std::size_t j = 0; j < 3; ++j) {
            boxes.axes[j][i][k] = box.axes[j][i];
        }
    }
}
[[nodiscard]] inline Vec3 lane(const Vector3<Four>& v, std::size_t k) {
    return {v.x[k], v.y[k], v.z[k]};
}
[[nodiscard]] inline Obb lane(const BasicObb<Four>& boxes, std::size_t k) {
    return {lane(boxes.center, k),
            {lane(boxes.axes[0], k), lane(boxes.axes[1], k), lane(boxes.axes[2], k)},
            lane(boxes.half_extents, k)};
}

} // namespace obb
