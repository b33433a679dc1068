// Several numbers treated as one, for passes over many triangles. How many there are is up to the
// pass, how many fit a register up to the machine: every lane is computed as one number would be,
// so that results do not depend on the machine.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

// Calls that hand wide registers over by value would depend on the machine they were compiled for:
// all of this becomes part of the function for one machine that uses it.
#define OBB_INLINE __attribute__((always_inline)) inline

// A pass is written once, as a template over the width of registers in bytes. Every machine has
// registers of 16 bytes; wider ones are used where the processor at hand has them. Neither fuses
// multiplications and additions.
#if !defined(OBB_NARROW) && defined(__x86_64__) && defined(__GNUC__)
#define OBB_WIDE_REGISTERS __attribute__((target("avx2"), flatten))
#define OBB_HAS_WIDE 1
#else
#define OBB_WIDE_REGISTERS
#define OBB_HAS_WIDE 0
#endif

namespace obb {

inline constexpr std::size_t kNarrow = 16;
inline constexpr std::size_t kWide = OBB_HAS_WIDE ? 32 : 16;

[[nodiscard]] inline bool has_wide_registers() {
#if OBB_HAS_WIDE
    return __builtin_cpu_supports("avx2") != 0;
#else
    return false;
#endif
}

// Runs a pass with the widest registers there are: a lambda templated over their width.
template <typename Pass>
OBB_WIDE_REGISTERS void in_wide_registers(const Pass& pass) {
    pass.template operator()<kWide>();
}
template <typename Pass>
inline void in_registers(const Pass& pass) {
    if (has_wide_registers()) {
        in_wide_registers(pass);
    } else {
        pass.template operator()<kNarrow>();
    }
}

// A loop that is none any more, for what is to stay in registers.
template <std::size_t kTimes, typename Step>
OBB_INLINE void unrolled(const Step& step) {
    [&]<std::size_t... k>(std::index_sequence<k...>) __attribute__((always_inline)) {
        (step(std::integral_constant<std::size_t, k>{}), ...);
    }(std::make_index_sequence<kTimes>{});
}

template <typename Number, std::size_t kBytes>
struct RegisterOf;
#define OBB_REGISTER(number, integer, bytes)                                                       \
    template <>                                                                                    \
    struct RegisterOf<number, bytes> {                                                             \
        using Type = number __attribute__((vector_size(bytes)));                                   \
        using Mask = integer __attribute__((vector_size(bytes)));                                  \
        struct __attribute__((packed, may_alias)) Stored {                                         \
            Type lanes;                                                                            \
        };                                                                                         \
    };
OBB_REGISTER(double, std::int64_t, 16)
OBB_REGISTER(float, std::int32_t, 16)
OBB_REGISTER(double, std::int64_t, 32)
OBB_REGISTER(float, std::int32_t, 32)
OBB_REGISTER(float, std::int32_t, 8)         // what two doubles become
OBB_REGISTER(std::int64_t, std::int64_t, 16) // places, for shuffles
OBB_REGISTER(std::int32_t, std::int32_t, 16)
OBB_REGISTER(std::int64_t, std::int64_t, 32)
OBB_REGISTER(std::int32_t, std::int32_t, 32)
#undef OBB_REGISTER

template <typename Number, std::size_t kCount_, std::size_t kBytes>
struct Lanes {
    using Register = typename RegisterOf<Number, kBytes>::Type;
    using RegisterMask = typename RegisterOf<Number, kBytes>::Mask;
    using Stored = typename RegisterOf<Number, kBytes>::Stored; // anywhere in an array
    static constexpr std::size_t kCount = kCount_;
    static constexpr std::size_t kRegisters = kCount * sizeof(Number) / kBytes;
    static constexpr std::size_t kInRegister = kBytes / sizeof(Number);
    static constexpr auto kAllButSign = std::numeric_limits<
        std::conditional_t<sizeof(Number) == 8, std::int64_t, std::int32_t>>::max();

    Register parts[kRegisters]{};

    // True or false a lane.
    struct Mask {
        RegisterMask parts[kRegisters]{};

        friend OBB_INLINE Mask operator&(Mask a, const Mask& b) {
            for (std::size_t r = 0; r < kRegisters; ++r) {
                a.parts[r] &= b.parts[r];
            }
            return a;
        }
        friend OBB_INLINE Mask operator|(Mask a, const Mask& b) {
            for (std::size_t r = 0; r < kRegisters; ++r) {
                a.parts[r] |= b.parts[r];
            }
            return a;
        }
        [[nodiscard]] OBB_INLINE bool operator[](std::size_t lane) const {
            return parts[lane / kInRegister][lane % kInRegister] != 0;
        }
        [[nodiscard]] OBB_INLINE bool is_any() const {
            RegisterMask all = parts[0];
            for (std::size_t r = 1; r < kRegisters; ++r) {
                all |= parts[r];
            }
            bool any = false;
            for (std::size_t lane = 0; lane < kInRegister; ++lane) {
                any = any || all[lane] != 0;
            }
            return any;
        }
    };

    Lanes() = default;
    OBB_INLINE Lanes(Number value) { // NOLINT: numbers are lanes that are all alike
        for (Register& part : parts) {
            part = Register{} + value;
        }
    }
    static OBB_INLINE Lanes at(const Number* from) {
        Lanes lanes;
        for (std::size_t r = 0; r < kRegisters; ++r) {
            lanes.parts[r] = reinterpret_cast<const Stored*>(from + r * kInRegister)->lanes;
        }
        return lanes;
    }
    // 1 in the first lanes, 0 in the others.
    static OBB_INLINE Lanes first(std::size_t count) {
        static constexpr std::array<Number, 2 * kCount> kOnes = [] {
            std::array<Number, 2 * kCount> ones{};
            for (std::size_t k = 0; k < kCount; ++k) {
                ones[k] = 1;
            }
            return ones;
        }();
        return at(kOnes.data() + (count < kCount ? kCount - count : 0));
    }
    OBB_INLINE void store(Number* to) const {
        for (std::size_t r = 0; r < kRegisters; ++r) {
            reinterpret_cast<Stored*>(to + r * kInRegister)->lanes = parts[r];
        }
    }

    [[nodiscard]] OBB_INLINE Number operator[](std::size_t lane) const {
        return parts[lane / kInRegister][lane % kInRegister];
    }
    OBB_INLINE void set(std::size_t lane, Number value) {
        parts[lane / kInRegister][lane % kInRegister] = value;
    }

#define OBB_OPERATOR(op)                                                                           \
    friend OBB_INLINE Lanes operator op(const Lanes& a, const Lanes& b) {                          \
        Lanes result;                                                                              \
        for (std::size_t r = 0; r < kRegisters; ++r) {                                             \
            result.parts[r] = a.parts[r] op b.parts[r];                                            \
        }                                                                                          \
        return result;                                                                             \
    }                                                                                              \
    OBB_INLINE Lanes& operator op## = (const Lanes& b) { return *this = *this op b; }
    OBB_OPERATOR(+)
    OBB_OPERATOR(-)
    OBB_OPERATOR(*)
    OBB_OPERATOR(/)
#undef OBB_OPERATOR
#define OBB_COMPARISON(op)                                                                         \
    friend OBB_INLINE Mask operator op(const Lanes& a, const Lanes& b) {                           \
        Mask result;                                                                               \
        for (std::size_t r = 0; r < kRegisters; ++r) {                                             \
            result.parts[r] = a.parts[r] op b.parts[r];                                            \
        }                                                                                          \
        return result;                                                                             \
    }
    OBB_COMPARISON(<)
    OBB_COMPARISON(>)
    OBB_COMPARISON(<=)
    OBB_COMPARISON(>=)
#undef OBB_COMPARISON

    friend OBB_INLINE Lanes select(const Mask& mask, const Lanes& a, const Lanes& b) {
        Lanes result;
        for (std::size_t r = 0; r < kRegisters; ++r) {
            result.parts[r] = mask.parts[r] ? a.parts[r] : b.parts[r];
        }
        return result;
    }
    friend OBB_INLINE Lanes lower(const Lanes& a, const Lanes& b) { return select(a < b, a, b); }
    friend OBB_INLINE Lanes upper(const Lanes& a, const Lanes& b) { return select(a > b, a, b); }
    friend OBB_INLINE Lanes magnitude(const Lanes& a) {
        Lanes result;
        for (std::size_t r = 0; r < kRegisters; ++r) {
            const RegisterMask bits = reinterpret_cast<RegisterMask>(a.parts[r]);
            result.parts[r] = reinterpret_cast<Register>(bits & (RegisterMask{} + kAllButSign));
        }
        return result;
    }
    // a with its sign flipped where b is negative.
    friend OBB_INLINE Lanes flipped(const Lanes& a, const Lanes& b) {
        Lanes result;
        for (std::size_t r = 0; r < kRegisters; ++r) {
            const RegisterMask sign =
                reinterpret_cast<RegisterMask>(b.parts[r]) & ~(RegisterMask{} + kAllButSign);
            result.parts[r] =
                reinterpret_cast<Register>(reinterpret_cast<RegisterMask>(a.parts[r]) ^ sign);
        }
        return result;
    }
    friend OBB_INLINE Lanes root_of(const Lanes& a) {
        Lanes result;
        for (std::size_t r = 0; r < kRegisters; ++r) {
            for (std::size_t k = 0; k < kInRegister; ++k) {
                result.parts[r][k] = std::sqrt(a.parts[r][k]);
            }
        }
        return result;
    }
    // In the same order on every machine.
    friend OBB_INLINE double sum_of(const Lanes& a) {
        std::array<double, kCount> all;
        for (std::size_t k = 0; k < kCount; ++k) {
            all[k] = a[k];
        }
        for (std::size_t width = kCount / 2; width > 0; width /= 2) {
            for (std::size_t k = 0; k < width; ++k) {
                all[k] += all[k + width];
            }
        }
        return all[0];
    }
    friend OBB_INLINE Number lowest_of(const Lanes& a) {
        Number least = a[0];
        for (std::size_t k = 1; k < kCount; ++k) {
            least = a[k] < least ? a[k] : least;
        }
        return least;
    }
    friend OBB_INLINE Number highest_of(const Lanes& a) {
        Number most = a[0];
        for (std::size_t k = 1; k < kCount; ++k) {
            most = a[k] > most ? a[k] : most;
        }
        return most;
    }
};

// As many as the passes treat at once.
template <std::size_t kBytes>
using Doubles = Lanes<double, 4, kBytes>;
template <std::size_t kBytes>
using Floats = Lanes<float, 8, kBytes>;
inline constexpr std::uint32_t kDoubles = Doubles<kNarrow>::kCount;
inline constexpr std::uint32_t kFloats = Floats<kNarrow>::kCount;

// Corner by corner, coordinate by coordinate.
template <typename Reals>
using LaneTriangles = std::array<std::array<Reals, 3>, 3>;

} // namespace obb
