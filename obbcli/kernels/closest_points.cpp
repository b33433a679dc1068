#include "closest_points.hpp"

#include "extremes.hpp"
#include "scale.hpp"
#include "twofold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace obb {
namespace {

// Products of four lengths occur below: they stay in range for lengths between these, and others
// are scaled by a power of two first.
constexpr double kShortest = 0x1p-100;
constexpr double kLongest = 0x1p100;
// Squares below this may have lost digits to underflow: such a direction proves nothing.
constexpr double kLeastSquare = 0x1p-800;

template <typename Real>
using Corner = Vector3<Real>;
template <typename Real>
using Corners3 = std::array<Vector3<Real>, 3>;

template <typename Real>
[[nodiscard]] Vector3<Real> product(const Vector3<Real>& a, const Vector3<Real>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Two triangles relative to A's first corner and scaled by 2^-exponent. Every corner is off by at
// most the type's roundoff times its distance from there, and so is every point of the triangles:
// the distance changes by no more than roundoff * extent.
template <typename Real>
struct LocalPair {
    Corners3<Real> a, b;
    double extent; // sum of the largest distances of A's and B's corners from the origin, or more
    int exponent;
};

[[nodiscard]] Vec3 difference(const Vec3& p, const Vec3& q, double) { return p - q; }
[[nodiscard]] Vector3<Twofold> difference(const Vec3& p, const Vec3& q, Twofold) {
    return {Twofold(two_sum(p.x, -q.x)), Twofold(two_sum(p.y, -q.y)), Twofold(two_sum(p.z, -q.z))};
}

[[nodiscard]] Vec3 rescaled(const Vec3& v, int exponent) { return scaled(v, exponent); }
[[nodiscard]] Vector3<Twofold> rescaled(const Vector3<Twofold>& v, int exponent) {
    const Vec3 high = scaled({v.x.high, v.y.high, v.z.high}, exponent);
    const Vec3 low = scaled({v.x.low, v.y.low, v.z.low}, exponent);
    return {{high.x, low.x}, {high.y, low.y}, {high.z, low.z}};
}

[[nodiscard]] Vec3 nearest_double(const Vec3& v) { return v; }
[[nodiscard]] Vec3 nearest_double(const Vector3<Twofold>& v) {
    return {v.x.high, v.y.high, v.z.high};
}

template <typename Real>
[[nodiscard]] double reach_of(const Corners3<Real>& corners) {
    return reach(Triangle{nearest_double(corners[0]), nearest_double(corners[1]),
                          nearest_double(corners[2])});
}

template <typename Real>
[[nodiscard]] LocalPair<Real> localized(Triangle a, Triangle b) {
    LocalPair<Real> pair;
    pair.exponent = 0;
    // Differences of the largest doubles overflow. What underflows here is 2^-1000 of the corners.
    if (larger(reach(a), reach(b)) > 0x1p1000) {
        pair.exponent = 64;
        for (std::size_t k = 0; k < 3; ++k) {
            a[k] = 0x1p-64 * a[k];
            b[k] = 0x1p-64 * b[k];
        }
    }
    for (std::size_t k = 0; k < 3; ++k) {
        pair.a[k] = difference(a[k], a[0], Real{});
        pair.b[k] = difference(b[k], a[0], Real{});
    }
    double far_a = reach_of(pair.a), far_b = reach_of(pair.b);
    const double farthest = larger(far_a, far_b);
    if (farthest > 0 && !(farthest >= kShortest && farthest <= kLongest)) {
        const int k = exponent_of(farthest);
        for (std::size_t i = 0; i < 3; ++i) {
            pair.a[i] = rescaled(pair.a[i], -k);
            pair.b[i] = rescaled(pair.b[i], -k);
        }
        pair.exponent += k;
        far_a = reach_of(pair.a);
        far_b = reach_of(pair.b);
    }
    pair.extent = 1.7320508075688774 * (far_a + far_b) * (1 + 8 * kUnitRoundoff);
    return pair;
}

// The edges and the normal of a triangle.
template <typename Real>
struct Sides {
    Corners3<Real> edges; // edge k runs from corner k to the next
    std::array<Real, 3> squares;
    Vector3<Real> normal;
    Real normal_square;

    explicit Sides(const Corners3<Real>& t)
        : edges{t[1] - t[0], t[2] - t[1], t[0] - t[2]},
          squares{dot(edges[0], edges[0]), dot(edges[1], edges[1]), dot(edges[2], edges[2])},
          normal(product(edges[0], edges[1])), normal_square(dot(normal, normal)) {}
};

// A point on each triangle, and a direction along which nothing of one is beyond the other if these
// points are the nearest.
template <typename Real>
struct Nearest {
    Vector3<Real> p, q;
    Real square;
    enum class Kind : unsigned char { kFaceOfA, kFaceOfB, kEdges } kind;
    std::size_t edge_a, edge_b;
    bool inside_a, inside_b; // whether the points lie within their edges and not at an end
};

template <typename Real>
[[nodiscard]] Real clamped(const Real& value) {
    return value < Real(0.0) ? Real(0.0) : value > Real(1.0) ? Real(1.0) : value;
}

template <typename Real>
class Solver {
  public:
    explicit Solver(const LocalPair<Real>& pair) : pair_(pair), a_(pair.a), b_(pair.b) {
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                try_edges(i, j);
            }
        }
        try_face(pair.b, b_, pair.a, Nearest<Real>::Kind::kFaceOfB);
        try_face(pair.a, a_, pair.b, Nearest<Real>::Kind::kFaceOfA);
    }

    [[nodiscard]] const Nearest<Real>& nearest() const { return best_; }

    // Distance of the explicit points. Each is a corner plus one or two edges times factors within
    // [0, 1], of which two sum to at most 1 plus a roundoff. With R the distance of the corners from
    // the origin, edges are at most 2 R long, and the evaluation is off by 7 roundoffs of R, the sum
    // of the factors by 2 more, the corners themselves by 1; their difference and its length by 4
    // of the length.
    [[nodiscard]] double high() const {
        constexpr double kUnit = kRoundoff<Real>;
        const Real length = root_of(best_.square);
        return rounded_up(length + Real(16 * kUnit * (rounded(length) + pair_.extent)));
    }

    // Largest proven distance along the directions that the features give.
    [[nodiscard]] double low() const {
        Real low = bound_along(direction());
        if (!is_tight(low)) {
            low = std::max({low, bound_along(best_.q - best_.p), bound_along(a_.normal),
                            bound_along(b_.normal)});
            for (std::size_t i = 0; i < 3; ++i) {
                low = std::max({low, bound_along(product(a_.normal, a_.edges[i])),
                                bound_along(product(b_.normal, b_.edges[i]))});
                for (std::size_t j = 0; j < 3; ++j) {
                    low = std::max(low, bound_along(product(a_.edges[i], b_.edges[j])));
                }
            }
        }
        return rounded_down(low);
    }

  private:
    // Of two edges. Ericson 2004, Real-Time Collision Detection, §5.1.9. Whatever the factors'
    // error, clamped factors give points of the edges, and every point of an edge will do.
    void try_edges(std::size_t i, std::size_t j) {
        const Vector3<Real>&d = a_.edges[i], &e = b_.edges[j];
        const Vector3<Real> r = pair_.a[i] - pair_.b[j];
        const Real &dd = a_.squares[i], &ee = b_.squares[j];
        const Real f = dot(e, r), c = dot(d, r), g = dot(d, e);
        const Real zero(0.0), one(1.0);
        Real s = zero, t = zero;
        const Real denominator = dd * ee - g * g;
        if (denominator > zero) {
            s = clamped<Real>((g * f - c * ee) / denominator);
        }
        if (ee > zero) {
            t = (g * s + f) / ee;
        }
        if (!(t > zero && t < one)) {
            t = clamped(t);
            s = dd > zero ? clamped<Real>((g * t - c) / dd) : zero;
        }
        consider({pair_.a[i] + s * d, pair_.b[j] + t * e, {}, Nearest<Real>::Kind::kEdges, i, j,
                  s > zero && s < one, t > zero && t < one});
    }

    // Of a face and the corners of the other triangle that lie above it.
    void try_face(const Corners3<Real>& face, const Sides<Real>& sides,
                  const Corners3<Real>& corners, typename Nearest<Real>::Kind kind) {
        if (!(rounded(sides.normal_square) > kLeastSquare)) {
            return;
        }
        const Real zero(0.0), one(1.0);
        const Vector3<Real> u = sides.edges[0], v = -sides.edges[2];
        const Vector3<Real> along_u = product(v, sides.normal), along_v = product(sides.normal, u);
        for (const Vector3<Real>& corner : corners) {
            const Vector3<Real> w = corner - face[0];
            const Real on_u = dot(w, along_u), on_v = dot(w, along_v);
            if (on_u < zero || on_v < zero || on_u + on_v > sides.normal_square) {
                continue;
            }
            const Real x = clamped<Real>(on_u / sides.normal_square);
            const Real y = std::min<Real>(clamped<Real>(on_v / sides.normal_square), one - x);
            const Vector3<Real> foot = face[0] + (x * u + y * v);
            const bool of_b = kind == Nearest<Real>::Kind::kFaceOfB;
            consider({of_b ? corner : foot, of_b ? foot : corner, {}, kind, 0, 0, true, true});
        }
    }

    void consider(Nearest<Real> candidate) {
        const Vector3<Real> v = candidate.q - candidate.p;
        candidate.square = dot(v, v);
        if (!any_ || candidate.square < best_.square) {
            best_ = candidate;
            any_ = true;
        }
    }

    // Where the points are close together their difference is mostly noise; the directions of the
    // features they lie in are not.
    [[nodiscard]] Vector3<Real> direction() const {
        const Vector3<Real> v = best_.q - best_.p;
        if (best_.kind == Nearest<Real>::Kind::kFaceOfA) {
            return a_.normal;
        }
        if (best_.kind == Nearest<Real>::Kind::kFaceOfB) {
            return b_.normal;
        }
        const Vector3<Real>&d = a_.edges[best_.edge_a], &e = b_.edges[best_.edge_b];
        if (best_.inside_a && best_.inside_b) {
            return product(d, e);
        }
        if (best_.inside_a) {
            return v - (dot(v, d) / a_.squares[best_.edge_a]) * d;
        }
        if (best_.inside_b) {
            return v - (dot(v, e) / b_.squares[best_.edge_b]) * e;
        }
        return v;
    }

    // With n any vector whatever, the triangles are at least (min n.b - max n.a) / |n| apart, or
    // the same with -n. The products are off by 3 roundoffs of |n| times the corners' distances,
    // the corners by one, the difference, the length and the quotient by a few of the result.
    [[nodiscard]] Real bound_along(const Vector3<Real>& n) const {
        constexpr double kUnit = kRoundoff<Real>;
        const Real square = dot(n, n);
        if (!(rounded(square) > kLeastSquare)) {
            return Real(0.0);
        }
        const auto& [a0, a1, a2] = pair_.a;
        const auto& [b0, b1, b2] = pair_.b;
        const std::array<Real, 3> on_a{dot(n, a0), dot(n, a1), dot(n, a2)};
        const std::array<Real, 3> on_b{dot(n, b0), dot(n, b1), dot(n, b2)};
        const auto [low_a, high_a] = std::minmax({on_a[0], on_a[1], on_a[2]});
        const auto [low_b, high_b] = std::minmax({on_b[0], on_b[1], on_b[2]});
        const Real gap = std::max<Real>(low_b - high_a, low_a - high_b) / root_of(square);
        const Real error(8 * kUnit * (std::fabs(rounded(gap)) + pair_.extent));
        return std::max<Real>(gap - error, Real(0.0));
    }

    [[nodiscard]] bool is_tight(const Real& low) const {
        const Real length = root_of(best_.square);
        return rounded(length - low) <= 32 * kRoundoff<Real> * (rounded(length) + pair_.extent);
    }

    // To double, one place further out than the nearest one where digits are lost.
    [[nodiscard]] static double rounded_up(double value) { return value; }
    [[nodiscard]] static double rounded_up(const Twofold& value) {
        return value.low > 0 ? std::nextafter(value.high, HUGE_VAL) : value.high;
    }
    [[nodiscard]] static double rounded_down(double value) { return value; }
    [[nodiscard]] static double rounded_down(const Twofold& value) {
        return value.low < 0 ? std::nextafter(value.high, 0.0) : value.high;
    }

    const LocalPair<Real>& pair_;
    Sides<Real> a_, b_;
    Nearest<Real> best_{};
    bool any_ = false;
};

template <typename Real>
[[nodiscard]] TriangleDistance measured(const Triangle& a, const Triangle& b) {
    const LocalPair<Real> pair = localized<Real>(a, b);
    const Solver<Real> solver(pair);
    const auto placed = [&](const Vector3<Real>& p) {
        return a[0] + scaled(nearest_double(p), pair.exponent);
    };
    return {solver.low(), solver.high(), pair.exponent, placed(solver.nearest().p),
            placed(solver.nearest().q)};
}

} // namespace

DistanceBound distance_bound(const Triangle& a, const Triangle& b) {
    const LocalPair<double> pair = localized<double>(a, b);
    double square = 0;
    const double slack = 4 * kUnitRoundoff * pair.extent;
    for (std::size_t k = 0; k < 3; ++k) {
        const double low_a = smallest(pair.a[0][k], pair.a[1][k], pair.a[2][k]);
        const double high_a = largest(pair.a[0][k], pair.a[1][k], pair.a[2][k]);
        const double low_b = smallest(pair.b[0][k], pair.b[1][k], pair.b[2][k]);
        const double high_b = largest(pair.b[0][k], pair.b[1][k], pair.b[2][k]);
        const double gap = larger(larger(low_b - high_a, low_a - high_b) - slack, 0.0);
        square += gap * gap;
    }
    double low = std::sqrt(square) * (1 - 8 * kUnitRoundoff);
    const auto along = [&](const Vec3& n) {
        const double nn = dot(n, n);
        const double a0 = dot(n, pair.a[0]), a1 = dot(n, pair.a[1]), a2 = dot(n, pair.a[2]);
        const double b0 = dot(n, pair.b[0]), b1 = dot(n, pair.b[1]), b2 = dot(n, pair.b[2]);
        const double gap = larger(smallest(b0, b1, b2) - largest(a0, a1, a2),
                                  smallest(a0, a1, a2) - largest(b0, b1, b2));
        if (gap > 0 && nn > kLeastSquare) {
            const double length = gap / std::sqrt(nn);
            low = larger(low, length - 8 * kUnitRoundoff * (length + pair.extent));
        }
    };
    along(cross(pair.a[1], pair.a[2]));
    along(cross(pair.b[1] - pair.b[0], pair.b[2] - pair.b[0]));
    return {low, pair.exponent};
}

TriangleDistance measure(const Triangle& a, const Triangle& b) { return measured<double>(a, b); }

TriangleDistance measure_finely(const Triangle& a, const Triangle& b) {
    return measured<Twofold>(a, b);
}

} // namespace obb
