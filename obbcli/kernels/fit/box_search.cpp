#include "fit/box_search.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace obb {
namespace {

// The edges with a corner that a side of the box across n rests on, those nearest to lying in it.
std::vector<std::pair<double, const BodyEdge*>> edges_at_sides(const HullBody& body, Vec3 n) {
    constexpr double kNear = 1e-6;
    constexpr std::ptrdiff_t kMost = 8;
    const auto [low, high] = body.range_along(n);
    const double slack = kNear * (high - low), low_side = low + slack, high_side = high - slack;
    const auto is_near = [&](std::uint32_t corner) {
        const double s = dot(n, body.corners[corner]);
        return s <= low_side || s >= high_side;
    };
    std::vector<std::pair<double, const BodyEdge*>> found;
    for (const BodyEdge& edge : body.edges) {
        if (is_near(edge.start) || is_near(edge.end)) {
            found.emplace_back(std::fabs(dot(n, edge.along)), &edge);
        }
    }
    const auto end = found.begin() + std::min(kMost, std::ssize(found));
    std::partial_sort(found.begin(), end, found.end());
    found.erase(end, found.end());
    return found;
}

// Axes whose k-th is across the k-th edge: with n0 = u + t v across the first, n1 = n0 x e1 and
// n2 = n0 x n1, n2 . e2 = 0 is a quadratic equation for t. Up to two.
template <typename Take>
void each_frame_across(Vec3 e0, Vec3 e1, Vec3 e2, Take&& take) {
    const Frame frame(e0);
    const double a1 = dot(frame.u, e1), b1 = dot(frame.v, e1);
    const double a2 = dot(frame.u, e2), b2 = dot(frame.v, e2);
    const double c = dot(e1, e2);
    const double square = b1 * b2 - c, linear = a1 * b2 + a2 * b1, constant = a1 * a2 - c;
    const double inner = linear * linear - 4 * square * constant;
    if (!(inner >= 0)) {
        return;
    }
    // The root that does not cancel, and the other by the product of both; v alone is t infinite.
    const double q = -0.5 * (linear + std::copysign(std::sqrt(inner), linear));
    for (const Vec3 n : {square * frame.u + q * frame.v, q * frame.u + constant * frame.v}) {
        if (!(norm(n) > 0)) {
            continue;
        }
        const Vec3 first = unit_of(n);
        const Vec3 across = cross(first, e1);
        if (norm(across) > 0x1p-20) {
            const Vec3 second = unit_of(across);
            take(Axes{first, second, cross(first, second)});
        }
    }
}

// Jylanki 2015, An exact algorithm for finding minimum oriented bounding boxes: a least box has
// edges on three of its sides. Those near the sides of a good box are tried.
bool improve_by_edges(const HullBody& body, FoundBox& best) {
    const Axes start = best.axes;
    const double slack = 1e-9 * body.reach;
    const auto first = edges_at_sides(body, start[0]);
    const auto second = edges_at_sides(body, start[1]);
    const auto third = edges_at_sides(body, start[2]);
    bool improved = false;
    for (const auto& near_first : first) {
        for (const auto& near_second : second) {
            for (const auto& near_third : third) {
                const BodyEdge *e0 = near_first.second, *e1 = near_second.second,
                               *e2 = near_third.second;
                each_frame_across(e0->along, e1->along, e2->along, [&](const Axes& axes) {
                    if (body.is_supported(*e0, axes[0], slack) &&
                        body.is_supported(*e1, axes[1], slack) &&
                        body.is_supported(*e2, axes[2], slack)) {
                        improved = best.take(boxed(body, axes)) || improved;
                    }
                });
            }
        }
    }
    return improved;
}

bool improve_by_rectangles(HullBody& body, FoundBox& best) {
    const Axes start = best.axes;
    bool improved = false;
    for (const Vec3& axis : start) {
        const FoundBox box = boxed_along(body, axis, best.volume);
        if (box.volume < kInfinity) {
            improved = best.take(boxed(body, box.axes)) || improved;
        }
    }
    return improved;
}

} // namespace

void refine(HullBody& body, FoundBox& best) {
    constexpr int kMaxRounds = 32;
    for (int round = 0; round < kMaxRounds; ++round) {
        const bool turned = improve_by_rectangles(body, best);
        if (!improve_by_edges(body, best) && !turned) {
            return;
        }
    }
}

} // namespace obb
