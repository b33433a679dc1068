// Boxes and triangles in exact integers.
#pragma once

#include "exact/wide_int.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>

namespace obb {

// The range of binary digits that a set of doubles spans: all are multiples of 2^low, and below
// 2^high in absolute value.
struct DigitRange {
    int low = 4000;
    int high = -4000;

    constexpr void include(Dyadic value) {
        if (value.mantissa != 0) {
            low = std::min(low, value.exponent);
            high = std::max(high, value.top());
        }
    }
    constexpr void include(const Vec3& v) {
        include(to_dyadic(v.x));
        include(to_dyadic(v.y));
        include(to_dyadic(v.z));
    }
    [[nodiscard]] constexpr int bits() const { return std::max(0, high - low); }
};

[[nodiscard]] constexpr DigitRange digits_of(const Vec3& v) {
    DigitRange digits;
    digits.include(v);
    return digits;
}

template <std::size_t N>
[[nodiscard]] constexpr WideInt<N> to_wide(double value, int unit) {
    const Dyadic dyadic = to_dyadic(value);
    return dyadic.mantissa == 0 ? WideInt<N>{}
                                : WideInt<N>::from(dyadic.mantissa, dyadic.exponent - unit);
}

template <std::size_t N>
[[nodiscard]] constexpr WideVec<N> to_wide(const Vec3& v, int unit) {
    return {to_wide<N>(v.x, unit), to_wide<N>(v.y, unit), to_wide<N>(v.z, unit)};
}

// The convex hull of the points plus the sum of the segments [-g, g] over the generators: a
// triangle has three points and no generators, a box one point and three generators.
// Every component is below 2^(64 N - 3) in absolute value, points relative to a common origin.
// Edges are directions only, in a unit of their own; some may be zero.
template <std::size_t N>
struct ExactShape {
    std::array<WideVec<N>, 3> points;
    std::array<WideVec<N>, 3> generators;
    std::array<WideVec<N>, 3> edges;
    std::size_t point_count = 0;
    std::size_t generator_count = 0;
    std::size_t face_count = 0; // face i is spanned by the edges i + 1 and i + 2, modulo 3
};

template <std::size_t N>
[[nodiscard]] ExactShape<N> exact_shape(const Triangle& triangle, const Vec3& origin, int unit) {
    ExactShape<N> shape;
    const WideVec<N> wide_origin = to_wide<N>(origin, unit);
    for (std::size_t k = 0; k < 3; ++k) {
        shape.points[k] = to_wide<N>(triangle[k], unit) - wide_origin;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        shape.edges[k] = shape.points[(k + 1) % 3] - shape.points[k];
    }
    shape.point_count = 3;
    shape.face_count = 1;
    return shape;
}

// The digits that a shape's positions span, and the widest of its edges where they have units of
// their own.
struct ShapeDigits {
    DigitRange positions;
    int edge_bits = 0;

    constexpr void include(const Triangle& triangle) {
        for (const Vec3& p : triangle) {
            positions.include(p);
        }
    }
    constexpr void include(const Obb& box) {
        positions.include(box.center);
        for (std::size_t i = 0; i < 3; ++i) {
            const DigitRange axis = digits_of(box.axes[i]);
            const Dyadic half = to_dyadic(box.half_extents[i]);
            if (half.mantissa != 0) {
                edge_bits = std::max(edge_bits, axis.bits());
                positions.low = std::min(positions.low, axis.low + half.exponent);
                positions.high = std::max(positions.high, axis.high + half.top());
            }
        }
    }
};

[[nodiscard]] constexpr Vec3 origin_of(const Triangle& triangle) { return triangle[0]; }
[[nodiscard]] constexpr Vec3 origin_of(const Obb& box) { return box.center; }

// The product of two doubles, exactly.
template <std::size_t N>
[[nodiscard]] constexpr WideInt<N> to_wide_product(double a, double b, int unit) {
    const Dyadic p = to_dyadic(a);
    const Dyadic q = to_dyadic(b);
    const WideInt<2> mantissa = WideInt<1>(p.mantissa) * WideInt<1>(q.mantissa);
    return mantissa.is_zero() ? WideInt<N>{}
                              : mantissa.template resized<N>()
                                    << static_cast<std::size_t>(p.exponent + q.exponent - unit);
}

template <std::size_t N>
[[nodiscard]] ExactShape<N> exact_shape(const Obb& box, const Vec3& origin, int unit) {
    ExactShape<N> shape;
    shape.points[0] = to_wide<N>(box.center, unit) - to_wide<N>(origin, unit);
    for (std::size_t i = 0; i < 3; ++i) {
        const double half = box.half_extents[i];
        const Vec3& axis = box.axes[i];
        shape.generators[i] = {to_wide_product<N>(half, axis.x, unit),
                               to_wide_product<N>(half, axis.y, unit),
                               to_wide_product<N>(half, axis.z, unit)};
        if (half != 0) {
            shape.edges[i] = to_wide<N>(axis, digits_of(axis).low);
        }
    }
    shape.point_count = 1;
    shape.generator_count = 3;
    shape.face_count = 3;
    return shape;
}

template <std::size_t K>
struct WideInterval {
    WideInt<K> low, high;
};

template <std::size_t N, std::size_t M>
[[nodiscard]] WideInterval<N + M> project_points(const ExactShape<N>& shape,
                                                 const WideVec<M>& axis) {
    WideInterval<N + M> interval;
    interval.low = interval.high = dot(axis, shape.points[0]);
    for (std::size_t k = 1; k < shape.point_count; ++k) {
        const WideInt<N + M> place = dot(axis, shape.points[k]);
        if (place < interval.low) {
            interval.low = place;
        } else if (interval.high < place) {
            interval.high = place;
        }
    }
    return interval;
}

// The shape's projection on L, not normalised.
template <std::size_t N, std::size_t M>
[[nodiscard]] WideInterval<N + M> project(const ExactShape<N>& shape, const WideVec<M>& axis) {
    WideInterval<N + M> interval = project_points(shape, axis);
    for (std::size_t k = 0; k < shape.generator_count; ++k) {
        const WideInt<N + M> step = dot(axis, shape.generators[k]);
        const WideInt<N + M> reach = step.is_negative() ? -step : step;
        interval.low = interval.low - reach;
        interval.high = interval.high + reach;
    }
    return interval;
}

// Calls `solve` with the narrowest width (as std::integral_constant) that holds coordinates of
// `bits` binary digits and their differences. The widest holds the products of any two doubles.
template <typename Solve>
auto with_width(int bits, Solve&& solve) {
    using std::integral_constant;
    if (bits <= 60) {
        return solve(integral_constant<std::size_t, 1>{});
    }
    if (bits <= 124) {
        return solve(integral_constant<std::size_t, 2>{});
    }
    if (bits <= 252) {
        return solve(integral_constant<std::size_t, 4>{});
    }
    if (bits <= 764) {
        return solve(integral_constant<std::size_t, 12>{});
    }
    return solve(integral_constant<std::size_t, 52>{});
}

} // namespace obb
