#include "shapes/convex_polygon.hpp"

#include <algorithm>
#include <cmath>

namespace obb {
namespace {

// Angles, and lengths for coordinates below one, that are a matter of rounding.
constexpr double kBlurredAngle = 64 * kUnitRoundoff;
constexpr double kBlurredLength = 4 * kUnitRoundoff;

struct Segment {
    Vec3 start, along;
};

[[nodiscard]] double clamped(double numerator, double denominator) {
    return denominator > 0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0;
}

struct Closest {
    Vec3 p, q;
    [[nodiscard]] double square() const { return dot(q - p, q - p); }
};

// Closest points of two segments. Ericson, Real-Time Collision Detection (2005), §5.1.9.
[[nodiscard]] Closest closest_of_segments(const Segment& s, const Segment& t) {
    const Vec3 r = s.start - t.start;
    const double a = dot(s.along, s.along);
    const double b = dot(s.along, t.along);
    const double e = dot(t.along, t.along);
    const double c = dot(s.along, r);
    const double f = dot(t.along, r);
    const Vec3 normal = cross(s.along, t.along);
    // Parallel: any point of s will do, then t's and once more s's nearest.
    double at_s = clamped(dot(cross(t.along, r), normal), dot(normal, normal));
    const double at_t = clamped(b * at_s + f, e);
    at_s = clamped(b * at_t - c, a);
    return {s.start + at_s * s.along, t.start + at_t * t.along};
}

[[nodiscard]] std::size_t edge_count(const ConvexPolygon& p) {
    return p.size() == 2 ? 1 : p.size();
}

[[nodiscard]] Segment edge(const ConvexPolygon& p, std::size_t k) {
    return {p[k], p[(k + 1) % p.size()] - p[k]};
}

[[nodiscard]] Vec3 middle_of_closest(const ConvexPolygon& a, const ConvexPolygon& b) {
    Closest best = closest_of_segments(edge(a, 0), edge(b, 0));
    for (std::size_t i = 0; i < edge_count(a); ++i) {
        for (std::size_t k = 0; k < edge_count(b); ++k) {
            const Closest pair = closest_of_segments(edge(a, i), edge(b, k));
            if (pair.square() < best.square()) {
                best = pair;
            }
        }
    }
    return best.p + 0.5 * (best.q - best.p);
}

[[nodiscard]] Vec3 middle_of_overlap(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v) {
    const double square = dot(u, u);
    const double s0 = dot(q - p, u) / square;
    const double s1 = dot(q + v - p, u) / square;
    const double low = std::max(0.0, std::min(s0, s1));
    const double high = std::min(1.0, std::max(s0, s1));
    return p + (0.5 * std::clamp(low + high, 0.0, 2.0)) * u;
}

[[nodiscard]] Vec3 middle_of_segments(const ConvexPolygon& a, const ConvexPolygon& b) {
    const Vec3 u = a[1] - a[0];
    const Vec3 v = b[1] - b[0];
    const Vec3 normal = cross(u, v);
    if (dot(normal, normal) <= kBlurredAngle * kBlurredAngle * dot(u, u) * dot(v, v)) {
        return middle_of_overlap(a[0], u, b[0], v);
    }
    return middle_of_closest(a, b);
}

// Twice the vector area: sums over all corners, as two edges alone may be nearly parallel.
[[nodiscard]] Vec3 area_normal(const ConvexPolygon& p) {
    Vec3 sum{0, 0, 0};
    for (std::size_t k = 1; k + 1 < p.size(); ++k) {
        sum = sum + cross(p[k] - p[0], p[k + 1] - p[0]);
    }
    return sum;
}

// The same polygon without what rounding leaves no meaning: a sliver is a segment, and a short
// segment is a point.
[[nodiscard]] ConvexPolygon simplified(const ConvexPolygon& p) {
    Segment longest{p[0], Vec3{0, 0, 0}};
    for (std::size_t i = 0; i < p.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const Vec3 d = p[i] - p[k];
            if (dot(d, d) > dot(longest.along, longest.along)) {
                longest = {p[k], d};
            }
        }
    }
    const double length = norm(longest.along);
    if (p.size() > 2 && norm(area_normal(p)) > kBlurredAngle * length * length &&
        length > kBlurredLength) {
        return p;
    }
    ConvexPolygon segment;
    segment.add(longest.start);
    if (length > kBlurredLength) {
        segment.add(longest.start + longest.along);
    }
    return segment;
}

} // namespace

Vec3 ConvexPolygon::middle() const {
    Vec3 sum{0, 0, 0};
    for (std::size_t k = 0; k < count_; ++k) {
        sum = sum + (vertices_[k] - vertices_[0]);
    }
    return vertices_[0] + (1.0 / static_cast<double>(count_)) * sum;
}

ConvexPolygon ConvexPolygon::clipped(const Vec3& normal, double offset) const {
    std::array<double, 12> inside{};
    for (std::size_t k = 0; k < count_; ++k) {
        inside[k] = dot(normal, vertices_[k]) - offset;
    }
    ConvexPolygon result;
    for (std::size_t k = 0; k < (count_ == 2 ? 1 : count_); ++k) {
        const std::size_t next = (k + 1) % count_;
        if (inside[k] >= 0) {
            result.add(vertices_[k]);
        }
        if ((inside[k] > 0 && inside[next] < 0) || (inside[k] < 0 && inside[next] > 0)) {
            const double s = inside[k] / (inside[k] - inside[next]);
            result.add(vertices_[k] + s * (vertices_[next] - vertices_[k]));
        }
    }
    if (count_ == 2 && inside[1] >= 0) {
        result.add(vertices_[1]);
    }
    return result;
}

Vec3 middle_of_common(const ConvexPolygon& whole_a, const ConvexPolygon& whole_b) {
    const ConvexPolygon a = simplified(whole_a);
    const ConvexPolygon b = simplified(whole_b);
    if (a.size() == 1 || b.size() == 1) {
        return a.size() == 1 && b.size() == 1 ? 0.5 * (a[0] + b[0]) : a.size() == 1 ? a[0] : b[0];
    }
    if (a.size() == 2 && b.size() == 2) {
        return middle_of_segments(a, b);
    }
    const bool clip_b = a.size() > 2;
    const ConvexPolygon& clip = clip_b ? a : b;
    ConvexPolygon common = clip_b ? b : a;
    const Vec3 normal = area_normal(clip);
    for (std::size_t k = 0; k < clip.size() && common.size() > 0; ++k) {
        const Vec3 inward = cross(normal, clip[(k + 1) % clip.size()] - clip[k]);
        common = common.clipped(inward, dot(inward, clip[k]));
    }
    return common.size() > 0 ? common.middle() : middle_of_closest(a, b);
}

} // namespace obb
