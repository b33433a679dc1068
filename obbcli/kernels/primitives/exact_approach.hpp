// The first time at which two translating triangles are within a distance of each other, in exact
// integers.
//
// The distance of two triangles is that of two features: of two vertices, of a vertex and an edge,
// of a vertex and a face, or of two edges. Features are within the clearance c of each other by
// points inside of both while |u + t v|^2 <= bound, a quadratic in time, and while the feet of the
// perpendicular lie within the features, which is linear in time. Every such stretch of time is one
// of nearness of the triangles, and the first instant of nearness starts one of them: at that
// instant the distance is c, and some features attain it. So the earliest start of all is the
// answer.
#pragma once

#include "exact/exact_shape.hpp"
#include "exact/rational.hpp"
#include "exact/wide_root.hpp"
#include "primitives/axis.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace obb {

// Two triangles, B's velocity relative to A's and the clearance, in integers; all are below
// 2^(64 N - 3) in absolute value. Time is measured in units of 2^time_exponent.
template <std::size_t N>
struct ExactApproachInput {
    std::array<WideVec<N>, 3> a, b;
    WideVec<N> velocity;
    WideInt<N> clearance;
    Rational<4 * N> duration; // in units of time
    int time_exponent = 0;
};

// A time in s as a fraction of the unit of time; nothing where that has too many digits.
template <std::size_t N>
[[nodiscard]] std::optional<Rational<4 * N>> rational_time(double time, int time_exponent) {
    const Dyadic dyadic = to_dyadic(time);
    const int shift = dyadic.exponent - time_exponent;
    if (dyadic.mantissa == 0) {
        return Rational<4 * N>{};
    }
    if (std::abs(shift) + 56 > static_cast<int>(64 * 4 * N)) {
        return std::nullopt;
    }
    Rational<4 * N> result{WideInt<4 * N>(dyadic.mantissa)};
    (shift > 0 ? result.numerator : result.denominator) =
        (shift > 0 ? result.numerator : result.denominator)
        << static_cast<std::size_t>(std::abs(shift));
    return result;
}

// The start of a stretch of nearness, as the doubles around it, s.
struct ApproachStart {
    double below, above;
    bool by_gap;    // the features came within the clearance then; else their feet came inside
    bool is_within; // whether the features are within the clearance at `above`
};

// a t^2 + 2 b t + k, with a >= 0.
template <std::size_t M>
struct Quadratic {
    WideInt<M> a, b, k;

    // The sign of the value at a rational time.
    template <std::size_t K>
    [[nodiscard]] int sign_at(const Rational<K>& t) const {
        const auto cross_term = b * (t.numerator * t.denominator);
        const auto sum = a * (t.numerator * t.numerator) + cross_term + cross_term +
                         k * (t.denominator * t.denominator);
        return sum.sign();
    }
    // Whether the value decreases at a rational time.
    template <std::size_t K>
    [[nodiscard]] bool decreases_at(const Rational<K>& t) const {
        return (a * t.numerator + b * t.denominator).is_negative();
    }
    template <std::size_t K>
    [[nodiscard]] bool is_before(const Rational<K>& t) const {
        return sign_at(t) > 0 && decreases_at(t);
    }
};

template <std::size_t N>
class ExactApproach {
  public:
    explicit ExactApproach(const ExactApproachInput<N>& input) : in_(input) {}

    // Calls `visit` with the start of every stretch of nearness in [0, duration] that features
    // have, the axis of faces and edges (or none) and a vertex of either feature.
    template <typename Visit>
    void visit_starts(Visit&& visit) const {
        for (std::uint8_t i = 0; i < 3; ++i) {
            for (std::uint8_t j = 0; j < 3; ++j) {
                const auto at = [&](AxisId axis, const std::optional<ApproachStart>& start) {
                    if (start) {
                        visit(*start, axis, i, j);
                    }
                };
                at({}, of_vertices(i, j));
                at({}, of_vertex_and_edge(in_.a[i], in_.b, j, false));
                at({}, of_vertex_and_edge(in_.b[j], in_.a, i, true));
                at({AxisKind::kEdgeEdge, i, j}, of_edges(i, j));
                if (j == 0) {
                    at({AxisKind::kFaceB, 0, 0}, of_vertex_and_face(in_.a[i], in_.b, false));
                }
                if (i == 0) {
                    at({AxisKind::kFaceA, 0, 0}, of_vertex_and_face(in_.b[j], in_.a, true));
                }
            }
        }
    }

  private:
    using Time = Rational<4 * N>;

    // A time is within all feet's bounds while offset + rate t >= 0 for each of them.
    struct Bound {
        WideInt<4 * N> offset, rate;
    };

    [[nodiscard]] WideVec<N> edge(const std::array<WideVec<N>, 3>& t, std::size_t k) const {
        return t[(k + 1) % 3] - t[k];
    }
    [[nodiscard]] WideInt<2 * N> square() const { return in_.clearance * in_.clearance; }

    [[nodiscard]] std::optional<ApproachStart> of_vertices(std::size_t i, std::size_t j) const {
        const WideVec<N> r = in_.b[j] - in_.a[i];
        const WideVec<N>& w = in_.velocity;
        return start(Quadratic<2 * N>{dot(w, w), dot(r, w), dot(r, r) - square()},
                     std::array<Bound, 0>{});
    }

    [[nodiscard]] std::optional<ApproachStart>
    of_vertex_and_edge(const WideVec<N>& p, const std::array<WideVec<N>, 3>& t, std::size_t k,
                       bool vertex_is_of_b) const {
        const WideVec<N> e = edge(t, k);
        if (e.is_zero()) {
            return std::nullopt; // its ends are vertices
        }
        const WideVec<N> r = p - t[k], w = seen(vertex_is_of_b);
        const auto u = cross(e, r), v = cross(e, w);
        const auto length = dot(e, e), along = dot(e, r), rate = dot(e, w);
        const auto wide = [](const WideInt<2 * N>& x) { return x.template resized<4 * N>(); };
        const std::array<Bound, 2> bounds{
            {{wide(along), wide(rate)}, {wide(length - along), wide(-rate)}}};
        return start(Quadratic<4 * N>{dot(v, v), dot(u, v), dot(u, u) - square() * length}, bounds);
    }

    [[nodiscard]] std::optional<ApproachStart>
    of_vertex_and_face(const WideVec<N>& p, const std::array<WideVec<N>, 3>& t,
                       bool vertex_is_of_b) const {
        const WideVec<2 * N> n = cross(edge(t, 0), edge(t, 1));
        if (n.is_zero()) {
            return std::nullopt; // its edges hold all of it
        }
        const WideVec<N> w = seen(vertex_is_of_b);
        std::array<Bound, 3> bounds;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto inward = cross(n, edge(t, k));
            bounds[k] = {dot(inward, p - t[k]), dot(inward, w)};
        }
        return start(across(n, p - t[0], w), bounds);
    }

    [[nodiscard]] std::optional<ApproachStart> of_edges(std::size_t i, std::size_t j) const {
        const WideVec<N> e = edge(in_.a, i), f = edge(in_.b, j);
        const WideVec<2 * N> n = cross(e, f);
        if (n.is_zero()) {
            return std::nullopt; // of parallel edges, an end of one is as near
        }
        const WideVec<N> r = in_.b[j] - in_.a[i];
        // Along e the foot is at (r x f).n / n^2, along f at (r x e).n / n^2.
        const auto length = dot(n, n);
        const auto on_e = cross(f, n), on_f = cross(e, n);
        const auto at_e = dot(on_e, r), rate_e = dot(on_e, in_.velocity);
        const auto at_f = dot(on_f, r), rate_f = dot(on_f, in_.velocity);
        const std::array<Bound, 4> bounds{
            {{at_e, rate_e}, {length - at_e, -rate_e}, {at_f, rate_f}, {length - at_f, -rate_f}}};
        return start(across(n, r, in_.velocity), bounds);
    }

    [[nodiscard]] WideVec<N> seen(bool vertex_is_of_b) const {
        return vertex_is_of_b ? in_.velocity : WideVec<N>{} - in_.velocity;
    }

    // The square of n.(r + t w), less that of c |n|.
    [[nodiscard]] Quadratic<6 * N> across(const WideVec<2 * N>& n, const WideVec<N>& r,
                                          const WideVec<N>& w) const {
        const auto u = dot(n, r), v = dot(n, w);
        return {v * v, u * v, u * u - square() * dot(n, n)};
    }

    template <std::size_t M, std::size_t Count>
    [[nodiscard]] std::optional<ApproachStart> start(const Quadratic<M>& gap,
                                                     const std::array<Bound, Count>& bounds) const {
        Time first{}, last = in_.duration;
        for (const Bound& bound : bounds) {
            const int rate = bound.rate.sign();
            if (rate > 0) {
                first = std::max(first, Time{-bound.offset, bound.rate});
            } else if (rate < 0) {
                last = std::min(last, Time{bound.offset, -bound.rate});
            } else if (bound.offset.is_negative()) {
                return std::nullopt;
            }
        }
        if (first > last) {
            return std::nullopt;
        }
        if (gap.sign_at(first) <= 0) {
            return around(first, first, false, gap, last);
        }
        // Beyond the clearance at first: within it later, if the gap closes so far, and in time.
        const auto discriminant = gap.b * gap.b - gap.a * gap.k;
        if (!gap.decreases_at(first) || discriminant.is_negative() || gap.is_before(last)) {
            return std::nullopt;
        }
        return at_root(gap, discriminant, last);
    }

    // The smaller root is k / (-b + sqrt(D)): the gap closes from t = 0 on, where it is k, so that
    // b < 0 < k and nothing cancels.
    template <std::size_t M>
    [[nodiscard]] ApproachStart at_root(const Quadratic<M>& gap, const WideInt<2 * M>& discriminant,
                                        const Time& last) const {
        const auto wide = [](const auto& x) { return x.template resized<M + 3>(); };
        WideInt<M + 3> numerator = wide(gap.k), larger = -wide(gap.b), smaller = larger;
        if (!discriminant.is_zero()) {
            const WideRoot root = root_of(discriminant);
            const auto up = static_cast<std::size_t>(std::max(root.exponent, 0));
            const auto down = static_cast<std::size_t>(std::max(-root.exponent, 0));
            const WideInt<M + 3> low = wide(root.low), unit(root.is_exact ? 0 : 1);
            numerator = numerator << down;
            smaller = (larger << down) + (low << up);
            larger = (larger << down) + ((low + unit) << up);
        }
        using Root = Rational<M + 3>;
        return around(Root{numerator, larger}, Root{numerator, smaller}, true, gap, last);
    }

    template <std::size_t K, std::size_t M>
    [[nodiscard]] ApproachStart around(const Rational<K>& low, const Rational<K>& high, bool by_gap,
                                       const Quadratic<M>& gap, const Time& last) const {
        const RoundedRational below = rounded(low, in_.time_exponent);
        const double above = rounded(high, in_.time_exponent).above;
        const bool is_double = below.below == above;
        return {below.below, above, by_gap, is_double || is_near(above, gap, last)};
    }

    // Whether a time after the start is still in the stretch; false if it has too many digits.
    template <std::size_t M>
    [[nodiscard]] bool is_near(double time, const Quadratic<M>& gap, const Time& last) const {
        const std::optional<Time> at = rational_time<N>(time, in_.time_exponent);
        return at && *at <= last && gap.sign_at(*at) <= 0;
    }

    const ExactApproachInput<N>& in_;
};

} // namespace obb
