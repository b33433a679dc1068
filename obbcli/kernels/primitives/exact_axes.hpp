// Complete sets of separating axes for two shapes in exact integers.
#pragma once

#include "exact/exact_shape.hpp"
#include "exact/wide_int.hpp"
#include "primitives/axis.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace obb {

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

template <std::size_t N>
[[nodiscard]] WideSpan<N> span_of_edges(const ExactShape<N>& a, const ExactShape<N>& b) {
    const std::array<WideVec<N>, 6> edges{a.edges[0], a.edges[1], a.edges[2],
                                          b.edges[0], b.edges[1], b.edges[2]};
    return span_of<N>(edges);
}

namespace detail {

[[nodiscard]] constexpr bool is_in(std::uint32_t axes, AxisId id) {
    return ((axes >> axis_index(id)) & 1) != 0;
}

template <std::size_t N, typename Visit>
bool visit_faces(const ExactShape<N>& shape, AxisKind kind, std::uint32_t wanted, Visit&& visit) {
    for (std::uint8_t k = 0; k < shape.face_count; ++k) {
        if (!is_in(wanted, AxisId{kind, k, k})) {
            continue;
        }
        const WideVec<2 * N> normal = cross(shape.edges[(k + 1u) % 3], shape.edges[(k + 2u) % 3]);
        if (!normal.is_zero() && visit(AxisId{kind, k, k}, normal)) {
            return true;
        }
    }
    return false;
}

template <std::size_t N, typename Visit>
bool visit_solid_axes(const ExactShape<N>& a, const ExactShape<N>& b, std::uint32_t wanted,
                      Visit&& visit) {
    if (visit_faces(a, AxisKind::kFaceA, wanted, visit) ||
        visit_faces(b, AxisKind::kFaceB, wanted, visit)) {
        return true;
    }
    for (std::uint8_t i = 0; i < 3; ++i) {
        for (std::uint8_t j = 0; j < 3; ++j) {
            const AxisId id{AxisKind::kEdgeEdge, i, j};
            if (!is_in(wanted, id)) {
                continue;
            }
            const WideVec<2 * N> axis = cross(a.edges[i], b.edges[j]);
            if (!axis.is_zero() && visit(id, axis)) {
                return true;
            }
        }
    }
    return false;
}

template <std::size_t N, typename Visit>
bool visit_plane_axes(const ExactShape<N>& a, const ExactShape<N>& b, const WideVec<2 * N>& normal,
                      std::uint32_t wanted, Visit&& visit) {
    if (visit(AxisId{AxisKind::kPlane}, normal)) {
        return true;
    }
    for (std::uint8_t k = 0; k < 6; ++k) {
        const bool of_a = k < 3;
        const WideVec<N>& edge = of_a ? a.edges[k] : b.edges[k - 3u];
        const AxisId id{of_a ? AxisKind::kEdgeA : AxisKind::kEdgeB, std::uint8_t(k % 3),
                        std::uint8_t(k % 3)};
        const bool is_settled = (wanted & settled_in_plane(k)) != 0;
        if (!is_settled && !edge.is_zero() && visit(id, cross(normal, edge))) {
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

// Visits axes L of which one separates the shapes whenever they are disjoint, whatever the rank
// of their edges (closed convex sets, so flat boxes, segments and points are included). `visit`
// takes (AxisId, WideVec) and returns true to stop; so does the function.
// Source: Minkowski's difference of A and B is a polytope whose edges are parallel to theirs, so
// these are the normals of its facets within its affine hull, and the normals of the hull.
// Of face and edge-edge axes only those whose axis_index is a bit of `wanted` are visited, of axes
// in a plane those that it does not have as settled.
template <std::size_t N, typename Visit>
bool visit_axes(const ExactShape<N>& a, const ExactShape<N>& b, const WideSpan<N>& span,
                std::uint32_t wanted, Visit&& visit) {
    switch (span.rank) {
    case 3:
        return detail::visit_solid_axes(a, b, wanted, visit);
    case 2:
        return detail::visit_plane_axes(a, b, span.normal, wanted, visit);
    default:
        return detail::visit_line_axes(span, visit);
    }
}

// Whether the closed shapes have a point in common, when no axis outside `unsure` separates them,
// and none that it has as settled.
template <std::size_t N>
[[nodiscard]] bool shapes_intersect(const ExactShape<N>& a, const ExactShape<N>& b,
                                    std::uint32_t unsure) {
    return !visit_axes(a, b, span_of_edges(a, b), unsure, [&](AxisId, const auto& axis) {
        const auto on_a = project(a, axis);
        const auto on_b = project(b, axis);
        return on_a.high < on_b.low || on_b.high < on_a.low;
    });
}

} // namespace obb
