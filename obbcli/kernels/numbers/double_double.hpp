// Products and sums of doubles with the rounding error kept: twice the digits where an angle of
// many turns needs them.
#pragma once

namespace obb {

struct DoubleDouble {
    double high, low;
};

// Knuth 1997, TAOCP 2 §4.2.2, Theorem B: exact.
[[nodiscard]] inline DoubleDouble two_sum(double a, double b) {
    const double s = a + b;
    const double t = s - a;
    return {s, (a - (s - t)) + (b - t)};
}

// Dekker 1971: exact while nothing overflows or underflows. std::fma would be a slow call on
// machines without the instruction.
[[nodiscard]] inline DoubleDouble two_product(double a, double b) {
    constexpr double kSplit = 0x1p27 + 1;
    const double p = a * b;
    const double ca = kSplit * a, cb = kSplit * b;
    const double ah = ca - (ca - a), bh = cb - (cb - b);
    const double al = a - ah, bl = b - bh;
    return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

} // namespace obb
