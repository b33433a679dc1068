#include "primitives/predicates.hpp"

#include "exact/orientation.hpp"
#include "primitives/exact_axes.hpp"
#include "primitives/sat.hpp"
#include "primitives/sat_triangle_triangle.hpp"
#include "shapes/extremes.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace obb {
namespace {

[[nodiscard]] PlaneSides sides(const Triangle& plane, const Triangle& other) {
    const Vec3 u = plane[1] - plane[0];
    const Vec3 v = plane[2] - plane[0];
    const Vec3 normal = cross(u, v);
    const double sizes = norm_1(u) * norm_1(v);
    PlaneSides result;
    for (unsigned k = 0; k < 3; ++k) {
        const Vec3 w = other[k] - plane[0];
        const double error = triple_error(sizes, largest_coordinate(w));
        const double value = dot(normal, w);
        result.above |= static_cast<unsigned>(value > error) << k;
        result.below |= static_cast<unsigned>(value < -error) << k;
    }
    return result;
}

[[nodiscard]] bool boxes_apart(const Triangle& a, const Triangle& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        const double low_a = smallest(a[0][k], a[1][k], a[2][k]);
        const double high_a = largest(a[0][k], a[1][k], a[2][k]);
        const double low_b = smallest(b[0][k], b[1][k], b[2][k]);
        const double high_b = largest(b[0][k], b[1][k], b[2][k]);
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
                                                 const PlaneSides& sides_a,
                                                 const PlaneSides& sides_b) {
    const std::size_t i = sides_a.lone();
    const std::size_t j = sides_b.lone();
    // Turn either triangle over so that each lone vertex is above the other's plane.
    const std::size_t turn_a = sides_b.lone_is_below() ? 2 : 1;
    const std::size_t turn_b = sides_a.lone_is_below() ? 2 : 1;
    const Sign first = side(a[(i + turn_a) % 3], b[j], a[i], b[(j + turn_b) % 3]);
    if (first == Sign::kPositive) {
        return false;
    }
    const Sign second = side(a[i], b[j], a[(i + 3 - turn_a) % 3], b[(j + 3 - turn_b) % 3]);
    if (second == Sign::kPositive) {
        return false;
    }
    if (first == Sign::kUnsure || second == Sign::kUnsure) {
        return std::nullopt;
    }
    return true;
}

// What axes in the plane of either triangle say: coplanar ones have no other.
struct InPlane {
    bool separated = false;
    std::uint32_t settled = 0; // those that do not separate coplanar triangles, as a selection
};

// An axis that separates is taken as it is, so only the projections round: gamma_4 each. To settle
// that the true axis, the cross product of exact edges, does not separate, its rounding counts as
// well, with u the unit roundoff: a normal is off by 4.1 u |e_0| |e_2|, by sums of coordinates, the
// axis by 7.2 u |e_0| |e_2| |e|, a projection by 11.3 u of that times the extent, two of them and
// their difference by 25 u. The normal of a needle is lost in this, and its axes are never settled.
[[nodiscard]] InPlane look_in_plane(const Triangle& a, const Triangle& b) {
    const std::array<Vec3, 6> points{Vec3{0, 0, 0}, a[1] - a[0], a[2] - a[0],
                                     b[0] - a[0],   b[1] - a[0], b[2] - a[0]};
    double extent = 0;
    for (const Vec3& p : points) {
        extent = larger(extent, largest_coordinate(p));
    }
    InPlane found;
    std::size_t count = 0;
    for (const Triangle& t : {a, b}) {
        const std::array<Vec3, 3> edges{t[1] - t[0], t[2] - t[1], t[2] - t[0]};
        const Vec3 normal = cross(edges[0], edges[2]);
        const double sizes = norm_1(edges[0]) * norm_1(edges[2]);
        for (const Vec3& edge : edges) {
            const Vec3 axis = cross(normal, edge);
            std::array<double, 6> s{};
            for (std::size_t k = 0; k < 6; ++k) {
                s[k] = dot(axis, points[k]);
            }
            const double apart = larger(smallest(s[3], s[4], s[5]) - largest(s[0], s[1], s[2]),
                                        smallest(s[0], s[1], s[2]) - largest(s[3], s[4], s[5]));
            if (apart > kTripleError * norm_1(axis) * extent + kUnderflow) {
                return {true, 0};
            }
            const double error = 32 * kUnitRoundoff * (sizes * norm_1(edge)) * extent + kUnderflow;
            found.settled |= apart < -error ? settled_in_plane(count) : 0;
            ++count;
        }
    }
    return found;
}

// Over the axes that may yet separate.
[[nodiscard]] bool triangles_intersect_exactly(const Triangle& a, const Triangle& b,
                                               std::uint32_t unsure) {
    DigitRange digits;
    for (std::size_t k = 0; k < 3; ++k) {
        digits.include(a[k]);
        digits.include(b[k]);
    }
    return with_width(digits.bits(), [&](auto width) {
        constexpr std::size_t kWidth = decltype(width)::value;
        return shapes_intersect(exact_shape<kWidth>(a, a[0], digits.low),
                                exact_shape<kWidth>(b, a[0], digits.low), unsure);
    });
}

// Where signs of planes and edges leave a doubt: whether boxes or axes part the triangles, else
// integers decide.
[[nodiscard]] TriangleVerdict test_in_doubt(const Triangle& a, const Triangle& b) {
    if (boxes_apart(a, b)) {
        return {false, false};
    }
    if (larger(largest_coordinate(a), largest_coordinate(b)) > kLargestFiltered) {
        return {triangles_intersect_exactly(a, b, kAllAxes), true};
    }
    StillSat sat;
    if (visit_bounds<false>(a, b, Vec3{0, 0, 0}, 0, 0, sat)) {
        return {false, false};
    }
    const InPlane in_plane = look_in_plane(a, b);
    if (in_plane.separated) {
        return {false, false};
    }
    return {triangles_intersect_exactly(a, b, sat.unsure() | in_plane.settled), true};
}

} // namespace

TriangleVerdict test_triangles(const Triangle& a, const Triangle& b) {
    const PlaneSides sides_b = sides(a, b);
    if (sides_b.all_same()) {
        return {false, false};
    }
    const PlaneSides sides_a = sides(b, a);
    if (sides_a.all_same()) {
        return {false, false};
    }
    return test_triangles(a, b, sides_a, sides_b);
}

TriangleVerdict test_triangles(const Triangle& a, const Triangle& b, const PlaneSides& sides_a,
                               const PlaneSides& sides_b) {
    if (sides_a.all_sure() && sides_b.all_sure()) {
        if (const std::optional<bool> overlap = traces_overlap(a, b, sides_a, sides_b)) {
            return {*overlap, false};
        }
    }
    return test_in_doubt(a, b);
}

bool triangles_intersect(const Triangle& a, const Triangle& b) {
    return test_triangles(a, b).intersects;
}

} // namespace obb
