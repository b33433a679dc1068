// How numbers get into lanes and from one lane into another. Nothing crosses from 16 bytes of a
// register into others, which costs the least where registers are wide and nothing where they are
// not.
#pragma once

#include "numbers/registers.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace obb {

namespace detail {

template <typename Number>
using Sixteen = typename RegisterOf<Number, 16>::Type;
template <typename Number>
inline constexpr std::size_t kInSixteen = 16 / sizeof(Number);

// Lane k of the result is lane places[k] of `a`, or of `b` where that is more than `a` has.
template <int... places, typename Register>
OBB_INLINE Register taken(const Register& a, const Register& b) {
#ifdef __clang__
    return __builtin_shufflevector(a, b, places...);
#else
    using Integer =
        std::conditional_t<sizeof(Register) / sizeof...(places) == 8, std::int64_t, std::int32_t>;
    using Places = typename RegisterOf<Integer, sizeof(Register)>::Type;
    return __builtin_shuffle(a, b, Places{places...});
#endif
}

// The place of a lane within a register of `count` where every 16 bytes are treated alike.
template <int... order>
constexpr int place_of(std::size_t lane, std::size_t count) {
    constexpr std::array<int, sizeof...(order)> places{order...};
    constexpr int kGroup = static_cast<int>(sizeof...(order));
    const int from = places[lane % sizeof...(order)];
    const int start = static_cast<int>(lane) - static_cast<int>(lane) % kGroup;
    return start + from + (from < kGroup ? 0 : static_cast<int>(count) - kGroup);
}

// Registers of 16 bytes or of 32 from their parts of 16, and the other way round.
template <std::size_t kParts, typename Number>
OBB_INLINE auto joined(const std::array<Sixteen<Number>, kParts>& parts) {
    if constexpr (kParts == 1) {
        return parts[0];
    } else {
#if __has_builtin(__builtin_shufflevector)
        return [&]<int... k>(std::integer_sequence<int, k...>) __attribute__((always_inline)) {
            return __builtin_shufflevector(parts[0], parts[1], k...);
        }(std::make_integer_sequence<int, 32 / sizeof(Number)>{});
#else
        return std::bit_cast<typename RegisterOf<Number, 32>::Type>(parts);
#endif
    }
}

} // namespace detail

// Of every 16 bytes, lane k of the result is lane order[k] of `a`, or of `b` for numbers beyond
// what 16 bytes hold.
template <int... order, typename Number, std::size_t kCount, std::size_t kBytes>
OBB_INLINE Lanes<Number, kCount, kBytes> mingled(const Lanes<Number, kCount, kBytes>& a,
                                                 const Lanes<Number, kCount, kBytes>& b) {
    static_assert(sizeof...(order) == detail::kInSixteen<Number>);
    using Result = Lanes<Number, kCount, kBytes>;
    Result result;
    [&]<std::size_t... lane>(std::index_sequence<lane...>) __attribute__((always_inline)) {
        for (std::size_t r = 0; r < Result::kRegisters; ++r) {
            result.parts[r] =
                detail::taken<detail::place_of<order...>(lane, Result::kInRegister)...>(a.parts[r],
                                                                                        b.parts[r]);
        }
    }(std::make_index_sequence<Result::kInRegister>{});
    return result;
}
template <int... order, typename Number, std::size_t kCount, std::size_t kBytes>
OBB_INLINE Lanes<Number, kCount, kBytes> shuffled(const Lanes<Number, kCount, kBytes>& a) {
    return mingled<order...>(a, a);
}

// Every 16 bytes change places with their neighbours: the first with the second, and so on.
template <typename Number, std::size_t kCount, std::size_t kBytes>
OBB_INLINE Lanes<Number, kCount, kBytes> exchanged(const Lanes<Number, kCount, kBytes>& a) {
    using Result = Lanes<Number, kCount, kBytes>;
    Result result;
    [&]<int... lane>(std::integer_sequence<int, lane...>) __attribute__((always_inline)) {
        for (std::size_t r = 0; r < Result::kRegisters; ++r) {
            if constexpr (kBytes == 16) {
                result.parts[r] = a.parts[r ^ 1U];
            } else {
                constexpr int kHalf = static_cast<int>(Result::kInRegister / 2);
                result.parts[r] = detail::taken<(lane ^ kHalf)...>(a.parts[r], a.parts[r]);
            }
        }
    }(std::make_integer_sequence<int, static_cast<int>(Result::kInRegister)>{});
    return result;
}

// Every 16 bytes from a place of their own: place(k) for the k-th.
template <typename Number, std::size_t kCount, std::size_t kBytes, typename Place>
OBB_INLINE Lanes<Number, kCount, kBytes> loaded(const Place& place) {
    using Stored = typename RegisterOf<Number, 16>::Stored;
    using Result = Lanes<Number, kCount, kBytes>;
    constexpr std::size_t kParts = kBytes / 16;
    Result result;
    for (std::size_t r = 0; r < Result::kRegisters; ++r) {
        std::array<detail::Sixteen<Number>, kParts> parts;
        for (std::size_t p = 0; p < kParts; ++p) {
            parts[p] = reinterpret_cast<const Stored*>(place(r * kParts + p))->lanes;
        }
        result.parts[r] = detail::joined<kParts, Number>(parts);
    }
    return result;
}

// Four numbers from each of eight places: the first of all of them, the second of all, and so on.
template <std::size_t kBytes, typename Place>
OBB_INLINE std::array<Floats<kBytes>, 4> gathered_fours(const Place& place) {
    const auto row = [&](std::size_t k) __attribute__((always_inline)) {
        return loaded<float, 8, kBytes>(
            [&](std::size_t g) __attribute__((always_inline)) { return place(k + 4 * g); });
    };
    const auto row0 = row(0), row1 = row(1), row2 = row(2), row3 = row(3);
    const auto low = mingled<0, 4, 1, 5>(row0, row1), high = mingled<2, 6, 3, 7>(row0, row1);
    const auto low_too = mingled<0, 4, 1, 5>(row2, row3),
               high_too = mingled<2, 6, 3, 7>(row2, row3);
    return {mingled<0, 1, 4, 5>(low, low_too), mingled<2, 3, 6, 7>(low, low_too),
            mingled<0, 1, 4, 5>(high, high_too), mingled<2, 3, 6, 7>(high, high_too)};
}
// Two numbers from each of four places.
template <std::size_t kBytes, typename Place>
OBB_INLINE void gather_pairs(const Place& place, Doubles<kBytes>& first, Doubles<kBytes>& second) {
    const auto row = [&](std::size_t k) __attribute__((always_inline)) {
        return loaded<double, 4, kBytes>(
            [&](std::size_t g) __attribute__((always_inline)) { return place(k + 2 * g); });
    };
    const auto row0 = row(0), row1 = row(1);
    first = mingled<0, 2>(row0, row1);
    second = mingled<1, 3>(row0, row1);
}

// Every 16 bytes hold a and b.
template <typename Real>
OBB_INLINE Real alternating(double a, double b) {
    return mingled<0, 2>(Real(a), Real(b));
}

// To the nearest floats, two lanes of `a` before two of `b`.
template <std::size_t kBytes>
OBB_INLINE Floats<kBytes> rounded_pairs(const Doubles<kBytes>& a, const Doubles<kBytes>& b) {
    using Halves = typename RegisterOf<float, kBytes / 2>::Type;
    constexpr std::size_t kPairs = kBytes / 16; // in a register
    Floats<kBytes> result;
    for (std::size_t r = 0; r < Floats<kBytes>::kRegisters; ++r) {
        std::array<detail::Sixteen<float>, kPairs> parts;
        const Halves of_a = __builtin_convertvector(a.parts[r], Halves);
        const Halves of_b = __builtin_convertvector(b.parts[r], Halves);
        if constexpr (kPairs == 2) {
            parts[0] = detail::taken<0, 1, 4, 5>(of_a, of_b);
            parts[1] = detail::taken<2, 3, 6, 7>(of_a, of_b);
        } else {
            parts[0] = detail::Sixteen<float>{of_a[0], of_a[1], of_b[0], of_b[1]};
        }
        result.parts[r] = detail::joined<kPairs, float>(parts);
    }
    return result;
}

// A bit for each lane that is set, of all registers of `Real`.
template <typename Real>
OBB_INLINE unsigned bits_of(const typename Real::Mask& mask) {
    constexpr std::size_t kBytes = sizeof(typename Real::Register);
    unsigned result = 0;
    for (std::size_t r = 0; r < Real::kRegisters; ++r) {
#if defined(__SSE2__) && __has_builtin(__builtin_shufflevector)
        constexpr unsigned kLanes = Real::kInRegister * 16 / kBytes;
        const auto all = reinterpret_cast<typename Real::Register>(mask.parts[r]);
        const auto bits = [](const auto& part) __attribute__((always_inline)) {
            if constexpr (kLanes == 4) {
                return static_cast<unsigned>(__builtin_ia32_movmskps(part));
            } else {
                return static_cast<unsigned>(__builtin_ia32_movmskpd(part));
            }
        };
        unsigned found = 0;
        if constexpr (kBytes == 16) {
            found = bits(all);
        } else if constexpr (kLanes == 4) {
            found = bits(__builtin_shufflevector(all, all, 0, 1, 2, 3)) |
                    bits(__builtin_shufflevector(all, all, 4, 5, 6, 7)) << 4U;
        } else {
            found = bits(__builtin_shufflevector(all, all, 0, 1)) |
                    bits(__builtin_shufflevector(all, all, 2, 3)) << 2U;
        }
        result |= found << (r * Real::kInRegister);
#else
        for (std::size_t k = 0; k < Real::kInRegister; ++k) {
            result |= static_cast<unsigned>(mask.parts[r][k] & 1) << (r * Real::kInRegister + k);
        }
#endif
    }
    return result;
}

} // namespace obb
