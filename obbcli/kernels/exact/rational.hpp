// Fractions of wide integers, and their doubles: nearest and next below.
#pragma once

#include "exact/wide_int.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>

namespace obb {

// numerator / denominator, with a positive denominator.
template <std::size_t K>
struct Rational {
    WideInt<K> numerator;
    WideInt<K> denominator = WideInt<K>(1);

    friend constexpr std::strong_ordering operator<=>(const Rational& a, const Rational& b) {
        return a.numerator * b.denominator <=> b.numerator * a.denominator;
    }
};

// Compares a with b * 2^shift, for a, b >= 0.
template <std::size_t K>
[[nodiscard]] constexpr std::strong_ordering compare_shifted(const WideInt<K>& a,
                                                             const WideInt<K>& b, int shift) {
    if (a.is_zero() || b.is_zero()) {
        return a <=> b;
    }
    const int bits_a = static_cast<int>(a.bit_length());
    const int bits_b = static_cast<int>(b.bit_length()) + shift;
    if (bits_a != bits_b) {
        return bits_a <=> bits_b;
    }
    return shift >= 0 ? a <=> (b << static_cast<std::size_t>(shift))
                      : (a << static_cast<std::size_t>(-shift)) <=> b;
}

// Compares the fraction, which is >= 0, with mantissa * 2^exponent.
template <std::size_t K>
[[nodiscard]] constexpr std::strong_ordering compare(const Rational<K>& a, std::int64_t mantissa,
                                                     int exponent) {
    const WideInt<K + 1> product = a.denominator * WideInt<1>(mantissa);
    return compare_shifted(a.numerator.template resized<K + 1>(), product, exponent);
}

// The leading 64 bits of a positive integer, and the exponent that goes with them.
struct Leading {
    std::uint64_t bits;
    int exponent;
};

template <std::size_t K>
[[nodiscard]] constexpr Leading leading(const WideInt<K>& a) {
    std::size_t k = K - 1;
    while (k > 0 && a.limb(k) == 0) {
        --k;
    }
    const auto zeros = std::countl_zero(a.limb(k));
    std::uint64_t bits = a.limb(k) << zeros;
    if (zeros > 0 && k > 0) {
        bits |= a.limb(k - 1) >> (64 - zeros);
    }
    return {bits, static_cast<int>(64 * k) - zeros};
}

struct RoundedRational {
    double nearest; // ties to even
    double below;   // the largest double that is not greater
    double above;   // the smallest double that is not less
};

// The doubles around the fraction times 2^exponent; the fraction is >= 0 and the product in range.
template <std::size_t K>
[[nodiscard]] RoundedRational rounded(const Rational<K>& value, int exponent) {
    if (value.numerator.is_zero()) {
        return {0.0, 0.0, 0.0};
    }
    const Leading n = leading(value.numerator);
    const Leading d = leading(value.denominator);
    // Below the true quotient by a few units of at least 62 bits, so that what is rounded down to
    // 53 bits has them all: the next power of two may lie between.
    const auto quotient = static_cast<std::uint64_t>((Uint128{n.bits} << 63) / d.bits) - 8;
    const int quotient_exponent = n.exponent - d.exponent - 63;
    // Keep 53 bits, or as many as a subnormal has.
    int drop = static_cast<int>(std::bit_width(quotient)) - 53;
    drop = std::max(drop, -1074 - exponent - quotient_exponent);
    std::int64_t mantissa = drop >= 64 ? 0 : static_cast<std::int64_t>(quotient >> drop);
    int unit = quotient_exponent + drop;
    while (compare(value, mantissa + 1, unit) >= 0) {
        ++mantissa;
    }
    while (compare(value, mantissa, unit) < 0) {
        --mantissa;
    }
    if ((mantissa >> 53) != 0) {
        // The quotient was cut to below a power of two that the fraction is not below.
        mantissa >>= 1;
        ++unit;
    }
    const auto half = compare(value, 2 * mantissa + 1, unit - 1);
    const bool up = half > 0 || (half == 0 && mantissa % 2 != 0);
    const auto result = [&](std::int64_t m) {
        return std::ldexp(static_cast<double>(m), unit + exponent);
    };
    const bool is_double = compare(value, mantissa, unit) == 0;
    return {result(mantissa + (up ? 1 : 0)), result(mantissa),
            result(mantissa + (is_double ? 0 : 1))};
}

// The vector divided by some power of two, each component cut to 62 bits of the largest's scale.
template <std::size_t K>
[[nodiscard]] std::array<double, 3> direction(const WideVec<K>& v) {
    const std::array<const WideInt<K>*, 3> components{&v.x, &v.y, &v.z};
    std::size_t bits = 0;
    for (const WideInt<K>* c : components) {
        bits = std::max(bits, c->bit_length());
    }
    std::array<double, 3> result{};
    for (std::size_t k = 0; k < 3; ++k) {
        if (components[k]->is_zero()) {
            continue;
        }
        const bool negative = components[k]->is_negative();
        const Leading head = leading(negative ? -*components[k] : *components[k]);
        const double magnitude =
            std::ldexp(static_cast<double>(head.bits), head.exponent - static_cast<int>(bits));
        result[k] = negative ? -magnitude : magnitude;
    }
    return result;
}

} // namespace obb
