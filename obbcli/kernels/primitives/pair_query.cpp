#include "primitives/pair_query.hpp"

#include "primitives/contact_normals.hpp"
#include "primitives/contact_point.hpp"
#include "primitives/exact_contact.hpp"
#include "primitives/predicates.hpp"
#include "primitives/sat.hpp"
#include "primitives/sat_obb_obb.hpp"
#include "primitives/sat_triangle_obb.hpp"
#include "primitives/sat_triangle_triangle.hpp"
#include "shapes/extremes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace obb {
namespace {

[[nodiscard]] bool is_still(const LinearMotion& m) {
    return m.duration == 0 || m.velocity_a == m.velocity_b;
}

template <typename A, typename B>
[[nodiscard]] bool in_filter_range(const A& a, const B& b, const LinearMotion& m) {
    return larger(largest_coordinate(a), largest_coordinate(b)) <= kLargestFiltered &&
           larger(larger(largest_coordinate(m.velocity_a), largest_coordinate(m.velocity_b)),
                  m.duration) <= kLargestFiltered;
}

// Calls `solve` with the pair in integers of the narrowest width that holds it.
template <typename A, typename B, typename Solve>
auto with_exact_pair(const A& a, const B& b, const LinearMotion& m, Solve&& solve) {
    ShapeDigits shapes;
    shapes.include(a);
    shapes.include(b);
    DigitRange speeds;
    if (!is_still(m)) {
        speeds.include(m.velocity_a);
        speeds.include(m.velocity_b);
    }
    const int bits = std::max({shapes.positions.bits(), shapes.edge_bits, speeds.bits()});
    return with_width(bits, [&](auto width) {
        constexpr std::size_t kWidth = decltype(width)::value;
        ExactPair<kWidth> pair;
        const int unit = shapes.positions.low;
        pair.a = exact_shape<kWidth>(a, origin_of(a), unit);
        pair.b = exact_shape<kWidth>(b, origin_of(a), unit);
        pair.time_exponent = unit - speeds.low;
        pair.duration = to_dyadic(m.duration);
        pair.duration.exponent -= pair.time_exponent;
        if (!is_still(m)) {
            pair.velocity = to_wide<kWidth>(m.velocity_b, speeds.low) -
                            to_wide<kWidth>(m.velocity_a, speeds.low);
        }
        return solve(pair);
    });
}

template <typename A, typename B>
[[nodiscard]] bool meets_exactly(const A& a, const B& b, const LinearMotion& m,
                                 const AxisSelection& selection) {
    return with_exact_pair(a, b, m,
                           [&](const auto& pair) { return ExactContact(pair).solve(selection); });
}

// Asks with the error that any boxes may have, and in doubt with that of these.
template <bool kMoving, typename A, typename B, typename Sat>
[[nodiscard]] Sat asked(const A& a, const B& b, const LinearMotion& m, const Sat& fresh) {
    const Vec3 velocity = kMoving ? m.velocity_b - m.velocity_a : Vec3{0, 0, 0};
    Sat sat = fresh;
    visit_bounds<kMoving>(a, b, velocity, m.duration, kAxisError, sat);
    if (sat.verdict() == Verdict::kUnsure) {
        sat = fresh;
        visit_bounds<kMoving>(a, b, velocity, m.duration, axis_error(a, b), sat);
    }
    return sat;
}

template <typename A, typename B>
[[nodiscard]] PairVerdict test_still(const A& a, const B& b) {
    const auto sat = asked<false>(a, b, LinearMotion{}, StillSat{});
    if (sat.verdict() != Verdict::kUnsure) {
        return {sat.verdict() == Verdict::kIntersecting, false};
    }
    return {meets_exactly(a, b, LinearMotion{}, AxisSelection{sat.unsure(), 0}), true};
}

[[nodiscard]] PairVerdict test_still(const Triangle& a, const Triangle& b) {
    const TriangleVerdict verdict = test_triangles(a, b);
    return {verdict.intersects, verdict.exact};
}

template <typename A, typename B>
[[nodiscard]] AxisRecorder recorded(const A& a, const B& b, const LinearMotion& m) {
    AxisRecorder axes(m.duration);
    visit_bounds<true>(a, b, m.velocity_b - m.velocity_a, m.duration, axis_error(a, b), axes);
    return axes;
}

template <typename A, typename B>
[[nodiscard]] PairVerdict test(const A& a, const B& b, const LinearMotion& m) {
    if (!in_filter_range(a, b, m)) {
        return {meets_exactly(a, b, m, AxisSelection{}), true};
    }
    if (is_still(m)) {
        return test_still(a, b);
    }
    const auto sat = asked<true>(a, b, m, MovingSat(m.duration));
    if (sat.verdict() != Verdict::kUnsure) {
        return {sat.verdict() == Verdict::kIntersecting, false};
    }
    return {meets_exactly(a, b, m, recorded(a, b, m).selection()), true};
}

// An exact face axis of a box is a product of the other two axes: its own axis up to sign.
void orient(const Obb& box, std::size_t face, Touch& touch) {
    touch.side = dot(box.axes[face], touch.normal) > 0 ? 1 : -1;
}
void orient(const Triangle&, std::size_t, Touch&) {}

template <typename A, typename B>
void describe(const A& a, const B& b, const LinearMotion& m, PairContact& contact) {
    Touch& touch = contact.touch;
    if (touch.axis.kind == AxisKind::kFaceA) {
        orient(a, touch.axis.a, touch);
    } else if (touch.axis.kind == AxisKind::kFaceB) {
        orient(b, touch.axis.b, touch);
    }
    contact.point = contact_point(a, b, m, contact.time, touch);
    const Vec3 from_a = contact.point - contact.time * m.velocity_a;
    const Vec3 from_b = contact.point - contact.time * m.velocity_b;
    contact.normal_a = face_normal(a, touch.feature_a, touch.normal);
    contact.normal_b = face_normal(b, touch.feature_b, -touch.normal);
    contact.smooth_normal_a = smooth_normal(a, from_a, contact.normal_a);
    contact.smooth_normal_b = smooth_normal(b, from_b, contact.normal_b);
}

template <typename A, typename B>
[[nodiscard]] std::optional<PairContact> find_contact(const A& a, const B& b,
                                                      const LinearMotion& m) {
    AxisSelection selection;
    if (in_filter_range(a, b, m)) {
        const AxisRecorder axes = recorded(a, b, m);
        if (axes.is_separated()) {
            return std::nullopt;
        }
        selection = axes.selection();
    }
    PairContact contact{};
    const bool meets = with_exact_pair(a, b, m, [&](const auto& pair) {
        ExactContact solver(pair);
        if (!solver.solve(selection)) {
            return false;
        }
        const RoundedRational first = solver.first();
        contact.time = std::min(first.nearest, m.duration);
        contact.time_below = first.below;
        contact.time_above = first.above;
        const std::optional<double> last = solver.last();
        contact.last_time = std::max(contact.time, last.value_or(m.duration));
        contact.ends = last.has_value();
        contact.touch = solver.touch(selection);
        return true;
    });
    if (!meets) {
        return std::nullopt;
    }
    describe(a, b, m, contact);
    return contact;
}

[[nodiscard]] LinearMotion swapped(const LinearMotion& m) {
    return {m.velocity_b, m.velocity_a, m.duration};
}

[[nodiscard]] AxisId swapped(AxisId id) {
    constexpr std::pair<AxisKind, AxisKind> kPairs[] = {
        {AxisKind::kFaceA, AxisKind::kFaceB},
        {AxisKind::kFaceB, AxisKind::kFaceA},
        {AxisKind::kEdgeA, AxisKind::kEdgeB},
        {AxisKind::kEdgeB, AxisKind::kEdgeA},
    };
    for (const auto& [from, to] : kPairs) {
        if (id.kind == from) {
            return {to, id.b, id.a};
        }
    }
    return id.kind == AxisKind::kEdgeEdge ? AxisId{id.kind, id.b, id.a} : id;
}

[[nodiscard]] Touch swapped(const Touch& touch) {
    // The edges' product turns round with the normal; every other axis stays as it is.
    const bool turns = touch.axis.kind == AxisKind::kEdgeEdge;
    return {swapped(touch.axis), static_cast<std::int8_t>(turns ? touch.side : -touch.side),
            -touch.normal, touch.feature_b, touch.feature_a};
}

[[nodiscard]] PairContact swapped(const PairContact& c) {
    PairContact result = c;
    result.touch = swapped(c.touch);
    std::swap(result.normal_a, result.normal_b);
    std::swap(result.smooth_normal_a, result.smooth_normal_b);
    return result;
}

} // namespace

PairVerdict test_pair(const Triangle& a, const Triangle& b, const LinearMotion& m) {
    return test(a, b, m);
}
PairVerdict test_pair(const Obb& a, const Obb& b, const LinearMotion& m) { return test(a, b, m); }
PairVerdict test_pair(const Obb& a, const Triangle& b, const LinearMotion& m) {
    return test(a, b, m);
}
PairVerdict test_pair(const Triangle& a, const Obb& b, const LinearMotion& m) {
    return test(b, a, swapped(m));
}

std::optional<PairContact> first_contact(const Triangle& a, const Triangle& b,
                                         const LinearMotion& m) {
    return find_contact(a, b, m);
}
std::optional<PairContact> first_contact(const Obb& a, const Obb& b, const LinearMotion& m) {
    return find_contact(a, b, m);
}
std::optional<PairContact> first_contact(const Obb& a, const Triangle& b, const LinearMotion& m) {
    return find_contact(a, b, m);
}
std::optional<PairContact> first_contact(const Triangle& a, const Obb& b, const LinearMotion& m) {
    const std::optional<PairContact> contact = find_contact(b, a, swapped(m));
    return contact ? std::optional(swapped(*contact)) : std::nullopt;
}

} // namespace obb
