#include "fit/quick_hull.hpp"

#include <cmath>
#include <utility>

namespace obb {

QuickHull::QuickHull(std::span<const Vec3> grid, const std::array<std::uint32_t, 4>& simplex)
    : grid_(grid), next_(grid.size(), kNone), vertices_(simplex.begin(), simplex.end()),
      facet_from_(grid.size(), kNone) {
    auto [a, b, c, d] = simplex;
    const Vec3 p = grid[a];
    if (exact_triple_sign(grid[b] - p, grid[c] - p, grid[d] - p) > 0) {
        std::swap(b, c);
    }
    // Seen from outside, as d lies below a, b, c.
    new_facets_ = {add_facet(a, b, c), add_facet(a, d, b), add_facet(b, d, c), add_facet(c, d, a)};
    facets_[0].neighbors = {1, 2, 3};
    facets_[1].neighbors = {3, 2, 0};
    facets_[2].neighbors = {1, 3, 0};
    facets_[3].neighbors = {2, 1, 0};
    for (std::uint32_t i = 0; i < grid.size(); ++i) {
        assign(i, new_facets_);
    }
    for (const std::uint32_t facet : new_facets_) {
        offer(facet);
    }
}

// A triple product of exact differences is off by at most gamma_6 times its permanent.
std::uint32_t QuickHull::add_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    constexpr double kTripleError = 8 * kUnitRoundoff;
    const Vec3 u = grid_[b] - grid_[a], v = grid_[c] - grid_[a];
    Facet facet;
    facet.corners = {a, b, c};
    facet.normal = cross(u, v);
    facet.error = kTripleError * norm_1(u) * norm_1(v) * kGridReach;
    facets_.push_back(facet);
    return static_cast<std::uint32_t>(facets_.size() - 1);
}

double QuickHull::height(const Facet& facet, std::uint32_t point) const {
    return dot(facet.normal, grid_[point] - grid_[facet.corners[0]]);
}

bool QuickHull::is_outside(const Facet& facet, std::uint32_t point, double height) const {
    if (std::fabs(height) > facet.error) {
        return height > 0;
    }
    const auto& [a, b, c] = facet.corners;
    const Vec3 p = grid_[a];
    return exact_triple_sign(grid_[b] - p, grid_[c] - p, grid_[point] - p) > 0;
}

// Puts a point into the list of the first facet that it sees; what sees none is inside.
void QuickHull::assign(std::uint32_t point, std::span<const std::uint32_t> facets) {
    for (const std::uint32_t index : facets) {
        Facet& facet = facets_[index];
        const double h = height(facet, point);
        if (!is_outside(facet, point, h)) {
            continue;
        }
        next_[point] = facet.first;
        facet.first = point;
        // Of equally far ones the first by coordinates, whatever the order of the points.
        if (facet.farthest == kNone || h > facet.reach ||
            (h == facet.reach && comes_before(grid_[point], grid_[facet.farthest]))) {
            facet.farthest = point;
            facet.reach = h;
        }
        return;
    }
}

void QuickHull::offer(std::uint32_t facet) {
    if (facets_[facet].farthest != kNone) {
        candidates_.push({facets_[facet].reach / norm(facets_[facet].normal), facet});
    }
}

void QuickHull::grow(std::size_t max_vertices) {
    while (!candidates_.empty() && vertices_.size() < max_vertices) {
        const std::uint32_t facet = candidates_.top().facet;
        candidates_.pop();
        if (facets_[facet].is_alive) {
            add_point(facet, facets_[facet].farthest);
        }
    }
}

void QuickHull::add_point(std::uint32_t seen_from, std::uint32_t point) {
    find_horizon(seen_from, point);
    cover(point);
    for (const std::uint32_t old : seen_) {
        for (std::uint32_t i = facets_[old].first; i != kNone;) {
            const std::uint32_t following = next_[i];
            assign(i, new_facets_);
            i = following;
        }
    }
    for (const std::uint32_t facet : new_facets_) {
        offer(facet);
    }
    vertices_.push_back(point);
}

// Spreads over the facets that the point sees and collects the edges where they end.
void QuickHull::find_horizon(std::uint32_t facet, std::uint32_t point) {
    seen_.assign(1, facet);
    horizon_.clear();
    facets_[facet].is_seen = true;
    for (std::size_t k = 0; k < seen_.size(); ++k) {
        const std::uint32_t here = seen_[k];
        facets_[here].is_alive = false;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t there = facets_[here].neighbors[i];
            Facet& other = facets_[there];
            if (other.is_seen) {
                continue;
            }
            if (is_outside(other, point, height(other, point))) {
                other.is_seen = true;
                seen_.push_back(there);
            } else {
                const auto& corners = facets_[here].corners;
                horizon_.push_back({corners[i], corners[(i + 1) % 3], there});
            }
        }
    }
}

// Joins the horizon to the point by new facets and links them with each other and the old ones.
void QuickHull::cover(std::uint32_t point) {
    new_facets_.clear();
    for (const Edge& edge : horizon_) {
        const std::uint32_t made = add_facet(edge.start, edge.end, point);
        new_facets_.push_back(made);
        facet_from_[edge.start] = made;
        facets_[made].neighbors[0] = edge.beyond;
        Facet& beyond = facets_[edge.beyond];
        for (std::size_t i = 0; i < 3; ++i) {
            if (beyond.corners[i] == edge.end && beyond.corners[(i + 1) % 3] == edge.start) {
                beyond.neighbors[i] = made;
            }
        }
    }
    for (std::size_t k = 0; k < horizon_.size(); ++k) {
        const std::uint32_t following = facet_from_[horizon_[k].end];
        facets_[new_facets_[k]].neighbors[1] = following;
        facets_[following].neighbors[2] = new_facets_[k];
    }
}

ConvexHull QuickHull::result() const {
    ConvexHull hull;
    hull.rank = 3;
    std::vector<std::uint32_t> new_index(facets_.size(), kNone);
    std::vector<bool> is_corner(grid_.size(), false);
    for (std::size_t i = 0; i < facets_.size(); ++i) {
        if (facets_[i].is_alive) {
            new_index[i] = static_cast<std::uint32_t>(hull.triangles.size());
            hull.triangles.push_back(facets_[i].corners);
            hull.neighbors.push_back(facets_[i].neighbors);
            for (const std::uint32_t corner : facets_[i].corners) {
                is_corner[corner] = true;
            }
        }
    }
    // Points that were the farthest of their facet may since lie inside.
    for (const std::uint32_t vertex : vertices_) {
        if (is_corner[vertex]) {
            hull.vertices.push_back(vertex);
        }
    }
    for (auto& three : hull.neighbors) {
        for (std::uint32_t& neighbor : three) {
            neighbor = new_index[neighbor];
        }
    }
    return hull;
}

} // namespace obb
