// A convex body as searches for its least box want it: corners, facets with normals, edges.
#pragma once

#include "fit/calipers.hpp"
#include "fit/convex_hull.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace obb {

struct BodyEdge {
    std::uint32_t start, end;            // corners
    std::array<std::uint32_t, 2> apexes; // corners of the two facets off the edge
    std::array<std::uint32_t, 2> facets; // left and right of the edge seen from outside
    Vec3 along;                          // of unit length
    double length;
};

// Of rank 3, about its first vertex, and of a size where products neither overflow nor vanish.
struct HullBody {
    std::vector<Vec3> corners;
    std::vector<Vec3> normals; // of unit length and outward, zero where rounding leaves none
    std::vector<Vec3> areas;   // normals by twice the area
    std::vector<std::array<std::uint32_t, 3>> facets;
    std::vector<std::array<std::uint32_t, 3>> neighbors;
    std::vector<BodyEdge> edges;
    double reach = 0; // of the corners from the first

    HullBody(std::span<const Vec3> points, const ConvexHull& hull);

    // Whether the plane through an edge across n supports the body there, on one side or the other.
    [[nodiscard]] bool is_supported(const BodyEdge& edge, Vec3 n, double slack) const;

    struct Range {
        double low, high;
    };
    [[nodiscard]] Range range_along(Vec3 n) const;
    // Of the body's shadow along n.
    [[nodiscard]] double shadow_area(Vec3 n) const;
    // The least rectangle about that shadow; its direction in the frame about n.
    [[nodiscard]] Rectangle shadow_rectangle(Vec3 n, const Frame& frame);

  private:
    std::vector<std::uint8_t> faces_viewer_;
    std::vector<PolygonEdge> outline_;
};

} // namespace obb
