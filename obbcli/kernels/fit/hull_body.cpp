#include "fit/hull_body.hpp"

#include "numbers/scale.hpp"

#include <cmath>

namespace obb {

HullBody::HullBody(std::span<const Vec3> points, const ConvexHull& hull)
    : facets(hull.triangles), neighbors(hull.neighbors) {
    // Slivers on the rounded grid may have no area at all between the points themselves.
    constexpr double kLeastSine = 0x1p-40;

    std::vector<std::uint32_t> corner_of(points.size());
    for (const std::uint32_t vertex : hull.vertices) {
        corner_of[vertex] = static_cast<std::uint32_t>(corners.size());
        corners.push_back(points[vertex] - points[hull.vertices[0]]);
        reach = std::fmax(reach, norm_inf(corners.back()));
    }
    const int exponent = exponent_of(reach);
    reach = std::ldexp(reach, -exponent);
    for (Vec3& corner : corners) {
        corner = scaled(corner, -exponent);
    }
    for (auto& three : facets) {
        for (std::uint32_t& corner : three) {
            corner = corner_of[corner];
        }
        const Vec3 u = corners[three[1]] - corners[three[0]];
        const Vec3 v = corners[three[2]] - corners[three[0]];
        const Vec3 area = cross(u, v);
        const double size = norm(area);
        const bool is_sound = size > kLeastSine * norm(u) * norm(v);
        areas.push_back(area);
        normals.push_back(is_sound ? (1.0 / size) * area : Vec3{0, 0, 0});
    }
    for (std::uint32_t f = 0; f < facets.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t g = neighbors[f][i];
            if (g < f) {
                continue; // the other facet has it
            }
            const std::uint32_t start = facets[f][i], end = facets[f][(i + 1) % 3];
            std::size_t k = 0;
            while (facets[g][k] == start || facets[g][k] == end) {
                ++k;
            }
            const Vec3 way = corners[end] - corners[start];
            const double length = norm(way);
            edges.push_back({start,
                             end,
                             {facets[f][(i + 2) % 3], facets[g][k]},
                             {f, g},
                             length > 0 ? (1.0 / length) * way : Vec3{0, 0, 0},
                             length});
        }
    }
}

bool HullBody::is_supported(const BodyEdge& edge, Vec3 n, double slack) const {
    const double first = dot(n, corners[edge.apexes[0]] - corners[edge.start]);
    const double second = dot(n, corners[edge.apexes[1]] - corners[edge.start]);
    return (first <= slack && second <= slack) || (first >= -slack && second >= -slack);
}

HullBody::Range HullBody::range_along(Vec3 n) const {
    double low = dot(n, corners[0]), high = low;
    for (const Vec3& p : corners) {
        const double s = dot(n, p);
        low = s < low ? s : low;
        high = s > high ? s : high;
    }
    return {low, high};
}

double HullBody::shadow_area(Vec3 n) const {
    double sum = 0;
    for (const Vec3& area : areas) {
        sum += std::fabs(dot(n, area));
    }
    return 0.25 * sum; // twice the area, seen from both sides
}

// Facets parallel to n but for rounding count as turned away, all of them: a wall of facets some of
// which face the viewer and some not would fold the outline.
Rectangle HullBody::shadow_rectangle(Vec3 n, const Frame& frame) {
    constexpr double kParallel = 1e-9;
    faces_viewer_.resize(facets.size());
    for (std::size_t f = 0; f < facets.size(); ++f) {
        faces_viewer_[f] = dot(n, normals[f]) > kParallel;
    }
    outline_.clear();
    for (const BodyEdge& e : edges) {
        const bool left = faces_viewer_[e.facets[0]] != 0;
        if (left == (faces_viewer_[e.facets[1]] != 0)) {
            continue;
        }
        const double length = left ? e.length : -e.length;
        outline_.push_back({length * dot(frame.u, e.along), length * dot(frame.v, e.along)});
    }
    return least_rectangle(outline_);
}

} // namespace obb
