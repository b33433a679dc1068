// Two triangles in coordinates of their own: near the origin, and neither huge nor tiny, so that
// kernels lose no digits to where in the world the triangles are.
#pragma once

#include "numbers/scale.hpp"
#include "numbers/twofold.hpp"
#include "numbers/vec.hpp"
#include "shapes/extremes.hpp"
#include "shapes/triangle.hpp"

#include <array>
#include <cstddef>
#include <limits>

namespace obb {

// Products of four lengths stay in range for lengths between these; others are scaled by a power of
// two first.
inline constexpr double kShortest = 0x1p-100;
inline constexpr double kLongest = 0x1p100;

template <typename Real>
using Corners3 = std::array<Vector3<Real>, 3>;

[[nodiscard]] inline Vec3 nearest_double(const Vec3& v) { return v; }
[[nodiscard]] inline Vec3 nearest_double(const Vector3<Twofold>& v) {
    return {v.x.high, v.y.high, v.z.high};
}

// Two triangles relative to A's first corner and scaled by 2^-exponent. Every corner is off by at
// most the type's roundoff times its distance from there, and so is every point of the triangles:
// the distance changes by no more than roundoff * extent.
template <typename Real>
struct LocalPair {
    Corners3<Real> a, b;
    double extent; // sum of the largest distances of A's and B's corners from the origin, or more
    int exponent;
    Vec3 origin; // A's first corner, in the world

    // A point in the world, rounded to double.
    [[nodiscard]] Vec3 placed(const Vector3<Real>& p) const {
        return origin + scaled(nearest_double(p), exponent);
    }
};

[[nodiscard]] inline Vec3 difference(const Vec3& p, const Vec3& q, double) { return p - q; }
[[nodiscard]] inline Vector3<Twofold> difference(const Vec3& p, const Vec3& q, Twofold) {
    return {Twofold(two_sum(p.x, -q.x)), Twofold(two_sum(p.y, -q.y)), Twofold(two_sum(p.z, -q.z))};
}

[[nodiscard]] inline Vec3 rescaled(const Vec3& v, int exponent) { return scaled(v, exponent); }
[[nodiscard]] inline Vector3<Twofold> rescaled(const Vector3<Twofold>& v, int exponent) {
    const Vec3 high = scaled({v.x.high, v.y.high, v.z.high}, exponent);
    const Vec3 low = scaled({v.x.low, v.y.low, v.z.low}, exponent);
    return {{high.x, low.x}, {high.y, low.y}, {high.z, low.z}};
}

template <typename Real>
[[nodiscard]] double reach_of(const Corners3<Real>& corners) {
    return largest_coordinate(Triangle{nearest_double(corners[0]), nearest_double(corners[1]),
                                       nearest_double(corners[2])});
}

template <typename Real>
[[nodiscard]] LocalPair<Real> relative_to_corner(const Triangle& a, const Triangle& b) {
    LocalPair<Real> pair{};
    for (std::size_t k = 0; k < 3; ++k) {
        pair.a[k] = difference(a[k], a[0], Real{});
        pair.b[k] = difference(b[k], a[0], Real{});
    }
    return pair;
}

template <typename Real>
[[nodiscard]] LocalPair<Real> localized(const Triangle& a, const Triangle& b) {
    LocalPair<Real> pair = relative_to_corner<Real>(a, b);
    double far_a = reach_of(pair.a), far_b = reach_of(pair.b);
    if (!(larger(far_a, far_b) <= std::numeric_limits<double>::max())) {
        // Overflow. What underflows instead is far below a roundoff of such an extent.
        const auto quarter = [](const Triangle& t) {
            return Triangle{0.25 * t[0], 0.25 * t[1], 0.25 * t[2]};
        };
        pair = relative_to_corner<Real>(quarter(a), quarter(b));
        pair.exponent = 2;
        far_a = reach_of(pair.a);
        far_b = reach_of(pair.b);
    }
    const double farthest = larger(far_a, far_b);
    if (farthest > 0 && !(farthest >= kShortest && farthest <= kLongest)) {
        const int k = exponent_of(farthest);
        for (std::size_t i = 0; i < 3; ++i) {
            pair.a[i] = rescaled(pair.a[i], -k);
            pair.b[i] = rescaled(pair.b[i], -k);
        }
        pair.exponent += k;
        far_a = reach_of(pair.a);
        far_b = reach_of(pair.b);
    }
    pair.origin = a[0];
    pair.extent = 1.7320508075688774 * (far_a + far_b) * (1 + 8 * kUnitRoundoff);
    return pair;
}

} // namespace obb
