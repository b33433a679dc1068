// First and last contact of two shapes under constant velocities, in exact arithmetic.
// For each axis contact needs low <= speed t <= high, two half-lines of time; the first contact is
// the latest entry if no exit comes before it. Axes that depend on the velocity are not needed.
#pragma once

#include "exact/exact_shape.hpp"
#include "exact/rational.hpp"
#include "primitives/axis.hpp"
#include "primitives/exact_axes.hpp"
#include "primitives/touch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace obb {

// Which face and edge-edge axes matter, from doubles: a bit each, by axis_index.
struct AxisSelection {
    std::uint32_t binding = kAllAxes; // may bound the first or the last time
    std::uint32_t near = kAllAxes;    // may have a gap of zero at the first time
};

// Two shapes and B's velocity relative to A's in integers. Time is measured in units of
// 2^time_exponent.
template <std::size_t N>
struct ExactPair {
    ExactShape<N> a, b;
    WideVec<N> velocity;
    Dyadic duration; // in units of time
    int time_exponent = 0;
};

template <std::size_t N>
class ExactContact {
  public:
    explicit ExactContact(const ExactPair<N>& pair)
        : pair_(pair), span_(span_of_edges(pair.a, pair.b)) {}

    // Finds the first and last time over the axes of `selection.binding`; false: no contact.
    [[nodiscard]] bool solve(const AxisSelection& selection) {
        const bool apart =
            visit_axes(pair_.a, pair_.b, span_, selection.binding,
                       [&](AxisId id, const auto& axis) { return !narrow(id, axis); });
        if (apart || (last_ && first_ > *last_)) {
            return false;
        }
        return compare(first_, pair_.duration.mantissa, pair_.duration.exponent) <= 0;
    }

    [[nodiscard]] RoundedRational first() const { return rounded(first_, pair_.time_exponent); }

    // The last time of contact, where it comes before the duration.
    [[nodiscard]] std::optional<double> last() const {
        if (!last_ || compare(*last_, pair_.duration.mantissa, pair_.duration.exponent) >= 0) {
            return std::nullopt;
        }
        return rounded(*last_, pair_.time_exponent).nearest;
    }

    // What meets at the first time, from the axes whose gap is then exactly zero. Facets of the
    // Minkowski difference that hold one point have the smallest face with it in common.
    [[nodiscard]] Touch touch(const AxisSelection& selection) const {
        Touch touch;
        Feature a = whole(pair_.a);
        Feature b = whole(pair_.b);
        visit_axes(pair_.a, pair_.b, span_, selection.near, [&](AxisId id, const auto& axis) {
            meet(id, axis, touch, a, b);
            return false;
        });
        if (touch.axis.kind != AxisKind::kNone) {
            touch.feature_a = measured(pair_.a, a);
            touch.feature_b = measured(pair_.b, b);
        }
        return touch;
    }

  private:
    using Time = Rational<4 * N>;

    template <std::size_t K>
    struct Constraint {
        WideInt<K> low, high, speed; // speed >= 0
        bool flipped;                // the axis was turned round for that
    };

    template <std::size_t M>
    [[nodiscard]] Constraint<M + N> constraint(const WideVec<M>& axis) const {
        const auto on_a = project(pair_.a, axis);
        const auto on_b = project(pair_.b, axis);
        Constraint<M + N> c{on_a.low - on_b.high, on_a.high - on_b.low, dot(axis, pair_.velocity),
                            false};
        if (c.speed.is_negative()) {
            c = {-c.high, -c.low, -c.speed, true};
        }
        return c;
    }

    // Cuts the time of contact by one axis; false where nothing is left.
    template <std::size_t M>
    [[nodiscard]] bool narrow(AxisId id, const WideVec<M>& axis) {
        const auto c = constraint(axis);
        if (c.speed.is_zero()) {
            return c.low.sign() <= 0 && c.high.sign() >= 0;
        }
        if (c.high.is_negative()) {
            return false;
        }
        const auto wide = [](const auto& value) { return value.template resized<4 * N>(); };
        if (c.low.sign() >= 0) {
            const Time entry{wide(c.low), wide(c.speed)};
            if (axis_.kind == AxisKind::kNone || entry > first_) {
                first_ = entry;
                axis_ = id;
            }
        }
        const Time exit{wide(c.high), wide(c.speed)};
        if (!last_ || exit < *last_) {
            last_ = exit;
        }
        return true;
    }

    template <std::size_t M>
    void meet(AxisId id, const WideVec<M>& axis, Touch& touch, Feature& a, Feature& b) const {
        const auto c = constraint(axis);
        const auto now = first_.numerator * c.speed;
        const auto is_now = [&](const auto& bound) {
            const auto scaled = first_.denominator * bound;
            return scaled == now;
        };
        const bool below = is_now(c.low);
        const bool above = is_now(c.high);
        if (!below && !above) {
            return;
        }
        // Where the low bound holds with equality B is below A along the axis as oriented.
        const int side = below == c.flipped ? 1 : -1;
        for (const int s : {side, -side}) {
            if (s == side || (below && above)) {
                keep_extreme(pair_.a, axis, s, a);
                keep_extreme(pair_.b, axis, -s, b);
            }
        }
        // The axis that ended last goes before others that are tight.
        if (touch.axis.kind == AxisKind::kNone || id == axis_) {
            const std::array<double, 3> l = direction(axis);
            const double scale = side / std::sqrt(l[0] * l[0] + l[1] * l[1] + l[2] * l[2]);
            touch.axis = id;
            touch.side = static_cast<std::int8_t>(side);
            touch.normal = {scale * l[0], scale * l[1], scale * l[2]};
        }
    }

    [[nodiscard]] static Feature whole(const ExactShape<N>& shape) {
        Feature feature;
        feature.points = static_cast<std::uint8_t>((1u << shape.point_count) - 1);
        return feature;
    }

    // Keeps of the feature what is extreme along side * axis.
    template <std::size_t M>
    static void keep_extreme(const ExactShape<N>& shape, const WideVec<M>& axis, int side,
                             Feature& feature) {
        const auto interval = project_points(shape, axis);
        for (std::size_t k = 0; k < shape.point_count; ++k) {
            if (dot(axis, shape.points[k]) != (side > 0 ? interval.high : interval.low)) {
                feature.points &= static_cast<std::uint8_t>(~(1u << k));
            }
        }
        for (std::size_t k = 0; k < shape.generator_count; ++k) {
            const int sign = dot(axis, shape.generators[k]).sign();
            if (sign != 0) {
                feature.signs[k] = static_cast<std::int8_t>(side * sign);
            }
        }
    }

    [[nodiscard]] static Feature measured(const ExactShape<N>& shape, Feature feature) {
        std::array<WideVec<N>, 6> directions;
        std::size_t count = 0;
        std::size_t base = 3;
        for (std::size_t k = 0; k < shape.point_count; ++k) {
            if (((feature.points >> k) & 1u) != 0) {
                base = base == 3 ? k : base;
                directions[count++] = shape.points[k] - shape.points[base];
            }
        }
        for (std::size_t k = 0; k < shape.generator_count; ++k) {
            if (feature.signs[k] == 0) {
                directions[count++] = shape.generators[k];
            }
        }
        feature.dimension = static_cast<std::uint8_t>(
            span_of<N>(std::span<const WideVec<N>>(directions.data(), count)).rank);
        return feature;
    }

    const ExactPair<N>& pair_;
    WideSpan<N> span_;
    Time first_{};
    std::optional<Time> last_;
    AxisId axis_;
};

} // namespace obb
