#include "fit/fit_min_volume.hpp"

#include "fit/box_search.hpp"
#include "fit/fit_hull.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace obb {
namespace {

constexpr std::size_t kJudgedVertices = 4096;

// The best boxes found, no two with about the same axis to begin with.
class Shortlist {
  public:
    explicit Shortlist(std::size_t size) : found_(size) {}

    [[nodiscard]] double limit() const { return found_.back().volume; }
    [[nodiscard]] const auto& found() const { return found_; }

    void offer(const FoundBox& box) {
        constexpr double kSameAxis = 0.999; // within 2.6 degrees
        std::size_t place = found_.size() - 1;
        for (std::size_t k = 0; k < found_.size(); ++k) {
            if (found_[k].volume < kInfinity &&
                std::fabs(dot(found_[k].axes[2], box.axes[2])) > kSameAxis) {
                place = k;
                break;
            }
        }
        if (!found_[place].take(box)) {
            return;
        }
        for (; place > 0 && found_[place].volume < found_[place - 1].volume; --place) {
            std::swap(found_[place], found_[place - 1]);
        }
    }

  private:
    std::vector<FoundBox> found_;
};

// Facets beside one another in one plane are one axis.
bool repeats_neighbor(const HullBody& body, std::size_t facet) {
    for (const std::uint32_t other : body.neighbors[facet]) {
        const Vec3 d = body.normals[facet] - body.normals[other];
        if (other < facet && dot(d, d) < 1e-20) {
            return true;
        }
    }
    return false;
}

void try_facets(HullBody& body, Shortlist& shortlist) {
    for (std::size_t f = 0; f < body.facets.size(); ++f) {
        const Vec3 n = body.normals[f];
        if (n != Vec3{0, 0, 0} && !repeats_neighbor(body, f)) {
            shortlist.offer(boxed_along(body, n, shortlist.limit()));
        }
    }
}

// Edges that two parallel planes may touch, one each, their common normal off all facets: those of
// facets are tried already. With n = e x d, the triple products of n and what leads from an edge
// into its facets are those of the other edge and the facets' normals.
bool are_opposite(const HullBody& body, const BodyEdge& e, const BodyEdge& d) {
    constexpr double kParallel = 1e-9;
    const double e_left = dot(d.along, body.normals[e.facets[0]]);
    const double e_right = dot(d.along, body.normals[e.facets[1]]);
    const double d_left = dot(e.along, body.normals[d.facets[0]]);
    const double d_right = dot(e.along, body.normals[d.facets[1]]);
    return (e_left > kParallel && e_right < -kParallel && d_left > kParallel &&
            d_right < -kParallel) ||
           (e_left < -kParallel && e_right > kParallel && d_left < -kParallel &&
            d_right > kParallel);
}

void try_edge_pairs(HullBody& body, Shortlist& shortlist) {
    for (std::size_t i = 0; i < body.edges.size(); ++i) {
        for (std::size_t k = i + 1; k < body.edges.size(); ++k) {
            const BodyEdge &e = body.edges[i], &d = body.edges[k];
            if (are_opposite(body, e, d)) {
                const Vec3 n = unit_of(cross(e.along, d.along));
                shortlist.offer(boxed_along(body, n, shortlist.limit()));
            }
        }
    }
}

void try_all(HullBody& body, Shortlist& shortlist) {
    try_facets(body, shortlist);
    try_edge_pairs(body, shortlist);
}

Axes least_planar_axes(std::span<const Vec3> points, const ConvexHull& hull) {
    const Axes spread = hull_axes(points, hull);
    const Vec3 origin = points[hull.vertices[0]];
    Vec3 n{0, 0, 0};
    for (const auto& [a, b, c] : hull.triangles) {
        n = n + cross(points[b] - origin, points[c] - origin);
    }
    if (!(norm(n) > 0)) {
        return spread;
    }
    n = unit_of(n);
    const Frame frame(n);
    std::vector<PolygonEdge> edges;
    for (std::size_t k = 0; k < hull.vertices.size(); ++k) {
        const Vec3 e =
            points[hull.vertices[(k + 1) % hull.vertices.size()]] - points[hull.vertices[k]];
        edges.push_back({dot(frame.u, e), dot(frame.v, e)});
    }
    const Rectangle r = least_rectangle(edges);
    if (r.x == 0 && r.y == 0) {
        return spread;
    }
    const Vec3 u = unit_of(r.x * frame.u + r.y * frame.v);
    return {u, cross(n, u), n};
}

} // namespace

Axes min_volume_axes(std::span<const Vec3> points, const MinVolumeEffort& effort) {
    const ConvexHull hull = convex_hull(points, kJudgedVertices);
    if (hull.rank < 2) {
        return hull_axes(points, hull);
    }
    if (hull.rank == 2) {
        return least_planar_axes(points, hull);
    }
    HullBody body(points, hull);
    FoundBox best = boxed(body, FoundBox{}.axes);
    best.take(boxed(body, hull_axes(points, hull)));

    const bool is_large = hull.vertices.size() > effort.searched_vertices;
    // Where all of the hull was searched, only refining could tell the best from the second.
    Shortlist shortlist(is_large || effort.refines ? effort.shortlisted : 1);
    shortlist.offer(best);
    if (is_large) {
        HullBody searched(body.corners, convex_hull(body.corners, effort.searched_vertices));
        try_all(searched, shortlist);
    } else {
        try_all(body, shortlist);
    }
    for (const FoundBox& candidate : shortlist.found()) {
        if (candidate.volume < kInfinity) {
            FoundBox box = boxed(body, candidate.axes);
            if (effort.refines) {
                refine(body, box);
            }
            best.take(box);
        }
    }
    return best.axes;
}

} // namespace obb
