// Powers of two: the only factors that change no digit of a coordinate.
#pragma once

#include "numbers/vec.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace obb {

// 2^exponent, without a call where it is a normal number.
[[nodiscard]] inline double power_of_two(int exponent) {
    constexpr int kBias = 1023, kFractionBits = 52;
    if (exponent <= -kBias || exponent > kBias) {
        return std::ldexp(1.0, exponent);
    }
    return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + kBias) << kFractionBits);
}

// v times 2^exponent, in two factors, since one alone may overflow (subnormal meshes).
[[nodiscard]] inline Vec3 scaled(Vec3 v, int exponent) {
    const double first = power_of_two(exponent / 2);
    const double second = power_of_two(exponent - exponent / 2);
    return second * (first * v);
}

// The least k with |value| < 2^k; 0 for zero. Without a call where the value is a normal number.
[[nodiscard]] inline int exponent_of(double value) {
    constexpr std::uint64_t kBias = 1022, kMost = 0x7ff;
    const std::uint64_t biased = std::bit_cast<std::uint64_t>(value) >> 52U & kMost;
    if (biased != 0 && biased != kMost) {
        return static_cast<int>(biased) - static_cast<int>(kBias);
    }
    int exponent = 0;
    (void)std::frexp(value, &exponent);
    return exponent;
}

} // namespace obb
