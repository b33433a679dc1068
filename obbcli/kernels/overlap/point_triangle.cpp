#include "overlap/point_triangle.hpp"

#include <algorithm>
#include <array>

namespace obb {

FootDistance foot_distance(const Vec3& point, const Triangle& triangle) {
    using Real = Doubles<kNarrow>;
    LaneTriangles<Real> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 c = triangle[i] - point;
        corners[i] = {Real(c.x), Real(c.y), Real(c.z)};
    }
    const LaneFeet<Real> feet = lane_feet(corners);
    return {feet.low[0], feet.high[0],
            point + Vec3{feet.way[0][0], feet.way[1][0], feet.way[2][0]}};
}

void distances_from(const Triangle& triangle, std::span<const Vec3> points,
                    std::span<double> highs) {
    in_registers([&]<std::size_t kBytes>() {
        using Real = Doubles<kBytes>;
        for (std::size_t first = 0; first < points.size(); first += 4) {
            const std::size_t count = std::min<std::size_t>(4, points.size() - first);
            std::array<std::array<double, 4>, 3> p;
            for (std::size_t k = 0; k < 4; ++k) {
                const Vec3& from = points[first + (k < count ? k : 0)];
                p[0][k] = from.x;
                p[1][k] = from.y;
                p[2][k] = from.z;
            }
            LaneTriangles<Real> corners;
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t j = 0; j < 3; ++j) {
                    corners[i][j] = Real(triangle[i][j]) - Real::at(p[j].data());
                }
            }
            std::array<double, 4> found;
            lane_feet(corners).high.store(found.data());
            std::copy_n(found.begin(), count, highs.begin() + static_cast<std::ptrdiff_t>(first));
        }
    });
}

} // namespace obb
