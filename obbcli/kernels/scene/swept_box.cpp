#include "scene/swept_box.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace obb {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Beyond this, sums and products of positions may leave the range of double.
constexpr double kMost = 0x1p1000;

bool is_finite(const SweptBox& box) {
    double most = std::max(std::fabs(box.start), std::fabs(box.end));
    for (std::size_t k = 0; k < 3; ++k) {
        for (const double value :
             {box.low[k], box.high[k], box.velocity[k], box.velocity[k] * (box.end - box.start)}) {
            if (!(std::fabs(value) < kMost)) {
                return false;
            }
        }
    }
    return most < kMost;
}

} // namespace

SweptBox usable(SweptBox box) {
    if (!is_finite(box)) {
        box.low = {-kInfinity, -kInfinity, -kInfinity};
        box.high = {kInfinity, kInfinity, kInfinity};
        box.velocity = {0, 0, 0};
        box.start = std::isfinite(box.start) ? box.start : -kInfinity;
        box.end = std::isfinite(box.end) ? box.end : kInfinity;
    }
    return box;
}

std::optional<double> time_near(const SweptBox& a, const SweptBox& b, double from, double to,
                                double reach) {
    double enter = from, leave = to;
    for (std::size_t k = 0; k < 3; ++k) {
        const double closing = a.velocity[k] - b.velocity[k];
        const double shift = (from - a.start) * a.velocity[k] - (from - b.start) * b.velocity[k];
        // What is left between them where b is above, and where a is above.
        const double gaps[2] = {(b.low[k] - a.high[k]) - shift - reach,
                                (a.low[k] - b.high[k]) + shift - reach};
        const double rates[2] = {closing, -closing};
        for (std::size_t side = 0; side < 2; ++side) {
            const double gap = gaps[side], rate = rates[side];
            if (gap > 0 && !(rate > 0)) {
                return std::nullopt;
            }
            if (gap > 0) {
                enter = std::max(enter, from + gap / rate);
            } else if (rate < 0) {
                leave = std::min(leave, from + gap / rate);
            }
        }
    }
    return enter > leave ? std::nullopt : std::optional(enter);
}

} // namespace obb
