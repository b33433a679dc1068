// Boxes about a convex body while the least is searched for.
#pragma once

#include "fit/hull_body.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace obb {

using Axes = std::array<Vec3, 3>;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The direction of a vector that is neither zero nor beyond the range of squares.
[[nodiscard]] inline Vec3 unit_of(Vec3 v) { return (1.0 / norm(v)) * v; }

// A box that is flat but for rounding has no volume to speak of: then its area decides.
[[nodiscard]] inline double padded_volume(double a, double b, double c) {
    const double pad = 0x1p-30 * std::max({a, b, c});
    return (a + pad) * (b + pad) * (c + pad);
}

struct FoundBox {
    double volume = kInfinity;
    Axes axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

    // True where the other is better by more than rounding.
    bool take(const FoundBox& other) {
        if (!(other.volume < volume * (1 - 1e-12))) {
            return false;
        }
        *this = other;
        return true;
    }
};

[[nodiscard]] inline FoundBox boxed(const HullBody& body, const Axes& axes) {
    std::array<double, 3> extent;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = body.range_along(axes[k]);
        extent[k] = high - low;
    }
    return {padded_volume(extent[0], extent[1], extent[2]), axes};
}

// The least box with a given axis, or an infinite one where a bound shows it to be no better.
[[nodiscard]] inline FoundBox boxed_along(HullBody& body, Vec3 n, double limit) {
    const auto [low, high] = body.range_along(n);
    if ((high - low) * body.shadow_area(n) >= limit) {
        return {};
    }
    const Frame frame(n);
    const Rectangle r = body.shadow_rectangle(n, frame);
    if (r.x == 0 && r.y == 0) {
        return {};
    }
    const Vec3 u = unit_of(r.x * frame.u + r.y * frame.v);
    return {padded_volume(high - low, r.length, r.width), {u, cross(n, u), n}};
}

// Turns a good box on until nothing near is smaller: the least rectangles about the shadows along
// its axes are tried, and the axes across any three edges near its sides.
void refine(HullBody& body, FoundBox& best);

} // namespace obb
