#include "fit/grid_points.hpp"

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obb {

std::vector<Vec3> grid_points(std::span<const Vec3> points) {
    constexpr int kDigits = 41;
    constexpr double kLeastExtent = 0x1p-900;
    // Adding and taking away 3 * 2^51 rounds to the nearest whole number.
    constexpr double kRounder = 0x1.8p52;

    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Vec3 low{kInfinity, kInfinity, kInfinity};
    Vec3 high = -low;
    for (const Vec3& p : points) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = p[k] < low[k] ? p[k] : low[k];
            high[k] = p[k] > high[k] ? p[k] : high[k];
        }
    }
    Vec3 factor{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        const double extent = high[k] - low[k];
        if (extent >= kLeastExtent) {
            factor[k] = std::ldexp(1.0, kDigits - exponent_of(extent));
        }
    }
    std::vector<Vec3> grid(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            grid[i][k] = (points[i][k] - low[k]) * factor[k] + kRounder - kRounder;
        }
    }
    return grid;
}

} // namespace obb
