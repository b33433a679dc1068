#include "overlap/overlap_frame.hpp"

#include "shapes/extremes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace obb {

namespace {

// Ranges of coordinates that hold a posed body.
struct Reach {
    std::array<double, 3> low{HUGE_VAL, HUGE_VAL, HUGE_VAL};
    std::array<double, 3> high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

    void include(const Vec3& p, const Vec3& radius) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k] - radius[k]);
            high[k] = std::max(high[k], p[k] + radius[k]);
        }
    }
};

[[nodiscard]] int unit_of(const TreeView& tree, const Pose& pose) {
    const double shift = norm_inf(pose.translation);
    const int unit =
        shift > 0 ? std::max(tree.scale_exponent, exponent_of(shift)) : tree.scale_exponent;
    if (unit > 1020 && !pose.is_identity()) {
        throw std::domain_error("posed coordinates would exceed the range of double (about 1e307)");
    }
    return unit;
}

// In units of 2^exponent, in which no coordinate exceeds 4.
[[nodiscard]] Reach reach_of(const TreeView& tree, const Pose& pose, int exponent) {
    Reach reach;
    const Vec3 shift = scaled(pose.translation, -exponent);
    const auto placed = [&](const Vec3& p) { return pose.rotation * p + shift; };
    if (tree.root().is_triangle() || tree.nodes.empty()) {
        for (std::uint32_t k = 0; k < std::min(tree.triangle_count(), 1U); ++k) {
            for (const Vec3& corner : tree.triangle(k)) {
                reach.include(placed(scaled(corner, -exponent)), {0, 0, 0});
            }
        }
        return reach;
    }
    const Node& root = tree.nodes.front();
    const double unit = power_of_two(tree.scale_exponent - exponent);
    const std::array<Vec3, 3> axes = axes_of(root.rotation);
    const Vec3 h = unit * half_extents_of(root);
    Vec3 radius{0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        radius = radius + h[i] * abs(pose.rotation * axes[i]);
    }
    reach.include(placed(unit * root.center), radius);
    return reach;
}

// About v, and short: a multiple of a sixteenth of the least power of two above `size`, so that
// taking it off a coordinate rarely rounds.
[[nodiscard]] double short_of(double v, double size) {
    const double step = power_of_two(std::clamp(exponent_of(size), -1000, 1000) - 4);
    return std::nearbyint(v / step) * step;
}

} // namespace

// Boxes are taken to be a 2^-40 larger than computed, which covers their rounding many times. A
// damaged tree may make anything of the numbers: then origin and unit are such that queries end,
// for nothing else can be expected.
OverlapFrame overlap_frame(const TreeView& a, const Pose& pose_a, const TreeView& b,
                           const Pose& pose_b) {
    const int exponent = std::max(unit_of(a, pose_a), unit_of(b, pose_b));
    const Reach of_a = reach_of(a, pose_a, exponent), of_b = reach_of(b, pose_b, exponent);
    OverlapFrame frame{{0, 0, 0}, exponent};
    double extent = 0, offset = 0;
    Vec3 middle{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        const double low = std::max(of_a.low[k], of_b.low[k]);
        const double high = std::min(of_a.high[k], of_b.high[k]);
        middle[k] = 0.5 * (low + high);
        offset = larger(offset, std::fabs(middle[k]));
        extent =
            larger(extent, larger(of_a.high[k], of_b.high[k]) - smaller(of_a.low[k], of_b.low[k]));
    }
    if (!(extent > 0 && extent < 64 && offset < 64)) {
        frame.exponent += 4;
        return frame;
    }
    const Vec3 origin = offset > 2 * extent
                            ? Vec3{short_of(middle.x, extent), short_of(middle.y, extent),
                                   short_of(middle.z, extent)}
                            : Vec3{0, 0, 0};
    double farthest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double low = smaller(of_a.low[k], of_b.low[k]) - origin[k];
        const double high = larger(of_a.high[k], of_b.high[k]) - origin[k];
        farthest = larger(farthest, larger(std::fabs(low), std::fabs(high)));
    }
    const int shorter = std::max(exponent_of(farthest + 0x1p-40 * (extent + offset)), -900);
    frame.exponent += shorter;
    frame.origin = scaled(origin, -shorter);
    return frame;
}

} // namespace obb
