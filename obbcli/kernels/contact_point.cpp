#include "contact_point.hpp"

#include "convex_polygon.hpp"
#include "extremes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace obb {
namespace {

// Power of two that brings the largest magnitude below one.
[[nodiscard]] int exponent_of(double magnitude) {
    int exponent = 0;
    std::frexp(magnitude, &exponent);
    return magnitude == 0 ? 0 : exponent;
}

[[nodiscard]] Vec3 scaled(const Vec3& v, int exponent) {
    return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

[[nodiscard]] Vec3 origin_of(const Triangle& t) { return t[0]; }
[[nodiscard]] Vec3 origin_of(const Obb& box) { return box.center; }

// The shape scaled, relative to an origin that was scaled already, then moved.
[[nodiscard]] Triangle placed(const Triangle& t, const Vec3& origin, const Vec3& way,
                              int exponent) {
    return {(scaled(t[0], exponent) - origin) + way, (scaled(t[1], exponent) - origin) + way,
            (scaled(t[2], exponent) - origin) + way};
}
[[nodiscard]] Obb placed(const Obb& box, const Vec3& origin, const Vec3& way, int exponent) {
    return {(scaled(box.center, exponent) - origin) + way, box.axes,
            scaled(box.half_extents, exponent)};
}

// B's way relative to A until `time`, times 2^exponent; scaled so that nothing overflows early.
[[nodiscard]] Vec3 relative_way(const LinearMotion& motion, double time, int exponent) {
    const int speed = exponent_of(std::max(reach(motion.velocity_a), reach(motion.velocity_b)));
    int moment = 0;
    const double fraction = std::frexp(time, &moment);
    const Vec3 w = scaled(motion.velocity_b, -speed - 1) - scaled(motion.velocity_a, -speed - 1);
    return scaled(fraction * w, speed + 1 + moment + exponent);
}

[[nodiscard]] ConvexPolygon polygon_of(const Triangle& t, const Feature& feature) {
    ConvexPolygon polygon;
    for (std::size_t k = 0; k < 3; ++k) {
        if (((feature.points >> k) & 1u) != 0) {
            polygon.add(t[k]);
        }
    }
    if (feature.dimension + 1u >= polygon.size()) {
        return polygon;
    }
    // Coincident or collinear vertices: keep the two that are furthest apart, or one.
    ConvexPolygon ends;
    std::size_t from = 0, to = 0;
    double longest = -1;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const Vec3 d = polygon[i] - polygon[k];
            if (dot(d, d) > longest) {
                longest = dot(d, d);
                from = k;
                to = i;
            }
        }
    }
    ends.add(polygon[from]);
    if (feature.dimension == 1) {
        ends.add(polygon[to]);
    }
    return ends;
}

[[nodiscard]] ConvexPolygon polygon_of(const Obb& box, const Feature& feature) {
    Vec3 base = box.center;
    std::array<Vec3, 3> free{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 arm = box.half_extents[i] * box.axes[i];
        if (feature.signs[i] != 0) {
            base = base + static_cast<double>(feature.signs[i]) * arm;
        } else if (box.half_extents[i] != 0) {
            free[count++] = arm;
        }
    }
    ConvexPolygon polygon;
    if (count == 0) {
        polygon.add(base);
    } else if (count == 1) {
        polygon.add(base - free[0]);
        polygon.add(base + free[0]);
    } else {
        polygon.add(base - free[0] - free[1]);
        polygon.add(base + free[0] - free[1]);
        polygon.add(base + free[0] + free[1]);
        polygon.add(base - free[0] + free[1]);
    }
    return polygon;
}

struct HalfSpace {
    Vec3 normal;
    double offset; // inside: dot(normal, x) <= offset
};

template <typename Visit>
void visit_half_spaces(const Triangle& t, Visit&& visit) {
    const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
    visit(HalfSpace{normal, dot(normal, t[0])});
    visit(HalfSpace{-normal, -dot(normal, t[0])});
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 outward = cross(t[(k + 1) % 3] - t[k], normal);
        visit(HalfSpace{outward, dot(outward, t[k])});
    }
}

template <typename Visit>
void visit_half_spaces(const Obb& box, Visit&& visit) {
    for (std::size_t i = 0; i < 3; ++i) {
        // The literal box's face normal, as its axes need not be quite orthogonal.
        const Vec3 normal = cross(box.axes[(i + 1) % 3], box.axes[(i + 2) % 3]);
        const double middle = dot(normal, box.center);
        const double radius = box.half_extents[i] * std::fabs(dot(normal, box.axes[i]));
        visit(HalfSpace{normal, middle + radius});
        visit(HalfSpace{-normal, radius - middle});
    }
}

[[nodiscard]] bool has_interior(const Triangle& t) {
    return !(cross(t[1] - t[0], t[2] - t[0]) == Vec3{0, 0, 0});
}
[[nodiscard]] bool has_interior(const Obb&) { return true; }

template <typename Visit>
void visit_edges(const Triangle& t, Visit&& visit) {
    for (std::size_t k = 0; k < 3; ++k) {
        visit(t[k], t[(k + 1) % 3]);
    }
}

template <typename Visit>
void visit_edges(const Obb& box, Visit&& visit) {
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 along = box.half_extents[i] * box.axes[i];
        const Vec3 u = box.half_extents[(i + 1) % 3] * box.axes[(i + 1) % 3];
        const Vec3 v = box.half_extents[(i + 2) % 3] * box.axes[(i + 2) % 3];
        for (const Vec3& corner : {u + v, u - v, v - u, -(u + v)}) {
            visit(box.center + corner - along, box.center + corner + along);
        }
    }
}

// Gathers where the edges of one shape run inside another, and the nearest to that.
class EdgeSearch {
  public:
    template <typename Edges, typename Body>
    void search(const Edges& edges, const Body& body) {
        if (!has_interior(body)) {
            return;
        }
        visit_edges(edges, [&](const Vec3& from, const Vec3& to) { clip(from, to, body); });
    }

    [[nodiscard]] Vec3 middle() const { return count_ > 0 ? (1 / count_) * sum_ : nearest_; }

  private:
    template <typename Body>
    void clip(const Vec3& from, const Vec3& to, const Body& body) {
        double low = 0, high = 1;
        double outside = 0;
        const Vec3 along = to - from;
        visit_half_spaces(body, [&](const HalfSpace& h) {
            const double start = dot(h.normal, from) - h.offset;
            const double rise = dot(h.normal, along);
            if (rise > 0) {
                high = std::min(high, -start / rise);
            } else if (rise < 0) {
                low = std::max(low, -start / rise);
            } else if (start > 0) {
                outside = std::max(outside, start);
            }
        });
        const double score = outside > 0 ? -1 - outside : high - low;
        const Vec3 point = from + std::clamp(0.5 * (low + high), 0.0, 1.0) * along;
        if (score >= 0) {
            sum_ = sum_ + point;
            ++count_;
        }
        if (!any_ || score > best_) {
            any_ = true;
            best_ = score;
            nearest_ = point;
        }
    }

    Vec3 sum_{0, 0, 0};
    double count_ = 0;
    bool any_ = false;
    double best_ = 0;
    Vec3 nearest_{0, 0, 0};
};

[[nodiscard]] Vec3 unit(const Vec3& v, const Vec3& otherwise) {
    const double size = reach(v);
    if (!(size > 0)) {
        return otherwise;
    }
    const Vec3 w = scaled(v, -exponent_of(size));
    return (1 / norm(w)) * w;
}

} // namespace

template <typename A, typename B>
Vec3 contact_point(const A& a, const B& b, const LinearMotion& motion, double time,
                   const Touch& touch) {
    const int exponent = exponent_of(larger(reach(a), reach(b))) + 1;
    const Vec3 origin = scaled(origin_of(a), -exponent);
    const A at_a = placed(a, origin, Vec3{0, 0, 0}, -exponent);
    const B at_b = placed(b, origin, relative_way(motion, time, -exponent), -exponent);
    Vec3 point;
    if (touch.axis.kind != AxisKind::kNone) {
        point =
            middle_of_common(polygon_of(at_a, touch.feature_a), polygon_of(at_b, touch.feature_b));
    } else {
        EdgeSearch edges;
        edges.search(at_a, at_b);
        edges.search(at_b, at_a);
        point = edges.middle();
    }
    return scaled(origin + point, exponent) + time * motion.velocity_a;
}

template Vec3 contact_point(const Triangle&, const Triangle&, const LinearMotion&, double,
                            const Touch&);
template Vec3 contact_point(const Obb&, const Triangle&, const LinearMotion&, double, const Touch&);
template Vec3 contact_point(const Obb&, const Obb&, const LinearMotion&, double, const Touch&);

Vec3 face_normal(const Triangle& triangle, const Feature&, const Vec3& towards) {
    const int exponent = -exponent_of(reach(triangle)) - 1;
    const Vec3 origin = scaled(triangle[0], exponent);
    const Vec3 u = scaled(triangle[1], exponent) - origin;
    const Vec3 v = scaled(triangle[2], exponent) - origin;
    const Vec3 normal =
        unit(cross(scaled(u, -exponent_of(reach(u))), scaled(v, -exponent_of(reach(v)))), towards);
    return dot(normal, towards) < 0 ? -normal : normal;
}

Vec3 face_normal(const Obb& box, const Feature& feature, const Vec3& towards) {
    Vec3 best = towards;
    double most = -2;
    if (feature.dimension == 3) {
        return best;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 axis = unit(box.axes[i], towards);
        for (const int side : {-1, 1}) {
            const Vec3 normal = static_cast<double>(side) * axis;
            const bool lies_in =
                feature.dimension == 3 || feature.signs[i] == side || box.half_extents[i] == 0;
            if (lies_in && dot(normal, towards) > most) {
                most = dot(normal, towards);
                best = normal;
            }
        }
    }
    return best;
}

Vec3 smooth_normal(const Triangle&, const Vec3&, const Vec3& normal) { return normal; }

Vec3 smooth_normal(const Obb& box, const Vec3& point, const Vec3& normal) {
    const Vec3 h = box.half_extents;
    // The gradient sum (x_i / a_i^2) A_i times the smallest extent: a flat box tends to its face.
    const double least = std::min({h.x, h.y, h.z});
    if (!(least > 0)) {
        return normal;
    }
    const Vec3 d = point - box.center;
    Vec3 gradient{0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        const double along = dot(box.axes[i], d) / h[i];
        gradient = gradient + (along * (least / h[i])) * box.axes[i];
    }
    return unit(gradient, normal);
}

} // namespace obb
