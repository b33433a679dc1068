// Two's complement integers of a fixed number of 64-bit limbs, on the stack: the exact arithmetic
// behind every verdict that rounding cannot decide.
#pragma once

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>

namespace obb {

__extension__ using Uint128 = unsigned __int128;

// Sums and products are exact as long as they fit; callers choose the width from a bit count.
template <std::size_t Limbs>
class WideInt {
  public:
    static constexpr std::size_t kBits = 64 * Limbs;

    constexpr WideInt() = default;
    constexpr explicit WideInt(std::int64_t value) {
        limbs_.fill(value < 0 ? ~std::uint64_t{0} : 0);
        limbs_[0] = static_cast<std::uint64_t>(value);
    }
    constexpr explicit WideInt(const std::array<std::uint64_t, Limbs>& limbs) : limbs_(limbs) {}

    // value * 2^shift; a negative shift may only drop zero bits.
    [[nodiscard]] static constexpr WideInt from(std::int64_t value, int shift) {
        if (shift < 0) {
            return WideInt(value >> (shift < -63 ? 63 : -shift));
        }
        return WideInt(value) << static_cast<std::size_t>(shift);
    }

    [[nodiscard]] constexpr std::uint64_t limb(std::size_t k) const { return limbs_[k]; }
    constexpr void set_limb(std::size_t k, std::uint64_t value) { limbs_[k] = value; }

    [[nodiscard]] constexpr bool is_negative() const { return (limbs_[Limbs - 1] >> 63) != 0; }
    [[nodiscard]] constexpr bool is_zero() const {
        std::uint64_t any = 0;
        for (const std::uint64_t limb : limbs_) {
            any |= limb;
        }
        return any == 0;
    }
    [[nodiscard]] constexpr int sign() const { return is_negative() ? -1 : is_zero() ? 0 : 1; }

    // The same value in another width, which must hold it.
    template <std::size_t Other>
    [[nodiscard]] constexpr WideInt<Other> resized() const {
        WideInt<Other> result(is_negative() ? -1 : 0);
        for (std::size_t k = 0; k < (Other < Limbs ? Other : Limbs); ++k) {
            result.set_limb(k, limbs_[k]);
        }
        return result;
    }

    // Number of bits of the absolute value.
    [[nodiscard]] constexpr std::size_t bit_length() const {
        const WideInt magnitude = is_negative() ? -*this : *this;
        for (std::size_t k = Limbs; k-- > 0;) {
            if (magnitude.limbs_[k] != 0) {
                return 64 * k + static_cast<std::size_t>(std::bit_width(magnitude.limbs_[k]));
            }
        }
        return 0;
    }

    friend constexpr WideInt operator+(const WideInt& a, const WideInt& b) {
        WideInt sum;
        std::uint64_t carry = 0;
        for (std::size_t k = 0; k < Limbs; ++k) {
            const Uint128 term = Uint128{a.limbs_[k]} + b.limbs_[k] + carry;
            sum.limbs_[k] = static_cast<std::uint64_t>(term);
            carry = static_cast<std::uint64_t>(term >> 64);
        }
        return sum;
    }
    friend constexpr WideInt operator-(const WideInt& a, const WideInt& b) {
        WideInt difference;
        std::uint64_t borrow = 0;
        for (std::size_t k = 0; k < Limbs; ++k) {
            const Uint128 term = Uint128{a.limbs_[k]} - b.limbs_[k] - borrow;
            difference.limbs_[k] = static_cast<std::uint64_t>(term);
            borrow = static_cast<std::uint64_t>(term >> 64) & 1;
        }
        return difference;
    }
    friend constexpr WideInt operator-(const WideInt& a) { return WideInt{} - a; }

    friend constexpr WideInt operator<<(const WideInt& a, std::size_t shift) {
        const std::size_t limbs = shift / 64;
        const std::size_t bits = shift % 64;
        WideInt result;
        for (std::size_t k = limbs; k < Limbs; ++k) {
            result.limbs_[k] = a.limbs_[k - limbs] << bits;
            if (bits != 0 && k > limbs) {
                result.limbs_[k] |= a.limbs_[k - limbs - 1] >> (64 - bits);
            }
        }
        return result;
    }

    friend constexpr bool operator==(const WideInt&, const WideInt&) = default;
    friend constexpr std::strong_ordering operator<=>(const WideInt& a, const WideInt& b) {
        if (a.is_negative() != b.is_negative()) {
            return a.is_negative() ? std::strong_ordering::less : std::strong_ordering::greater;
        }
        for (std::size_t k = Limbs; k-- > 0;) {
            if (a.limbs_[k] != b.limbs_[k]) {
                return a.limbs_[k] <=> b.limbs_[k];
            }
        }
        return std::strong_ordering::equal;
    }

  private:
    std::array<std::uint64_t, Limbs> limbs_{};
};

namespace detail {

// Subtracts b * 2^(64 Low), where `wanted`, from as many limbs.
template <std::size_t Low, std::size_t M, std::size_t Limbs>
constexpr void subtract_high(std::array<std::uint64_t, Limbs>& from, const WideInt<M>& b,
                             bool wanted) {
    const std::uint64_t mask = wanted ? ~std::uint64_t{0} : 0;
    std::uint64_t borrow = 0;
    for (std::size_t k = 0; k < M; ++k) {
        const Uint128 term = Uint128{from[Low + k]} - (b.limb(k) & mask) - borrow;
        from[Low + k] = static_cast<std::uint64_t>(term);
        borrow = static_cast<std::uint64_t>(term >> 64) & 1;
    }
}

} // namespace detail

// The whole product, which always fits.
template <std::size_t N, std::size_t M>
[[nodiscard]] constexpr WideInt<N + M> operator*(const WideInt<N>& a, const WideInt<M>& b) {
    std::array<std::uint64_t, N + M> product{};
    for (std::size_t i = 0; i < N; ++i) {
        std::uint64_t carry = 0;
        for (std::size_t j = 0; j < M; ++j) {
            const Uint128 term = Uint128{a.limb(i)} * b.limb(j) + product[i + j] + carry;
            product[i + j] = static_cast<std::uint64_t>(term);
            carry = static_cast<std::uint64_t>(term >> 64);
        }
        product[i + M] = carry;
    }
    // Read as unsigned, a negative factor is 2^(64 * its limbs) too large.
    detail::subtract_high<N>(product, b, a.is_negative());
    detail::subtract_high<M>(product, a, b.is_negative());
    return WideInt<N + M>(product);
}

template <std::size_t N>
struct WideVec {
    WideInt<N> x, y, z;

    [[nodiscard]] constexpr bool is_zero() const {
        return x.is_zero() && y.is_zero() && z.is_zero();
    }
    friend constexpr WideVec operator-(const WideVec& a, const WideVec& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend constexpr bool operator==(const WideVec&, const WideVec&) = default;
};

template <std::size_t N, std::size_t M>
[[nodiscard]] constexpr WideInt<N + M> dot(const WideVec<N>& a, const WideVec<M>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <std::size_t N, std::size_t M>
[[nodiscard]] constexpr WideVec<N + M> cross(const WideVec<N>& a, const WideVec<M>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A double is mantissa * 2^exponent with an odd mantissa, or zero.
struct Dyadic {
    std::int64_t mantissa = 0;
    int exponent = 0;

    [[nodiscard]] constexpr int top() const {
        const auto magnitude = static_cast<std::uint64_t>(mantissa < 0 ? -mantissa : mantissa);
        return exponent + static_cast<int>(std::bit_width(magnitude));
    }
};

[[nodiscard]] constexpr Dyadic to_dyadic(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const auto biased = static_cast<int>((bits >> 52) & 0x7ff);
    const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52) - 1);
    const std::uint64_t magnitude = biased == 0 ? fraction : fraction | (std::uint64_t{1} << 52);
    if (magnitude == 0) {
        return {};
    }
    const int zeros = std::countr_zero(magnitude);
    const auto odd = static_cast<std::int64_t>(magnitude >> zeros);
    return {(bits >> 63) != 0 ? -odd : odd, (biased == 0 ? 1 : biased) - 1075 + zeros};
}

} // namespace obb
