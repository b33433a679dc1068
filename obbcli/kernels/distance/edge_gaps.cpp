// Four pairs of triangles in doubles: along the direction between the nearest points of edges.
#include "distance/triangle_blocks.hpp"
#include "nearest/nearest_points.hpp"
#include "numbers/lane_vectors.hpp"

#include <limits>

namespace obb {

namespace {

constexpr double kTiny = 0x1p-900; // what coordinates and products lose to underflow

template <typename Real>
OBB_INLINE Real smallest(const Real& a, const Real& b, const Real& c) {
    return lower(lower(a, b), c);
}
template <typename Real>
OBB_INLINE Real largest(const Real& a, const Real& b, const Real& c) {
    return upper(upper(a, b), c);
}
// A NaN becomes 0.
template <typename Real>
OBB_INLINE Real within_one(const Real& a) {
    return lower(upper(a, Real{}), Real(1.0));
}
template <typename Real>
OBB_INLINE Real inverse(const Real& a) {
    const auto is_positive = a > Real{};
    return select(is_positive, Real(1.0) / select(is_positive, a, Real(1.0)), Real{});
}

// Relative to A's first corner, as LocalPair.
template <typename Real>
struct LocalLanes {
    LaneTriangles<Real> a, b; // a[0] is the origin
    Real extent;
};

template <std::size_t kBytes>
OBB_INLINE LocalLanes<Doubles<kBytes>> localized(const TriangleBlock& a, const TriangleBlock& b,
                                                 const ScaleFactors& factors,
                                                 const PairsInLanes& pairs) {
    using Real = Doubles<kBytes>;
    std::array<std::uint32_t, 8> places; // of A's triangles, then of B's
    for (std::size_t lane = 0; lane < 4; ++lane) {
        places[lane] = pairs[lane] % 4;
        places[4 + lane] = second_of_pair(pairs[lane]);
    }
    const auto gathered = [&](const std::array<double, 4>& of,
                              std::size_t first) __attribute__((always_inline)) {
        const std::array<double, 4> lanes{of[places[first]], of[places[first + 1]],
                                          of[places[first + 2]], of[places[first + 3]]};
        return Real(factors[1]) * (Real(factors[0]) * Real::at(lanes.data()));
    };
    LocalLanes<Real> local;
    Real far_a{}, far_b{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Real origin = gathered(a.corners[0][i], 0);
        for (std::size_t k = 0; k < 3; ++k) {
            local.a[k][i] = gathered(a.corners[k][i], 0) - origin;
            local.b[k][i] = gathered(b.corners[k][i], 4) - origin;
            far_a = upper(far_a, magnitude(local.a[k][i]));
            far_b = upper(far_b, magnitude(local.b[k][i]));
        }
    }
    local.extent =
        Real(1.7320508075688774 * (1 + 8 * kUnitRoundoff)) * (far_a + far_b) + Real(kTiny);
    return local;
}

// As NearestPoints::bound_along(): any direction will do, and proves nothing where it is lost.
template <typename Real>
OBB_INLINE Real gap_along(const Lanes3<Real>& n, const LocalLanes<Real>& pair) {
    const Real a1 = inner(n, pair.a[1]), a2 = inner(n, pair.a[2]);
    const Real b0 = inner(n, pair.b[0]), b1 = inner(n, pair.b[1]), b2 = inner(n, pair.b[2]);
    const Real gap = upper(smallest(b0, b1, b2) - largest(Real{}, a1, a2),
                           smallest(Real{}, a1, a2) - largest(b0, b1, b2));
    const Real square = inner(n, n);
    const auto is_proof = (gap > Real{}) & (square > Real(kLeastSquare));
    const Real length = gap / root_of(select(is_proof, square, Real(1.0)));
    const Real proven = length - Real(8 * kUnitRoundoff) * (length + pair.extent) - Real(kTiny);
    return select(is_proof, upper(proven, Real{}), Real{});
}

// Ericson 2004, Real-Time Collision Detection, §5.1.9; the points need not be exact.
template <std::size_t kBytes>
OBB_INLINE void measure(const LocalLanes<Doubles<kBytes>>& pair, std::array<double, 4>& gaps) {
    using Real = Doubles<kBytes>;
    LaneTriangles<Real> edges_b;
    std::array<Real, 3> squares_b, inverse_b;
    for (std::size_t j = 0; j < 3; ++j) {
        edges_b[j] = difference(pair.b[(j + 1) % 3], pair.b[j]);
        squares_b[j] = inner(edges_b[j], edges_b[j]);
        inverse_b[j] = inverse(squares_b[j]);
    }
    Real least(std::numeric_limits<double>::infinity());
    Lanes3<Real> between{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Lanes3<Real> d = difference(pair.a[(i + 1) % 3], pair.a[i]);
        const Real dd = inner(d, d);
        const Real inverse_d = inverse(dd);
        for (std::size_t j = 0; j < 3; ++j) {
            const Lanes3<Real>& e = edges_b[j];
            const Lanes3<Real> r = difference(pair.a[i], pair.b[j]);
            const Real de = inner(d, e), dr = inner(d, r), er = inner(e, r);
            const Real start = within_one<Real>((de * er - dr * squares_b[j]) *
                                                inverse<Real>(dd * squares_b[j] - de * de));
            const Real t = within_one<Real>((de * start + er) * inverse_b[j]);
            const Real s = within_one<Real>((de * t - dr) * inverse_d);
            const Lanes3<Real> v{r[0] + s * d[0] - t * e[0], r[1] + s * d[1] - t * e[1],
                                 r[2] + s * d[2] - t * e[2]};
            const Real square = inner(v, v);
            const auto is_less = square < least;
            least = select(is_less, square, least);
            for (std::size_t k = 0; k < 3; ++k) {
                between[k] = select(is_less, v[k], between[k]);
            }
        }
    }
    gap_along(between, pair).store(gaps.data());
}

} // namespace

std::array<double, 4> edge_gaps(const TriangleBlock& a, const TriangleBlock& b,
                                const ScaleFactors& factors, const PairsInLanes& pairs) {
    std::array<double, 4> gaps;
    in_registers([&]<std::size_t kBytes>() {
        measure<kBytes>(localized<kBytes>(a, b, factors, pairs), gaps);
    });
    return gaps;
}

} // namespace obb
