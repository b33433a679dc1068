// A number of twice the digits of double, with the operators that a kernel written for double uses.
#pragma once

#include "numbers/double_double.hpp"
#include "numbers/one_lane.hpp"

#include <cmath>

namespace obb {

// high + low with |low| at most half a unit in the last place of high. Every operation below is off
// by less than 2^-100 of its result, unless something overflows or underflows.
// Joldes, Muller and Popescu 2017, Tight and rigorous error bounds for basic building blocks of
// double-word arithmetic: 3 u^2 for sums, 7 u^2 for products, 15 u^2 for quotients, u^2 = 2^-106.
struct Twofold {
    double high = 0;
    double low = 0;

    constexpr Twofold() = default;
    constexpr Twofold(double value) : high(value) {} // NOLINT: as implicit as int to double
    constexpr Twofold(double h, double l) : high(h), low(l) {}
    explicit Twofold(const DoubleDouble& d) : high(d.high), low(d.low) {}

    friend Twofold operator+(const Twofold& a, const Twofold& b) {
        const DoubleDouble s = two_sum(a.high, b.high);
        const DoubleDouble t = two_sum(a.low, b.low);
        const Twofold v = normalized(s.high, s.low + t.high);
        return normalized(v.high, t.low + v.low);
    }
    friend Twofold operator-(const Twofold& a) { return {-a.high, -a.low}; }
    friend Twofold operator-(const Twofold& a, const Twofold& b) { return a + -b; }
    friend Twofold operator*(const Twofold& a, const Twofold& b) {
        const DoubleDouble p = two_product(a.high, b.high);
        return normalized(p.high, p.low + (a.high * b.low + a.low * b.high));
    }
    friend Twofold operator/(const Twofold& a, const Twofold& b) {
        const double first = a.high / b.high;
        const Twofold rest = a - b * Twofold(first);
        const double second = rest.high / b.high;
        const Twofold last = rest - b * Twofold(second);
        return normalized(first, second) + Twofold(last.high / b.high);
    }
    friend bool operator<(const Twofold& a, const Twofold& b) {
        return a.high < b.high || (a.high == b.high && a.low < b.low);
    }
    friend bool operator>(const Twofold& a, const Twofold& b) { return b < a; }
    friend bool operator<=(const Twofold& a, const Twofold& b) { return !(b < a); }
    friend bool operator>=(const Twofold& a, const Twofold& b) { return !(a < b); }

  private:
    // Dekker 1971: exact where |high| >= |low|.
    static Twofold normalized(double high, double low) {
        const double s = high + low;
        return {s, low - (s - high)};
    }
};

// One step of Newton's method from the double root: the error is squared.
[[nodiscard]] inline Twofold root_of(const Twofold& a) {
    if (!(a.high > 0)) {
        return {};
    }
    const double x = std::sqrt(a.high);
    const Twofold rest = a - Twofold(two_product(x, x));
    return Twofold(x) + Twofold(rest.high / (2 * x));
}

// The nearest double.
[[nodiscard]] inline double rounded(const Twofold& a) { return a.high; }
[[nodiscard]] inline double rounded(double a) { return a; }

// What an operation may be off by, relative to its result.
template <typename Real>
inline constexpr double kRoundoff = 0x1p-100;
template <>
inline constexpr double kRoundoff<double> = 0x1p-53;

} // namespace obb
