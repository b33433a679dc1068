#include "nearest/closest_points.hpp"

#include "nearest/localized.hpp"
#include "nearest/nearest_points.hpp"
#include "numbers/twofold.hpp"

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

// Of the pair's extent: how far apart points are that differ by their rounding alone.
constexpr double kPointRounding = 4 * kUnitRoundoff;

struct MeetingPoint {
    Vec3 point;   // of A
    double error; // how far it is from B, of the extent
};

template <typename Real>
[[nodiscard]] MeetingPoint meeting_point(const Triangle& a, const Triangle& b) {
    const LocalPair<Real> pair = localized<Real>(a, b);
    NearestPoints<Real> solver(pair);
    solver.try_all();
    solver.try_crossings();
    const Nearest<Real>& nearest = solver.nearest();
    const double apart = rounded(root_of(nearest.square));
    return {pair.placed(nearest.p), pair.extent > 0 ? apart / pair.extent : 0.0};
}

} // namespace

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

Vector3<Twofold> near_direction(const Triangle& a, const Triangle& b,
                                const NearFeatures& features) {
    const LocalPair<Twofold> pair = localized<Twofold>(a, b);
    NearestPoints<Twofold> solver(pair);
    solver.try_these(features);
    const Nearest<Twofold>& nearest = solver.nearest();
    if (nearest.features.kind == NearFeatures::Kind::kNone) {
        return {};
    }
    const Vector3<Twofold> n = solver.direction();
    const bool is_forward = dot(n, nearest.q - nearest.p) >= Twofold(0.0);
    return rescaled(is_forward ? n : -n, -exponent_of(norm_inf(nearest_double(n))));
}

Vec3 common_point(const Triangle& a, const Triangle& b) {
    if (precedes(b, a)) {
        return common_point(b, a);
    }
    if (const auto [point, error] = meeting_point<double>(a, b); error <= kPointRounding) {
        return point;
    }
    return meeting_point<Twofold>(a, b).point;
}

} // namespace obb
