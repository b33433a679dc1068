// Two or four doubles treated as one: every machine in use has registers for two, and compilers
// make do where it has none for four.
#pragma once

#include "numbers/one_lane.hpp"
#include "numbers/vec.hpp"

#include <cmath>
#include <cstdint>

namespace obb {

using Pack = double __attribute__((vector_size(16)));
using PackMask = std::int64_t __attribute__((vector_size(16))); // all bits or none a lane

using Four = double __attribute__((vector_size(32)));
using FourMask = std::int64_t __attribute__((vector_size(32))); // all bits or none a lane

// GCC takes packs of four for aligned to their size only where registers are as wide: a function
// that is compiled for these would trip over what others laid out.
template <>
inline constexpr std::size_t kAlignment<Four> = sizeof(Four);

// The same kernels run on doubles and on packs through these few.
[[nodiscard]] inline double absolute(double a) { return std::fabs(a); }
[[nodiscard]] inline Pack absolute(Pack a) {
    constexpr std::int64_t kAllButSign = 0x7fffffffffffffff;
    return reinterpret_cast<Pack>(reinterpret_cast<PackMask>(a) &
                                  PackMask{kAllButSign, kAllButSign});
}
[[nodiscard]] inline Four absolute(Four a) {
    constexpr std::int64_t kAll = 0x7fffffffffffffff; // but the sign
    return reinterpret_cast<Four>(reinterpret_cast<FourMask>(a) & FourMask{kAll, kAll, kAll, kAll});
}
[[nodiscard]] inline bool is_all(bool mask) { return mask; }
[[nodiscard]] inline bool is_all(PackMask mask) { return (mask[0] & mask[1]) != 0; }

[[nodiscard]] inline bool is_all(FourMask mask) {
    return (mask[0] & mask[1] & mask[2] & mask[3]) != 0;
}

[[nodiscard]] inline bool is_none(bool mask) { return !mask; }
[[nodiscard]] inline bool is_none(PackMask mask) { return (mask[0] | mask[1]) == 0; }
// A bit for each lane that is set.
[[nodiscard]] inline unsigned bits_of(FourMask mask) {
    const FourMask bits = mask & FourMask{1, 2, 4, 8};
    return static_cast<unsigned>((bits[0] | bits[1]) | (bits[2] | bits[3]));
}
[[nodiscard]] inline bool is_none(FourMask mask) {
    return (mask[0] | mask[1] | mask[2] | mask[3]) == 0;
}

[[nodiscard]] inline double square_root(double a) { return std::sqrt(a); }
[[nodiscard]] inline Pack square_root(Pack a) { return Pack{std::sqrt(a[0]), std::sqrt(a[1])}; }
[[nodiscard]] inline Four square_root(Four a) {
    return Four{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}
[[nodiscard]] inline Pack select(PackMask mask, Pack a, Pack b) { return mask ? a : b; }
[[nodiscard]] inline Four select(FourMask mask, Four a, Four b) { return mask ? a : b; }
// Lane k of the result is lane Order[k] of `a`. Each compiler has a name of its own for it.
template <int... Order>
[[nodiscard]] inline Four shuffled(Four a) {
#ifdef __clang__
    return __builtin_shufflevector(a, a, Order...);
#else
    return __builtin_shuffle(a, FourMask{Order...});
#endif
}
template <typename Real>
[[nodiscard]] inline Real maximum(Real a, Real b) {
    return select(a > b, a, b);
}
[[nodiscard]] inline double every(double a, double) { return a; }
[[nodiscard]] inline Pack every(double a, Pack) { return Pack{a, a}; }
[[nodiscard]] inline Four every(double a, Four) { return Four{a, a, a, a}; }

[[nodiscard]] inline Vector3<Pack> packed(Vec3 a, Vec3 b) {
    return {Pack{a.x, b.x}, Pack{a.y, b.y}, Pack{a.z, b.z}};
}

template <typename Real>
[[nodiscard]] inline Real absolute_sum(Vector3<Real> a) {
    return absolute(a.x) + absolute(a.y) + absolute(a.z);
}

} // namespace obb
