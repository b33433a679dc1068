#include "fit/fit_hull.hpp"

#include "fit/fit_min_volume.hpp"

namespace obb {

std::array<Vec3, 3> hull_axes(std::span<const Vec3> points) {
    constexpr std::size_t kMaxVertices = 64;
    return hull_axes(points, convex_hull(points, kMaxVertices));
}

std::array<Vec3, 3> hull_axes(std::span<const Vec3> points, const ConvexHull& hull) {
    const Vec3 origin = points[hull.vertices[0]];
    const auto at = [&](std::uint32_t i) { return points[i] - origin; };
    Moments moments;
    for (const auto& [a, b, c] : hull.triangles) {
        moments.add({at(a), at(b), at(c)}, false);
    }
    if (moments.is_empty()) {
        for (const std::uint32_t vertex : hull.vertices) {
            moments.add({at(vertex), at(vertex), at(vertex)}, true);
        }
    }
    return principal_axes(moments);
}

std::array<float, 4> hull_rotation(std::span<const Vec3> points, Fit fit, bool is_root) {
    constexpr MinVolumeEffort kThorough{256, 8, true};
    constexpr MinVolumeEffort kLarge{32, 2, true};
    constexpr MinVolumeEffort kSmall{32, 2, false};
    constexpr std::size_t kLargePoints = 3 * 128;
    if (fit == Fit::kHull) {
        return quaternion_of(hull_axes(points));
    }
    return quaternion_of(min_volume_axes(points, is_root                         ? kThorough
                                                 : points.size() >= kLargePoints ? kLarge
                                                                                 : kSmall));
}

} // namespace obb
