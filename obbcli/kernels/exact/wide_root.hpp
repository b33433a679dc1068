// Square roots of wide integers, between two integers times a power of two.
#pragma once

#include "exact/wide_int.hpp"

#include <cstddef>
#include <cstdint>

namespace obb {

// The root is `low` * 2^exponent, or between that and (low + 1) * 2^exponent. `low` has 126 or 127
// bits.
struct WideRoot {
    WideInt<2> low;
    int exponent;
    bool is_exact;
};

// a / 2^shift rounded down, for a >= 0 of at most 64 Result bits beyond the shift; a negative shift
// multiplies.
template <std::size_t Result, std::size_t K>
[[nodiscard]] constexpr WideInt<Result> shifted_down(const WideInt<K>& a, int shift) {
    if (shift <= 0) {
        return a.template resized<Result>() << static_cast<std::size_t>(-shift);
    }
    const auto first = static_cast<std::size_t>(shift) / 64;
    const auto bits = static_cast<std::size_t>(shift) % 64;
    const auto limb = [&](std::size_t k) { return k < K ? a.limb(k) : 0; };
    WideInt<Result> result;
    for (std::size_t k = 0; k < Result; ++k) {
        const std::uint64_t low = limb(first + k) >> bits;
        result.set_limb(k, bits == 0 ? low : low | limb(first + k + 1) << (64 - bits));
    }
    return result;
}

// For a > 0. Digit by digit from the leading 253 or 254 bits.
template <std::size_t K>
[[nodiscard]] constexpr WideRoot root_of(const WideInt<K>& a) {
    const int bits = static_cast<int>(a.bit_length());
    const int shift = bits % 2 == 0 ? bits - 254 : bits - 253;
    const WideInt<4> head = shifted_down<4>(a, shift);
    WideInt<2> root;
    for (std::size_t bit = 127; bit-- > 0;) {
        WideInt<2> larger = root;
        larger.set_limb(bit / 64, larger.limb(bit / 64) | std::uint64_t{1} << (bit % 64));
        root = larger * larger <= head ? larger : root;
    }
    const bool is_whole =
        shift <= 0 || (head.template resized<K + 4>() << static_cast<std::size_t>(shift)) ==
                          a.template resized<K + 4>();
    return {root, shift / 2, is_whole && root * root == head};
}

} // namespace obb
