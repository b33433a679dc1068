// The hull of points that span space, grown from a tetrahedron. Barber, Dobkin and Huhdanpaa 1996,
// The quickhull algorithm for convex hulls.
#pragma once

#include "fit/convex_hull.hpp"
#include "fit/grid_points.hpp"

#include <queue>

namespace obb {

// With exact signs the lemmas of the paper hold for points in any position: a point outside sees a
// facet strictly; what strictly sees a removed facet and is not inside afterwards strictly sees one
// of the new ones; no new facet is flat; and the facets that a point sees are bounded by one
// simple cycle. So each step takes one more point in, and the loop ends.
class QuickHull {
  public:
    // The first four points span space; the points must outlive the hull.
    QuickHull(std::span<const Vec3> grid, const std::array<std::uint32_t, 4>& simplex);

    void grow(std::size_t max_vertices);
    [[nodiscard]] ConvexHull result() const;

  private:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    struct Facet {
        std::array<std::uint32_t, 3> corners;
        std::array<std::uint32_t, 3> neighbors{};
        Vec3 normal{};               // outward, as doubles have it
        double error = 0;            // what a height over the facet, times |normal|, may be off by
        double reach = 0;            // of the farthest point outside, times |normal|
        std::uint32_t first = kNone; // list of points outside
        std::uint32_t farthest = kNone;
        bool is_alive = true;
        bool is_seen = false;
    };
    struct Edge {
        std::uint32_t start, end;
        std::uint32_t beyond; // the facet that stays
    };
    struct Candidate {
        double distance;
        std::uint32_t facet;
        [[nodiscard]] bool operator<(const Candidate& other) const {
            return distance != other.distance ? distance < other.distance : facet > other.facet;
        }
    };

    [[nodiscard]] std::uint32_t add_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    [[nodiscard]] double height(const Facet& facet, std::uint32_t point) const;
    [[nodiscard]] bool is_outside(const Facet& facet, std::uint32_t point, double height) const;
    void assign(std::uint32_t point, std::span<const std::uint32_t> facets);
    void offer(std::uint32_t facet);
    void add_point(std::uint32_t seen_from, std::uint32_t point);
    void find_horizon(std::uint32_t facet, std::uint32_t point);
    void cover(std::uint32_t point);

    std::span<const Vec3> grid_;
    std::vector<Facet> facets_;
    std::vector<std::uint32_t> next_; // of the points outside the same facet
    std::vector<std::uint32_t> vertices_;
    std::priority_queue<Candidate> candidates_;
    std::vector<std::uint32_t> seen_;
    std::vector<Edge> horizon_;
    std::vector<std::uint32_t> new_facets_;
    std::vector<std::uint32_t> facet_from_; // of a horizon's vertex, while it is covered
};

} // namespace obb
