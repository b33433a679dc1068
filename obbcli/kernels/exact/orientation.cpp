#include "exact/orientation.hpp"

#include "exact/exact_shape.hpp"

#include <array>

namespace obb {

Orientation orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    if (const Sign sure = side(a, b, c, d); sure != Sign::kUnsure) {
        return {sure == Sign::kPositive ? 1 : -1, false};
    }
    DigitRange digits;
    for (const Vec3& p : {a, b, c, d}) {
        digits.include(p);
    }
    const int sign = with_width(digits.bits(), [&](auto width) {
        constexpr std::size_t kWidth = decltype(width)::value;
        const auto origin = to_wide<kWidth>(a, digits.low);
        const auto from_a = [&](const Vec3& p) { return to_wide<kWidth>(p, digits.low) - origin; };
        return dot(cross(from_a(b), from_a(c)), from_a(d)).sign();
    });
    return {sign, true};
}

// Each product is off by 3 u, their difference by another u. Differences that overflow make the
// bound infinite, and products that underflow lose 2^-1074.
Orientation orientation_xy(const Vec3& a, const Vec3& b, const Vec3& p) {
    const double left = (b.x - a.x) * (p.y - a.y);
    const double right = (b.y - a.y) * (p.x - a.x);
    const double error = 8 * kUnitRoundoff * (std::fabs(left) + std::fabs(right)) + 0x1p-1000;
    if (const double value = left - right; std::fabs(value) > error) {
        return {value > 0 ? 1 : -1, false};
    }
    DigitRange digits;
    for (const double value : {a.x, a.y, b.x, b.y, p.x, p.y}) {
        digits.include(to_dyadic(value));
    }
    const int sign = with_width(digits.bits(), [&](auto width) {
        constexpr std::size_t kWidth = decltype(width)::value;
        const auto wide = [&](double value) { return to_wide<kWidth>(value, digits.low); };
        const auto ax = wide(a.x), ay = wide(a.y);
        return ((wide(b.x) - ax) * (wide(p.y) - ay) - (wide(b.y) - ay) * (wide(p.x) - ax)).sign();
    });
    return {sign, true};
}

} // namespace obb
