// Shapes in exact integers, and the complete sets of separating axes for a pair of them.
#pragma once

#include "axis.hpp"
#include "obb.hpp"
#include "triangle.hpp"
#include "wide_int.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
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

// Visits axes L of which one separates the shapes whenever they are disjoint, whatever the rank
// of their edges (closed convex sets, so flat boxes, segments and points are included). `visit`
// takes (AxisId, WideVec) and returns true to stop; so does the function.
// Source: Minkowski's difference of A and B is a polytope whose edges are parallel to theirs, so
// these are the normals of its facets within its affine hull, and the normals of the hull.
template <std::size_t N, typename Visit>
bool visit_axes(const ExactShape<N>& a, const ExactShape<N>& b, Visit&& visit);

// The span of some vectors: its rank, and what spans it or is normal to it.
template <std::size_t N>
struct WideSpan {
    int rank = 0;
    WideVec<N> edge;       // of rank 1
    WideVec<2 * N> normal; // of rank 2
};

template <std::size_t N>
[[nodiscard]] WideSpan<N> span_of(std::span<const WideVec<N>> vectors) {
    WideSpan<N> result;
    for (const WideVec<N>& v : vectors) {
        if (result.rank == 0 && !v.is_zero()) {
            result.edge = v;
            result.rank = 1;
        } else if (result.rank == 1) {
            result.normal = cross(result.edge, v);
            result.rank = result.normal.is_zero() ? 1 : 2;
        } else if (result.rank == 2 && !dot(result.normal, v).is_zero()) {
            result.rank = 3;
            break;
        }
    }
    return result;
}

namespace detail {

template <std::size_t N, typename Visit>
bool visit_faces(const ExactShape<N>& shape, AxisKind kind, Visit&& visit) {
    for (std::uint8_t k = 0; k < shape.face_count; ++k) {
        const WideVec<2 * N> normal = cross(shape.edges[(k + 1u) % 3], shape.edges[(k + 2u) % 3]);
        if (!normal.is_zero() && visit(AxisId{kind, k, k}, normal)) {
            return true;
        }
    }
    return false;
}

template <std::size_t N, typename Visit>
bool visit_solid_axes(const ExactShape<N>& a, const ExactShape<N>& b, Visit&& visit) {
    if (visit_faces(a, AxisKind::kFaceA, visit) || visit_faces(b, AxisKind::kFaceB, visit)) {
        return true;
    }
    for (std::uint8_t i = 0; i < 3; ++i) {
        for (std::uint8_t j = 0; j < 3; ++j) {
            const WideVec<2 * N> axis = cross(a.edges[i], b.edges[j]);
            if (!axis.is_zero() && visit(AxisId{AxisKind::kEdgeEdge, i, j}, axis)) {
                return true;
            }
        }
    }
    return false;
}

template <std::size_t N, typename Visit>
bool visit_plane_axes(const ExactShape<N>& a, const ExactShape<N>& b, const WideVec<2 * N>& normal,
                      Visit&& visit) {
    if (visit(AxisId{AxisKind::kPlane}, normal)) {
        return true;
    }
    for (std::uint8_t k = 0; k < 6; ++k) {
        const bool of_a = k < 3;
        const WideVec<N>& edge = of_a ? a.edges[k] : b.edges[k - 3u];
        const AxisId id{of_a ? AxisKind::kEdgeA : AxisKind::kEdgeB, std::uint8_t(k % 3),
                        std::uint8_t(k % 3)};
        if (!edge.is_zero() && visit(id, cross(normal, edge))) {
            return true;
        }
    }
    return false;
}

template <std::size_t N, typename Visit>
bool visit_line_axes(const WideSpan<N>& span, Visit&& visit) {
    if (span.rank == 1 && visit(AxisId{AxisKind::kLine}, span.edge)) {
        return true;
    }
    const AxisKind kind = span.rank == 1 ? AxisKind::kAcross : AxisKind::kPoint;
    for (std::uint8_t k = 0; k < 3; ++k) {
        WideVec<N> axis;
        (k == 0 ? axis.x : k == 1 ? axis.y : axis.z) = WideInt<N>(1);
        if (span.rank == 0 ? visit(AxisId{kind, k}, axis)
                           : visit(AxisId{kind, k}, cross(axis, span.edge))) {
            return true;
        }
    }
    return false;
}

} // namespace detail

template <std::size_t N, typename Visit>
bool visit_axes(const ExactShape<N>& a, const ExactShape<N>& b, Visit&& visit) {
    const std::array<WideVec<N>, 6> edges{a.edges[0], a.edges[1], a.edges[2],
                                          b.edges[0], b.edges[1], b.edges[2]};
    const WideSpan<N> span = span_of<N>(edges);
    switch (span.rank) {
    case 3:
        return detail::visit_solid_axes(a, b, visit);
    case 2:
        return detail::visit_plane_axes(a, b, span.normal, visit);
    default:
        return detail::visit_line_axes(span, visit);
    }
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

// Whether the closed shapes have a point in common.
template <std::size_t N>
[[nodiscard]] bool shapes_intersect(const ExactShape<N>& a, const ExactShape<N>& b) {
    return !visit_axes(a, b, [&](AxisId, const auto& axis) {
        const auto on_a = project(a, axis);
        const auto on_b = project(b, axis);
        return on_a.high < on_b.low || on_b.high < on_a.low;
    });
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
