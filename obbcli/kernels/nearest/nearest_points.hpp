// The nearest points of two triangles by their features, and proofs that none are nearer; on
// doubles and on numbers of twice the digits.
#pragma once

#include "nearest/closest_points.hpp"
#include "nearest/localized.hpp"
#include "numbers/twofold.hpp"
#include "numbers/vec.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace obb {

// Squares below this may have lost digits to underflow: such a direction proves nothing.
inline constexpr double kLeastSquare = 0x1p-800;

template <typename Real>
[[nodiscard]] Vector3<Real> product(const Vector3<Real>& a, const Vector3<Real>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A point on each triangle, and whether they lie within their edges rather than at an end.
template <typename Real>
struct Nearest {
    Vector3<Real> p, q;
    NearFeatures features;
    bool inside_a = false, inside_b = false;
    Real square{};
};

template <typename Real>
[[nodiscard]] Real clamped(const Real& value) {
    return value < Real(0.0) ? Real(0.0) : value > Real(1.0) ? Real(1.0) : value;
}

// To double, one place further out than the nearest one where digits are lost.
[[nodiscard]] inline double rounded_up(double value) { return value; }
[[nodiscard]] inline double rounded_up(const Twofold& value) {
    return value.low > 0 ? std::nextafter(value.high, HUGE_VAL) : value.high;
}
[[nodiscard]] inline double rounded_down(double value) { return value; }
[[nodiscard]] inline double rounded_down(const Twofold& value) {
    return value.low < 0 ? std::nextafter(value.high, 0.0) : value.high;
}

template <typename Real>
class NearestPoints {
  public:
    explicit NearestPoints(const LocalPair<Real>& pair)
        : a_(pair.a), b_(pair.b), extent_(pair.extent), edges_a_(edges_of(pair.a)),
          edges_b_(edges_of(pair.b)) {}

    void try_all() {
        for (std::uint8_t i = 0; i < 3; ++i) {
            for (std::uint8_t j = 0; j < 3; ++j) {
                try_edges(i, j);
            }
        }
        const Vector3<Real> normal_a = normal_of(edges_a_), normal_b = normal_of(edges_b_);
        for (std::uint8_t k = 0; k < 3; ++k) {
            try_face_of_a(normal_a, k);
            try_face_of_b(normal_b, k);
        }
    }

    void try_these(const NearFeatures& features) {
        using Kind = NearFeatures::Kind;
        if (features.kind == Kind::kEdges) {
            try_edges(features.part_a, features.part_b);
        } else if (features.kind == Kind::kFaceOfA) {
            try_face_of_a(normal_of(edges_a_), features.part_b);
        } else if (features.kind == Kind::kFaceOfB) {
            try_face_of_b(normal_of(edges_b_), features.part_a);
        }
    }

    // Where triangles intersect, an edge of one passes through the other's face unless features
    // already meet.
    void try_crossings() {
        const Vector3<Real> normal_a = normal_of(edges_a_), normal_b = normal_of(edges_b_);
        for (std::size_t k = 0; k < 3; ++k) {
            Vector3<Real> p, foot;
            if (crosses(b_[0], normal_b, a_[k], edges_a_[k], p) &&
                is_over_face(b_[0], edges_b_, normal_b, p, foot)) {
                consider({p, foot, {NearFeatures::Kind::kFaceOfB}});
            }
            if (crosses(a_[0], normal_a, b_[k], edges_b_[k], p) &&
                is_over_face(a_[0], edges_a_, normal_a, p, foot)) {
                consider({foot, p, {NearFeatures::Kind::kFaceOfA}});
            }
        }
    }

    [[nodiscard]] const Nearest<Real>& nearest() const { return best_; }

    // Distance of the explicit points. Each is a corner plus one or two edges times factors within
    // [0, 1], of which two sum to at most 1 plus a roundoff. With R the distance of the corners
    // from the origin, edges are at most 2 R long, and the evaluation is off by 7 roundoffs of R,
    // the sum of the factors by 2 more, the corners themselves by 1; their difference and its
    // length by 4 of the length.
    [[nodiscard]] double high() const {
        const Real length = root_of(best_.square);
        return rounded_up(length + Real(16 * kUnit * (rounded(length) + extent_)));
    }

    // A proof along the direction that the nearest features give.
    [[nodiscard]] Real low_by_features() const {
        return best_.features.kind == NearFeatures::Kind::kNone ? Real(0.0)
                                                                : bound_along(direction());
    }

    // The best proof of all directions that two triangles can have.
    [[nodiscard]] Real low_by_all() const {
        const Vector3<Real> normal_a = normal_of(edges_a_), normal_b = normal_of(edges_b_);
        Real low = std::max(
            {bound_along(best_.q - best_.p), bound_along(normal_a), bound_along(normal_b)});
        for (std::size_t i = 0; i < 3; ++i) {
            low = std::max({low, bound_along(product(normal_a, edges_a_[i])),
                            bound_along(product(normal_b, edges_b_[i]))});
            for (std::size_t j = 0; j < 3; ++j) {
                low = std::max(low, bound_along(product(edges_a_[i], edges_b_[j])));
            }
        }
        return low;
    }

    [[nodiscard]] bool is_tight(const Real& low) const {
        const Real length = root_of(best_.square);
        return rounded(length - low) <= 32 * kUnit * (rounded(length) + extent_);
    }

    // Where the points are close together their difference is mostly noise; the directions of the
    // features they lie in are not.
    [[nodiscard]] Vector3<Real> direction() const {
        const NearFeatures& f = best_.features;
        if (f.kind != NearFeatures::Kind::kEdges) {
            return normal_of(f.kind == NearFeatures::Kind::kFaceOfA ? edges_a_ : edges_b_);
        }
        const Vector3<Real>&d = edges_a_[f.part_a], &e = edges_b_[f.part_b];
        if (best_.inside_a && best_.inside_b) {
            return product(d, e);
        }
        const Vector3<Real> v = best_.q - best_.p;
        if (best_.inside_a) {
            return v - (dot(v, d) / dot(d, d)) * d;
        }
        return best_.inside_b ? v - (dot(v, e) / dot(e, e)) * e : v;
    }

  private:
    static constexpr double kUnit = kRoundoff<Real>;

    [[nodiscard]] static Corners3<Real> edges_of(const Corners3<Real>& t) {
        return {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    }
    [[nodiscard]] static Vector3<Real> normal_of(const Corners3<Real>& edges) {
        return product(edges[0], edges[1]);
    }

    // Ericson 2004, Real-Time Collision Detection, §5.1.9. Whatever the factors' error, clamped
    // factors give points of the edges, and every point of an edge will do.
    void try_edges(std::uint8_t i, std::uint8_t j) {
        const Vector3<Real>&d = edges_a_[i], &e = edges_b_[j];
        const Vector3<Real> r = a_[i] - b_[j];
        const Real dd = dot(d, d), ee = dot(e, e), de = dot(d, e);
        const Real dr = dot(d, r), er = dot(e, r);
        const Real zero(0.0), one(1.0);
        Real s = zero, t = zero;
        const Real denominator = dd * ee - de * de;
        if (denominator > zero) {
            s = clamped<Real>((de * er - dr * ee) / denominator);
        }
        if (ee > zero) {
            t = (de * s + er) / ee;
        }
        if (!(t > zero && t < one)) {
            t = clamped(t);
            s = dd > zero ? clamped<Real>((de * t - dr) / dd) : zero;
        }
        consider({a_[i] + s * d,
                  b_[j] + t * e,
                  {NearFeatures::Kind::kEdges, i, j},
                  s > zero && s<one, t> zero && t < one});
    }

    void try_face_of_a(const Vector3<Real>& normal, std::uint8_t corner) {
        Vector3<Real> foot;
        if (is_over_face(a_[0], edges_a_, normal, b_[corner], foot)) {
            consider({foot, b_[corner], {NearFeatures::Kind::kFaceOfA, 0, corner}});
        }
    }
    void try_face_of_b(const Vector3<Real>& normal, std::uint8_t corner) {
        Vector3<Real> foot;
        if (is_over_face(b_[0], edges_b_, normal, a_[corner], foot)) {
            consider({a_[corner], foot, {NearFeatures::Kind::kFaceOfB, corner, 0}});
        }
    }

    // The point of an edge that lies in a plane, if the plane has both ends on different sides.
    [[nodiscard]] static bool crosses(const Vector3<Real>& origin, const Vector3<Real>& normal,
                                      const Vector3<Real>& start, const Vector3<Real>& edge,
                                      Vector3<Real>& point) {
        const Real height = -dot(normal, start - origin), rise = dot(normal, edge);
        const Real zero(0.0);
        if (rise < zero ? height > zero || height < rise : height < zero || !(height <= rise)) {
            return false;
        }
        if (!(rise < zero || rise > zero)) {
            return false;
        }
        point = start + clamped<Real>(height / rise) * edge;
        return true;
    }

    [[nodiscard]] static bool is_over_face(const Vector3<Real>& origin, const Corners3<Real>& edges,
                                           const Vector3<Real>& normal, const Vector3<Real>& corner,
                                           Vector3<Real>& foot) {
        const Real square = dot(normal, normal);
        if (!(rounded(square) > kLeastSquare)) {
            return false;
        }
        const Real zero(0.0), one(1.0);
        const Vector3<Real> u = edges[0], v = -edges[2];
        const Vector3<Real> turned = product(normal, corner - origin);
        const Real on_u = dot(v, turned), on_v = -dot(u, turned);
        if (on_u < zero || on_v < zero || on_u + on_v > square) {
            return false;
        }
        const Real x = clamped<Real>(on_u / square);
        const Real y = std::min<Real>(clamped<Real>(on_v / square), one - x);
        foot = origin + (x * u + y * v);
        return true;
    }

    void consider(Nearest<Real> candidate) {
        const Vector3<Real> v = candidate.q - candidate.p;
        candidate.square = dot(v, v);
        if (best_.features.kind == NearFeatures::Kind::kNone || candidate.square < best_.square) {
            best_ = candidate;
        }
    }

    // With n any vector whatever, the triangles are at least (min n.b - max n.a) / |n| apart, or
    // the same with -n. The products are off by 3 roundoffs of |n| times the corners' distances,
    // the corners by one, the difference, the length and the quotient by a few of the result.
    [[nodiscard]] Real bound_along(const Vector3<Real>& n) const {
        const Real square = dot(n, n);
        if (!(rounded(square) > kLeastSquare)) {
            return Real(0.0);
        }
        const std::array<Real, 3> on_a{dot(n, a_[0]), dot(n, a_[1]), dot(n, a_[2])};
        const std::array<Real, 3> on_b{dot(n, b_[0]), dot(n, b_[1]), dot(n, b_[2])};
        const auto [low_a, high_a] = std::minmax({on_a[0], on_a[1], on_a[2]});
        const auto [low_b, high_b] = std::minmax({on_b[0], on_b[1], on_b[2]});
        const Real gap = std::max<Real>(low_b - high_a, low_a - high_b) / root_of(square);
        const Real error(8 * kUnit * (std::fabs(rounded(gap)) + extent_));
        return std::max<Real>(gap - error, Real(0.0));
    }

    const Corners3<Real>&a_, &b_;
    double extent_;
    Corners3<Real> edges_a_, edges_b_;
    Nearest<Real> best_{};
};

} // namespace obb
