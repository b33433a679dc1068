#include "fit/convex_hull.hpp"

#include "fit/grid_points.hpp"
#include "fit/quick_hull.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace obb {
namespace {

// The point with the largest value; of equals the first by coordinates.
template <typename Value>
std::uint32_t farthest(std::span<const Vec3> grid, Value&& value) {
    std::uint32_t best = 0;
    double largest = -1;
    for (std::uint32_t i = 0; i < grid.size(); ++i) {
        const double v = value(grid[i]);
        if (v > largest || (v == largest && comes_before(grid[i], grid[best]))) {
            best = i;
            largest = v;
        }
    }
    return best;
}

// The point with the largest value among those that pass an exact test, or nothing. Rounding may
// make a point that fails the largest; then the first by coordinates that passes is taken.
template <typename Value, typename Test>
std::optional<std::uint32_t> farthest_passing(std::span<const Vec3> grid, Value&& value,
                                              Test&& passes) {
    const std::uint32_t likely = farthest(grid, value);
    if (passes(grid[likely])) {
        return likely;
    }
    std::optional<std::uint32_t> found;
    for (std::uint32_t i = 0; i < grid.size(); ++i) {
        if ((!found || comes_before(grid[i], grid[*found])) && passes(grid[i])) {
            found = i;
        }
    }
    return found;
}

// Andrew 1979's monotone chain, in the plane along `drop`, which no two points share a line of.
std::vector<std::uint32_t> polygon(std::span<const Vec3> grid, std::size_t drop, bool flips) {
    const std::size_t x = (drop + 1) % 3, y = (drop + 2) % 3;
    std::vector<std::uint32_t> order(grid.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto same = [&](std::uint32_t i, std::uint32_t k) { return grid[i] == grid[k]; };
    const auto before = [&](std::uint32_t i, std::uint32_t k) {
        const Vec3 &p = grid[i], &q = grid[k];
        return p[x] != q[x] ? p[x] < q[x] : p[y] != q[y] ? p[y] < q[y] : i < k;
    };
    std::sort(order.begin(), order.end(), before);
    order.erase(std::unique(order.begin(), order.end(), same), order.end());

    const auto turns_left = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
        const GridVec u = exact(grid[j] - grid[i]), v = exact(grid[k] - grid[i]);
        const std::array<Int128, 3> a{u.x, u.y, u.z}, b{v.x, v.y, v.z};
        return a[x] * b[y] - a[y] * b[x] > 0;
    };
    std::vector<std::uint32_t> chain;
    for (const bool back : {false, true}) {
        const std::size_t start = chain.size();
        for (const std::uint32_t i : order) {
            while (chain.size() >= start + 2 &&
                   !turns_left(chain[chain.size() - 2], chain.back(), i)) {
                chain.pop_back();
            }
            chain.push_back(i);
        }
        chain.pop_back(); // the first of the way back
        if (!back) {
            std::reverse(order.begin(), order.end());
        }
    }
    if (flips) {
        std::reverse(chain.begin() + 1, chain.end());
    }
    return chain;
}

ConvexHull planar_hull(std::span<const Vec3> grid, Vec3 u, Vec3 v) {
    const GridVec normal = exact_cross(u, v);
    const std::array<Int128, 3> n{normal.x, normal.y, normal.z};
    std::size_t drop = 0;
    while (n[drop] == 0) {
        ++drop;
    }
    ConvexHull hull;
    hull.rank = 2;
    hull.vertices = polygon(grid, drop, n[drop] < 0);
    for (std::size_t k = 2; k < hull.vertices.size(); ++k) {
        hull.triangles.push_back({hull.vertices[0], hull.vertices[k - 1], hull.vertices[k]});
    }
    return hull;
}

} // namespace

ConvexHull convex_hull(std::span<const Vec3> points, std::size_t max_vertices) {
    ConvexHull hull;
    if (points.empty()) {
        return hull;
    }
    const std::vector<Vec3> cells = grid_points(points);
    const std::span<const Vec3> grid(cells);
    const std::uint32_t a = farthest(grid, [](Vec3) { return 0.0; });
    const auto away = [&](Vec3 p) { return p - grid[a]; };
    const std::uint32_t b = farthest(grid, [&](Vec3 p) { return dot(away(p), away(p)); });
    if (grid[a] == grid[b]) {
        hull.vertices = {a};
        return hull;
    }
    const Vec3 u = away(grid[b]);
    const auto c = farthest_passing(
        grid, [&](Vec3 p) { return norm(cross(u, away(p))); },
        [&](Vec3 p) { return !exact_cross(u, away(p)).is_zero(); });
    if (!c) {
        hull.rank = 1;
        hull.vertices = {a, b};
        return hull;
    }
    const Vec3 v = away(grid[*c]);
    const Vec3 normal = cross(u, v);
    const auto d = farthest_passing(
        grid, [&](Vec3 p) { return std::fabs(dot(normal, away(p))); },
        [&](Vec3 p) { return exact_triple_sign(u, v, away(p)) != 0; });
    if (!d) {
        return planar_hull(grid, u, v);
    }
    QuickHull body(grid, {a, b, *c, *d});
    body.grow(max_vertices);
    return body.result();
}

} // namespace obb
