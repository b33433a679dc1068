#include "predicates.hpp"

#include "exact_shape.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace obb {
namespace {

// A triple product of three differences, each rounded once, is off by at most gamma_8 times its
// permanent; 16 u covers the rounding of the bound itself. Products that underflow lose at most
// 2^-1074 each, then multiplied by at most 2^101 (kLargest): kTiny covers them.
constexpr double kTripleError = 16 * kUnitRoundoff;
constexpr double kLargest = 0x1p100;
constexpr double kTiny = 0x1p-900;

enum class Sign : std::int8_t { kUnsure, kNegative, kPositive };

[[nodiscard]] Sign sign_beyond(double value, double error) {
    return value > error ? Sign::kPositive : value < -error ? Sign::kNegative : Sign::kUnsure;
}

// The side of the directed plane through a, b, c that d is on.
[[nodiscard]] Sign side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a;
    const Vec3 v = c - a;
    const Vec3 w = d - a;
    const double error = kTripleError * norm_1(u) * norm_1(v) * norm_inf(w) + kTiny;
    return sign_beyond(dot(cross(u, v), w), error);
}

[[nodiscard]] std::array<Sign, 3> sides(const Triangle& plane, const Triangle& other) {
    const Vec3 u = plane[1] - plane[0];
    const Vec3 v = plane[2] - plane[0];
    const Vec3 normal = cross(u, v);
    const double error = kTripleError * norm_1(u) * norm_1(v);
    std::array<Sign, 3> result{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 w = other[k] - plane[0];
        result[k] = sign_beyond(dot(normal, w), error * norm_inf(w) + kTiny);
    }
    return result;
}

[[nodiscard]] bool all_same(const std::array<Sign, 3>& s) { return s[0] == s[1] && s[0] == s[2]; }

// Of three sure signs that are not all the same, the index of the one that stands alone.
[[nodiscard]] std::size_t lone(const std::array<Sign, 3>& s) {
    return s[0] == s[1] ? 2 : s[0] == s[2] ? 1 : 0;
}

[[nodiscard]] bool boxes_apart(const Triangle& a, const Triangle& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        const auto [low_a, high_a] = std::minmax({a[0][k], a[1][k], a[2][k]});
        const auto [low_b, high_b] = std::minmax({b[0][k], b[1][k], b[2][k]});
        if (high_a < low_b || high_b < low_a) {
            return true;
        }
    }
    return false;
}

// Each triangle crosses the other's plane; their traces on the planes' common line overlap
// unless one of two edge pairs passes on the wrong side.
// Guigue and Devillers 2003, Fast and robust triangle-triangle overlap test using orientation
// predicates, with signs that must all be sure.
[[nodiscard]] std::optional<bool> traces_overlap(const Triangle& a, const Triangle& b,
                                                 const std::array<Sign, 3>& sides_a,
                                                 const std::array<Sign, 3>& sides_b) {
    const std::size_t i = lone(sides_a);
    const std::size_t j = lone(sides_b);
    std::size_t a1 = (i + 1) % 3;
    std::size_t a2 = (i + 2) % 3;
    std::size_t b1 = (j + 1) % 3;
    std::size_t b2 = (j + 2) % 3;
    // Turn either triangle over so that each lone vertex is above the other's plane.
    if (sides_a[i] == Sign::kNegative) {
        std::swap(b1, b2);
    }
    if (sides_b[j] == Sign::kNegative) {
        std::swap(a1, a2);
    }
    const Sign first = side(a[a1], b[j], a[i], b[b1]);
    if (first == Sign::kPositive) {
        return false;
    }
    const Sign second = side(a[i], b[j], a[a2], b[b2]);
    if (second == Sign::kPositive) {
        return false;
    }
    if (first == Sign::kUnsure || second == Sign::kUnsure) {
        return std::nullopt;
    }
    return true;
}

struct Filter {
    std::array<Vec3, 6> points; // relative to a[0]
    double extent;

    Filter(const Triangle& a, const Triangle& b)
        : points{Vec3{0, 0, 0}, a[1] - a[0], a[2] - a[0], b[0] - a[0], b[1] - a[0], b[2] - a[0]},
          extent(0) {
        for (const Vec3& p : points) {
            extent = std::max(extent, norm_inf(p));
        }
    }

    // The axis is taken as it is, so only the projections round: gamma_4 each.
    [[nodiscard]] bool separated_along(const Vec3& axis) const {
        const double error = kTripleError * norm_1(axis) * extent + kTiny;
        std::array<double, 6> s{};
        for (std::size_t k = 0; k < 6; ++k) {
            s[k] = dot(axis, points[k]);
        }
        const auto [low_a, high_a] = std::minmax({s[0], s[1], s[2]});
        const auto [low_b, high_b] = std::minmax({s[3], s[4], s[5]});
        return low_b - high_a > error || low_a - high_b > error;
    }

    [[nodiscard]] bool separated() const {
        const std::array<Vec3, 3> e{points[1], points[2] - points[1], points[2]};
        const std::array<Vec3, 3> f{points[4] - points[3], points[5] - points[4],
                                    points[5] - points[3]};
        const Vec3 normal_a = cross(e[0], e[2]);
        const Vec3 normal_b = cross(f[0], f[2]);
        for (std::size_t i = 0; i < 3; ++i) {
            if (separated_along(cross(normal_a, e[i])) || separated_along(cross(normal_b, f[i]))) {
                return true;
            }
            for (std::size_t j = 0; j < 3; ++j) {
                if (separated_along(cross(e[i], f[j]))) {
                    return true;
                }
            }
        }
        return false;
    }
};

[[nodiscard]] bool triangles_intersect_exactly(const Triangle& a, const Triangle& b) {
    DigitRange digits;
    for (std::size_t k = 0; k < 3; ++k) {
        digits.include(a[k]);
        digits.include(b[k]);
    }
    return with_width(digits.bits(), [&](auto width) {
        constexpr std::size_t kWidth = decltype(width)::value;
        return shapes_intersect(exact_shape<kWidth>(a, a[0], digits.low),
                                exact_shape<kWidth>(b, a[0], digits.low));
    });
}

[[nodiscard]] bool within_range(const Triangle& a, const Triangle& b) {
    double largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        largest = std::max({largest, norm_inf(a[k]), norm_inf(b[k])});
    }
    return largest <= kLargest;
}

} // namespace

TriangleVerdict test_triangles(const Triangle& a, const Triangle& b) {
    if (boxes_apart(a, b)) {
        return {false, false};
    }
    if (!within_range(a, b)) {
        return {triangles_intersect_exactly(a, b), true};
    }
    const std::array<Sign, 3> sides_b = sides(a, b);
    if (sides_b[0] != Sign::kUnsure && all_same(sides_b)) {
        return {false, false};
    }
    const std::array<Sign, 3> sides_a = sides(b, a);
    if (sides_a[0] != Sign::kUnsure && all_same(sides_a)) {
        return {false, false};
    }
    const auto unsure = [](Sign sign) { return sign == Sign::kUnsure; };
    if (std::ranges::none_of(sides_a, unsure) && std::ranges::none_of(sides_b, unsure)) {
        if (const std::optional<bool> overlap = traces_overlap(a, b, sides_a, sides_b)) {
            return {*overlap, false};
        }
    }
    if (Filter(a, b).separated()) {
        return {false, false};
    }
    return {triangles_intersect_exactly(a, b), true};
}

bool triangles_intersect(const Triangle& a, const Triangle& b) {
    return test_triangles(a, b).intersects;
}

} // namespace obb
