#include "convex_polygon.hpp"

#include <algorithm>
#include <cmath>

namespace obb {
namespace {

// Of the lines of segments that are not parallel, the middle of their closest points, kept within
// both segments.
[[nodiscard]] Vec3 middle_of_crossing(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v) {
    const Vec3 normal = cross(u, v);
    const double square = dot(normal, normal);
    const Vec3 d = q - p;
    const double s = std::clamp(dot(cross(d, v), normal) / square, 0.0, 1.0);
    const double t = std::clamp(dot(cross(d, u), normal) / square, 0.0, 1.0);
    return 0.5 * ((p + s * u) + (q + t * v));
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
    // Below this angle the crossing is a matter of rounding, and any common point serves.
    constexpr double kParallel = 64 * kUnitRoundoff;
    if (dot(normal, normal) <= kParallel * kParallel * dot(u, u) * dot(v, v)) {
        return middle_of_overlap(a[0], u, b[0], v);
    }
    return middle_of_crossing(a[0], u, b[0], v);
}

// Twice the vector area: sums over all corners, as two edges alone may be nearly parallel.
[[nodiscard]] Vec3 area_normal(const ConvexPolygon& p) {
    Vec3 sum{0, 0, 0};
    for (std::size_t k = 1; k + 1 < p.size(); ++k) {
        sum = sum + cross(p[k] - p[0], p[k + 1] - p[0]);
    }
    return sum;
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
    std::size_t best = 0;
    for (std::size_t k = 0; k < count_; ++k) {
        inside[k] = dot(normal, vertices_[k]) - offset;
        best = inside[k] > inside[best] ? k : best;
    }
    ConvexPolygon result;
    if (!(inside[best] > 0)) {
        result.add(vertices_[best]);
        return result;
    }
    const std::size_t edge_count = count_ == 2 ? 1 : count_;
    for (std::size_t k = 0; k < edge_count; ++k) {
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

Vec3 middle_of_common(const ConvexPolygon& a, const ConvexPolygon& b) {
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
    for (std::size_t k = 0; k < clip.size() && common.size() > 1; ++k) {
        const Vec3 inward = cross(normal, clip[(k + 1) % clip.size()] - clip[k]);
        common = common.clipped(inward, dot(inward, clip[k]));
    }
    return common.middle();
}

} // namespace obb
