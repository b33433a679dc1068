#include "closest_points.hpp"

#include "extremes.hpp"
#include "local_pair.hpp"
#include "nearest_points.hpp"
#include "twofold.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace obb {
namespace {

template <typename Real>
[[nodiscard]] TriangleDistance measured(const Triangle& a, const Triangle& b,
                                        const NearFeatures& features) {
    const LocalPair<Real> pair = localized<Real>(a, b);
    NearestPoints<Real> solver(pair);
    solver.try_these(features);
    Real low = solver.low_by_features();
    // With more digits a corner may turn out to lie beside the face it seemed to be above.
    if (solver.nearest().features.kind == NearFeatures::Kind::kNone || !solver.is_tight(low)) {
        solver.try_all();
        low = std::max(low, solver.low_by_features());
    }
    if (!solver.is_tight(low)) {
        low = std::max(low, solver.low_by_all());
    }
    const Nearest<Real>& nearest = solver.nearest();
    return {rounded_down(low), solver.high(),          pair.exponent,
            nearest.features,  pair.placed(nearest.p), pair.placed(nearest.q)};
}

[[nodiscard]] NearFeatures swapped(const NearFeatures& f) {
    using Kind = NearFeatures::Kind;
    const Kind kind = f.kind == Kind::kFaceOfA   ? Kind::kFaceOfB
                      : f.kind == Kind::kFaceOfB ? Kind::kFaceOfA
                                                 : f.kind;
    return {kind, f.part_b, f.part_a};
}

// In one order of the two, so that swapping them swaps the points and changes no digit.
template <typename Real>
[[nodiscard]] TriangleDistance measured_in_order(const Triangle& a, const Triangle& b,
                                                 const NearFeatures& features) {
    if (!precedes(b, a)) {
        return measured<Real>(a, b, features);
    }
    TriangleDistance found = measured<Real>(b, a, swapped(features));
    std::swap(found.point_a, found.point_b);
    found.features = swapped(found.features);
    return found;
}

} // namespace

DistanceBound distance_bound(const Triangle& a, const Triangle& b) {
    const LocalPair<double> pair = localized<double>(a, b);
    double square = 0;
    const double slack = 4 * kUnitRoundoff * pair.extent;
    for (std::size_t k = 0; k < 3; ++k) {
        const double low_a = smallest(0.0, pair.a[1][k], pair.a[2][k]);
        const double high_a = largest(0.0, pair.a[1][k], pair.a[2][k]);
        const double low_b = smallest(pair.b[0][k], pair.b[1][k], pair.b[2][k]);
        const double high_b = largest(pair.b[0][k], pair.b[1][k], pair.b[2][k]);
        const double gap = larger(larger(low_b - high_a, low_a - high_b) - slack, 0.0);
        square += gap * gap;
    }
    double low = std::sqrt(square) * (1 - 8 * kUnitRoundoff);
    const auto along = [&](const Vec3& n) {
        const double a1 = dot(n, pair.a[1]), a2 = dot(n, pair.a[2]);
        const double b0 = dot(n, pair.b[0]), b1 = dot(n, pair.b[1]), b2 = dot(n, pair.b[2]);
        const double gap = larger(smallest(b0, b1, b2) - largest(0.0, a1, a2),
                                  smallest(0.0, a1, a2) - largest(b0, b1, b2));
        const double nn = dot(n, n);
        if (gap > 0 && nn > kLeastSquare) {
            // As NearestPoints::bound_along().
            const double length = gap / std::sqrt(nn);
            low = larger(low, length - 8 * kUnitRoundoff * (length + pair.extent));
        }
    };
    along(cross(pair.a[1], pair.a[2]));
    along(cross(pair.b[1] - pair.b[0], pair.b[2] - pair.b[0]));
    return {low, pair.exponent};
}

bool precedes(const Triangle& a, const Triangle& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (a[k][i] != b[k][i]) {
                return a[k][i] < b[k][i];
            }
        }
    }
    return false;
}

TriangleDistance measure(const Triangle& a, const Triangle& b) {
    return measured_in_order<double>(a, b, {});
}

TriangleDistance measure_finely(const Triangle& a, const Triangle& b,
                                const NearFeatures& features) {
    return measured_in_order<Twofold>(a, b, features);
}

Vec3 common_point(const Triangle& a, const Triangle& b) {
    if (precedes(b, a)) {
        return common_point(b, a);
    }
    const LocalPair<Twofold> pair = localized<Twofold>(a, b);
    NearestPoints<Twofold> solver(pair);
    solver.try_all();
    solver.try_crossings();
    return pair.placed(solver.nearest().p);
}

} // namespace obb
