#include "fit/calipers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obb {
namespace {

// In place of the angle from -pi to pi: as monotone, and the same on every machine.
double turn_of(double x, double y) {
    return std::copysign(1.0 - x / (std::fabs(x) + std::fabs(y)), y);
}

struct Corner {
    double x, y;
};

} // namespace

Rectangle least_rectangle(std::vector<PolygonEdge>& edges) {
    std::erase_if(edges, [](const PolygonEdge& e) { return !(e.x * e.x + e.y * e.y > 0); });
    for (PolygonEdge& e : edges) {
        e.turn = turn_of(e.x, e.y);
    }
    std::sort(edges.begin(), edges.end(), [](const PolygonEdge& a, const PolygonEdge& b) {
        return a.turn != b.turn ? a.turn < b.turn : a.x != b.x ? a.x < b.x : a.y < b.y;
    });
    const std::size_t count = edges.size();
    std::vector<Corner> corners(count + 1, Corner{0, 0}); // where each edge starts
    for (std::size_t i = 0; i < count; ++i) {
        corners[i + 1] = {corners[i].x + edges[i].x, corners[i].y + edges[i].y};
    }
    Rectangle best{0, 0, 0, 0};
    double least = std::numeric_limits<double>::infinity();
    std::size_t right = 0, top = 0, left = 0; // edges past the corners farthest that way
    for (std::size_t i = 0; i < count; ++i) {
        const double scale = 1.0 / std::sqrt(edges[i].x * edges[i].x + edges[i].y * edges[i].y);
        const double x = scale * edges[i].x, y = scale * edges[i].y;
        const auto along = [&](std::size_t k) {
            return edges[k % count].x * x + edges[k % count].y * y;
        };
        const auto across = [&](std::size_t k) {
            return edges[k % count].y * x - edges[k % count].x * y;
        };
        for (right = std::max(right, i + 1); right < i + count && along(right) > 0; ++right) {
        }
        for (top = std::max(top, right); top < i + count && across(top) > 0; ++top) {
        }
        for (left = std::max(left, top); left < i + count && along(left) < 0; ++left) {
        }
        const Corner &r = corners[right % count], &t = corners[top % count];
        const Corner &l = corners[left % count], &b = corners[i];
        const double length = (r.x - l.x) * x + (r.y - l.y) * y;
        const double width = (t.y - b.y) * x - (t.x - b.x) * y;
        if (length * width < least) {
            least = length * width;
            best = {length, width, x, y};
        }
    }
    return best;
}

// Across the coordinate axis that n leans to least, so that nothing cancels.
Frame::Frame(Vec3 n) {
    const Vec3 a = abs(n);
    const Vec3 away = a.x <= a.y && a.x <= a.z ? Vec3{1, 0, 0}
                      : a.y <= a.z             ? Vec3{0, 1, 0}
                                               : Vec3{0, 0, 1};
    u = cross(away, n);
    u = (1.0 / norm(u)) * u;
    v = cross(n, u);
}

} // namespace obb
