#include "overlap/column_frame.hpp"

#include "shapes/extremes.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace obb {

namespace {

struct Crowd {
    NodeRef ref;
    Bounds bounds;
};

[[nodiscard]] bool meet(const Bounds& a, const Bounds& b, std::size_t k) {
    return !(a.low[k] > b.high[k]) && !(b.low[k] > a.high[k]);
}

// Whether what lies within some bounds is in a column along an axis that passes the window, or over
// it: above the floor.
[[nodiscard]] bool matters(const Bounds& bounds, const Bounds& window, std::size_t axis) {
    return meet(bounds, window, (axis + 1) % 3) && meet(bounds, window, (axis + 2) % 3) &&
           !(bounds.high[axis] <= window.low[axis]);
}

// Some nodes that hold all triangles which matter along any axis.
[[nodiscard]] std::vector<Crowd> crowds_of(const ColumnBody& body, const Bounds& window) {
    constexpr std::size_t kCrowds = 48;
    constexpr std::uint32_t kFew = 8;
    const NodeRef root = body.tree().root();
    std::vector<Crowd> crowds{{root, body.around(root)}};
    const auto is_smaller = [](const Crowd& a, const Crowd& b) {
        return a.ref.triangle_count() < b.ref.triangle_count();
    };
    while (!crowds.empty() && crowds.size() < kCrowds &&
           crowds.front().ref.triangle_count() > kFew) {
        const NodeRef largest = crowds.front().ref;
        std::pop_heap(crowds.begin(), crowds.end(), is_smaller);
        crowds.pop_back();
        for (const NodeRef& part : parts_of(body.tree(), largest)) {
            const Bounds bounds = body.around(part);
            if (matters(bounds, window, 0) || matters(bounds, window, 1) ||
                matters(bounds, window, 2)) {
                crowds.push_back({part, bounds});
                std::push_heap(crowds.begin(), crowds.end(), is_smaller);
            }
        }
    }
    return crowds;
}

// How many pairs of shadows are expected along each axis: of these, the pairs of crowds whose
// shadows meet. Whole numbers, so that the order of the bodies does not matter.
[[nodiscard]] std::array<std::uint64_t, 3>
costs_of(const std::vector<Crowd>& a, const std::vector<Crowd>& b, const Bounds& window) {
    std::array<std::uint64_t, 3> costs{};
    for (std::size_t k = 0; k < 3; ++k) {
        for (const Crowd& p : a) {
            if (!matters(p.bounds, window, k)) {
                continue;
            }
            for (const Crowd& q : b) {
                if (matters(q.bounds, window, k) && meet(p.bounds, q.bounds, (k + 1) % 3) &&
                    meet(p.bounds, q.bounds, (k + 2) % 3)) {
                    costs[k] += std::uint64_t{p.ref.triangle_count()} * q.ref.triangle_count();
                }
            }
        }
    }
    return costs;
}

// The axis along which the window is thinnest, of those that cost at most twice the least: errors
// grow with the height of columns.
[[nodiscard]] std::size_t best_axis(const std::array<std::uint64_t, 3>& costs, Vec3 sizes) {
    constexpr std::uint64_t kCheap = 4096;
    const std::uint64_t least = *std::min_element(costs.begin(), costs.end());
    const std::uint64_t bearable = 2 * std::max(least, kCheap);
    std::size_t best = 3;
    for (std::size_t k = 0; k < 3; ++k) {
        if (costs[k] <= bearable && (best == 3 || sizes[k] < sizes[best])) {
            best = k;
        }
    }
    return best == 3 ? 2 : best;
}

} // namespace

bool ColumnFrame::may_matter(const Bounds& bounds) const {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    return !(bounds.low[u] > window.high[0]) && !(window.low[0] > bounds.high[u]) &&
           !(bounds.low[v] > window.high[1]) && !(window.low[1] > bounds.high[v]) &&
           !(bounds.high[axis] <= window.floor);
}

Shadow ColumnFrame::shadow(const Triangle& t) const {
    return shadow_of({along_axis(t[0], axis), along_axis(t[1], axis), along_axis(t[2], axis)},
                     window.floor);
}

Bounds common(const Bounds& a, const Bounds& b) {
    Bounds shared{};
    for (std::size_t k = 0; k < 3; ++k) {
        shared.low[k] = larger(a.low[k], b.low[k]);
        shared.high[k] = smaller(a.high[k], b.high[k]);
    }
    return shared;
}

ColumnFrame frame_of(const ColumnBody& a, const ColumnBody& b, const Bounds& window) {
    ColumnFrame frame;
    const Vec3 sizes = window.high - window.low;
    frame.is_empty = sizes.x <= 0 || sizes.y <= 0 || sizes.z <= 0;
    if (frame.is_empty) {
        return frame;
    }
    frame.axis = best_axis(costs_of(crowds_of(a, window), crowds_of(b, window), window), sizes);
    const Vec3 low = along_axis(window.low, frame.axis);
    const Vec3 high = along_axis(window.high, frame.axis);
    frame.origin = window.low;
    frame.window = {{low.x, low.y}, {high.x, high.y}, low.z, high.z - low.z};
    return frame;
}

} // namespace obb
