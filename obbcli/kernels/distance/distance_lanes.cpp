#include "distance/distance_lanes.hpp"

#include "descent/box_distance.hpp"
#include "nearest/localized.hpp"
#include "nearest/nearest_points.hpp"

#include <cstddef>
#include <limits>

namespace obb {

namespace {

using Corners4 = std::array<Vector3<Four>, 3>;

constexpr double kTiny = 0x1p-900; // what coordinates and products lose to underflow

[[nodiscard]] Four smallest(Four a, Four b, Four c) {
    const Four ab = select(a < b, a, b);
    return select(ab < c, ab, c);
}
[[nodiscard]] Four largest(Four a, Four b, Four c) { return maximum(maximum(a, b), c); }
[[nodiscard]] Four within_one(Four a) {
    const Four zero = every(0.0, a), one = every(1.0, a);
    const Four positive = select(a > zero, a, zero); // NaN becomes 0
    return select(positive < one, positive, one);
}

// Relative to A's first corner, as LocalPair.
struct LocalLanes {
    Corners4 a, b; // a[0] is the origin
    alignas(kAlignment<Four>) Four extent;
};

LocalLanes localized(const TriangleLanes& a, const TriangleLanes& b) {
    LocalLanes pair;
    const auto gathered = [](const TriangleLanes& t, std::size_t k) {
        const Vec3 &p = (*t[0])[k], &q = (*t[1])[k], &r = (*t[2])[k], &s = (*t[3])[k];
        return Vector3<Four>{Four{p.x, q.x, r.x, s.x}, Four{p.y, q.y, r.y, s.y},
                             Four{p.z, q.z, r.z, s.z}};
    };
    const Vector3<Four> origin = gathered(a, 0);
    alignas(kAlignment<Four>) std::array<Four, 2> far{};
    for (std::size_t k = 0; k < 3; ++k) {
        pair.a[k] = gathered(a, k) - origin;
        pair.b[k] = gathered(b, k) - origin;
        for (std::size_t i = 0; i < 3; ++i) {
            far[0] = maximum(far[0], absolute(pair.a[k][i]));
            far[1] = maximum(far[1], absolute(pair.b[k][i]));
        }
    }
    pair.extent = 1.7320508075688774 * (1 + 8 * kUnitRoundoff) * (far[0] + far[1]) + kTiny;
    return pair;
}

// As NearestPoints::bound_along(): any direction will do, and proves nothing where it is lost.
Four gap_along(const Vector3<Four>& n, const LocalLanes& pair) {
    const Four zero = every(0.0, n.x);
    const Four a1 = dot(n, pair.a[1]), a2 = dot(n, pair.a[2]);
    const Four b0 = dot(n, pair.b[0]), b1 = dot(n, pair.b[1]), b2 = dot(n, pair.b[2]);
    const Four gap = maximum(smallest(b0, b1, b2) - largest(zero, a1, a2),
                             smallest(zero, a1, a2) - largest(b0, b1, b2));
    const Four square = dot(n, n);
    const auto is_proof = (gap > zero) & (square > every(kLeastSquare, square));
    const Four length = gap / square_root(select(is_proof, square, every(1.0, square)));
    const Four proven = length - 8 * kUnitRoundoff * (length + pair.extent) - kTiny;
    return select(is_proof & (proven > zero), proven, zero);
}

Gaps gaps_of(const Four& lanes) { return {lanes[0], lanes[1], lanes[2], lanes[3]}; }

} // namespace

OBB_WIDE BoxGaps box_gaps(const BasicObb<Four>& boxes, const RoundingBound& bound) {
    const BasicObb<Four> a = shuffled<0, 1, 0, 1>(boxes), b = shuffled<2, 3, 3, 2>(boxes);
    const Vector3<Four> between = b.center - a.center;
    return {gaps_of(distance_square(a, b, bound)), gaps_of(dot(between, between))};
}

OBB_WIDE Gaps quick_gaps(const TriangleLanes& a, const TriangleLanes& b) {
    const LocalLanes pair = localized(a, b);
    const Four zero = every(0.0, pair.extent);
    const Four slack = 4 * kUnitRoundoff * pair.extent + kTiny;
    Four square = zero;
    for (std::size_t k = 0; k < 3; ++k) {
        const Four low_a = smallest(zero, pair.a[1][k], pair.a[2][k]);
        const Four high_a = largest(zero, pair.a[1][k], pair.a[2][k]);
        const Four low_b = smallest(pair.b[0][k], pair.b[1][k], pair.b[2][k]);
        const Four high_b = largest(pair.b[0][k], pair.b[1][k], pair.b[2][k]);
        const Four gap = maximum(maximum(low_b - high_a, low_a - high_b) - slack, zero);
        square += gap * gap;
    }
    const Four between_boxes = square_root(square) * (1 - 8 * kUnitRoundoff);
    const Four along_a = gap_along(cross(pair.a[1], pair.a[2]), pair);
    const Four along_b = gap_along(cross(pair.b[1] - pair.b[0], pair.b[2] - pair.b[0]), pair);
    return gaps_of(maximum(between_boxes, maximum(along_a, along_b)));
}

// Ericson 2004, Real-Time Collision Detection, §5.1.9; the points need not be exact.
OBB_WIDE Gaps edge_gaps(const TriangleLanes& a, const TriangleLanes& b) {
    const LocalLanes pair = localized(a, b);
    const Four zero = every(0.0, pair.extent), one = every(1.0, pair.extent);
    const auto inverse = [&](Four x) {
        return select(x > zero, one / select(x > zero, x, one), zero);
    };
    Corners4 edges_b;
    alignas(kAlignment<Four>) std::array<Four, 3> squares_b, inverse_b;
    for (std::size_t j = 0; j < 3; ++j) {
        edges_b[j] = pair.b[(j + 1) % 3] - pair.b[j];
        squares_b[j] = dot(edges_b[j], edges_b[j]);
        inverse_b[j] = inverse(squares_b[j]);
    }
    Four least = every(std::numeric_limits<double>::infinity(), zero);
    Vector3<Four> between{zero, zero, zero};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector3<Four> d = pair.a[(i + 1) % 3] - pair.a[i];
        const Four dd = dot(d, d);
        const Four inverse_d = inverse(dd);
        for (std::size_t j = 0; j < 3; ++j) {
            const Vector3<Four>& e = edges_b[j];
            const Vector3<Four> r = pair.a[i] - pair.b[j];
            const Four de = dot(d, e), dr = dot(d, r), er = dot(e, r);
            const Four start =
                within_one((de * er - dr * squares_b[j]) * inverse(dd * squares_b[j] - de * de));
            const Four t = within_one((de * start + er) * inverse_b[j]);
            const Four s = within_one((de * t - dr) * inverse_d);
            const Vector3<Four> v{r.x + s * d.x - t * e.x, r.y + s * d.y - t * e.y,
                                  r.z + s * d.z - t * e.z};
            const Four square = dot(v, v);
            const auto is_less = square < least;
            least = select(is_less, square, least);
            for (std::size_t k = 0; k < 3; ++k) {
                between[k] = select(is_less, v[k], between[k]);
            }
        }
    }
    return gaps_of(gap_along(between, pair));
}

} // namespace obb
