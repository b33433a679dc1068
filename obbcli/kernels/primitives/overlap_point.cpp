#include "primitives/overlap_point.hpp"

#include "shapes/extremes.hpp"
#include "shapes/scaled_shapes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace obb {
namespace {

struct HalfSpace {
    Vec3 normal; // unit
    Vec3 anchor; // inside: dot(normal, x - anchor) <= 0
};

template <typename Visit>
void visit_half_spaces(const Triangle& t, Visit&& visit) {
    const Vec3 normal = unit_normal(t, Vec3{0, 0, 0});
    visit(HalfSpace{normal, t[0]});
    visit(HalfSpace{-normal, t[0]});
    for (std::size_t k = 0; k < 3; ++k) {
        visit(HalfSpace{unit_by_powers(cross(t[(k + 1) % 3] - t[k], normal), Vec3{0, 0, 0}), t[k]});
    }
}

template <typename Visit>
void visit_half_spaces(const Obb& box, Visit&& visit) {
    for (std::size_t i = 0; i < 3; ++i) {
        // The literal box's face normal, as its axes need not be quite orthogonal.
        const Vec3 cross_axis = cross(box.axes[(i + 1) % 3], box.axes[(i + 2) % 3]);
        const Vec3 normal = dot(cross_axis, box.axes[i]) < 0 ? -cross_axis : cross_axis;
        const Vec3 arm = box.half_extents[i] * box.axes[i];
        visit(HalfSpace{normal, box.center + arm});
        visit(HalfSpace{-normal, box.center - arm});
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

// How far a point is outside a shape, at least.
template <typename Body>
[[nodiscard]] double outside(const Vec3& point, const Body& body) {
    double result = 0;
    visit_half_spaces(body, [&](const HalfSpace& h) {
        result = larger(result, dot(h.normal, point - h.anchor));
    });
    return result;
}

// The edges of one shape that run inside another, of which shapes that overlap have one at least.
class EdgeSearch {
  public:
    template <typename Edges, typename Body>
    void search(const Edges& edges, const Body& body) {
        visit_edges(edges, [&](const Vec3& from, const Vec3& to) {
            const Vec3 along = to - from;
            double low = 0, high = 1;
            visit_half_spaces(body, [&](const HalfSpace& h) {
                const double start = dot(h.normal, from - h.anchor);
                const double rise = dot(h.normal, along);
                if (rise > 0) {
                    high = smaller(high, -start / rise);
                } else if (rise < 0) {
                    low = larger(low, -start / rise);
                }
            });
            const Vec3 point = from + std::clamp(0.5 * (low + high), 0.0, 1.0) * along;
            if (low <= high && outside(point, body) <= 4 * kUnitRoundoff) {
                sum_ = sum_ + point;
                ++count_;
            }
        });
    }

    // Where rounding hid all those: the place where an edge passes a face that is outside by least.
    template <typename Edges, typename Body>
    void search_nearest(const Edges& edges, const Body& body) {
        visit_edges(edges, [&](const Vec3& from, const Vec3& to) {
            const Vec3 along = to - from;
            visit_half_spaces(body, [&](const HalfSpace& h) {
                const double rise = dot(h.normal, along);
                const double at = rise == 0 ? 0 : -dot(h.normal, from - h.anchor) / rise;
                const Vec3 point = from + std::clamp(at, 0.0, 1.0) * along;
                const double distance = outside(point, body);
                if (distance < least_) {
                    least_ = distance;
                    nearest_ = point;
                }
            });
        });
    }

    [[nodiscard]] bool found() const { return count_ > 0; }
    [[nodiscard]] Vec3 middle() const { return (1 / count_) * sum_; }
    [[nodiscard]] Vec3 nearest() const { return nearest_; }

  private:
    Vec3 sum_{0, 0, 0};
    double count_ = 0;
    double least_ = std::numeric_limits<double>::infinity();
    Vec3 nearest_{0, 0, 0};
};

// A shape without area or extent bounds nothing, and its edges are all there is of it.
template <typename A, typename B, typename Search>
void search_both(const A& a, const B& b, const Search& search) {
    if (has_interior(b)) {
        search(a, b);
    }
    if (has_interior(a)) {
        search(b, a);
    }
}

} // namespace

template <typename A, typename B>
Vec3 overlap_point(const A& a, const B& b) {
    EdgeSearch edges;
    search_both(a, b, [&](const auto& p, const auto& q) { edges.search(p, q); });
    if (edges.found()) {
        return edges.middle();
    }
    search_both(a, b, [&](const auto& p, const auto& q) { edges.search_nearest(p, q); });
    return edges.nearest();
}

template Vec3 overlap_point(const Triangle&, const Triangle&);
template Vec3 overlap_point(const Obb&, const Triangle&);
template Vec3 overlap_point(const Obb&, const Obb&);

} // namespace obb
