#include "overlap/shadow.hpp"

#include "exact/orientation.hpp"
#include "shapes/extremes.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

Shadow shadow_of(const Triangle& corners, double floor) {
    Shadow s{};
    for (std::size_t k = 0; k < 3; ++k) {
        s.u[k] = corners[k].x;
        s.v[k] = corners[k].y;
        s.h[k] = corners[k].z - floor;
        s.reach = std::max(s.reach, std::fabs(s.h[k]));
    }
    s.low_u = smallest(s.u[0], s.u[1], s.u[2]);
    s.high_u = largest(s.u[0], s.u[1], s.u[2]);
    s.low_v = smallest(s.v[0], s.v[1], s.v[2]);
    s.high_v = largest(s.v[0], s.v[1], s.v[2]);
    s.low_h = smallest(s.h[0], s.h[1], s.h[2]);
    s.high_h = largest(s.h[0], s.h[1], s.h[2]);
    s.extent = (s.high_u - s.low_u) + (s.high_v - s.low_v);
    s.sign = orientation_xy(corners[0], corners[1], corners[2]).sign;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = k == 2 ? 0 : k + 1;
        s.along_u[k] = s.sign * (s.u[next] - s.u[k]);
        s.along_v[k] = s.sign * (s.v[next] - s.v[k]);
        s.along_sum[k] = std::fabs(s.along_u[k]) + std::fabs(s.along_v[k]);
    }
    s.area = (s.u[1] - s.u[0]) * (s.v[2] - s.v[0]) - (s.v[1] - s.v[0]) * (s.u[2] - s.u[0]);
    s.inverse = s.area != 0 ? 1 / s.area : 0;
    return s;
}

} // namespace obb
