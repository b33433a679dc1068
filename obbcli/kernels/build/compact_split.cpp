#include "build/compact_split.hpp"

#include "build/double_passes.hpp"

#include <algorithm>
#include <limits>

namespace obb {

CompactSplit::CompactSplit(std::uint32_t most) {
    const std::size_t room = std::size_t{most} + kDoubles;
    bounds_.resize(room);
    for (auto& bins : bins_of_) {
        bins.resize(room);
    }
}

// Where the triangles lie along the axes, the box's largest half extent being 1, and which bins
// their centroids are in.
template <std::size_t kBytes>
OBB_INLINE void CompactSplit::measure(const Box& box, const DoubleColumns& triangles) {
    using Reals = Doubles<kBytes>;
    constexpr double kLast = kBins - 1, kLeastExtent = 0x1p-900; // its inverse is finite
    const Vec3& half = box.half_extents;
    const double unit = 1.0 / std::max({half.x, half.y, half.z, kLeastExtent});
    for (std::uint32_t i = 0; i < triangles.count; i += kDoubles) {
        const auto t = triangles_at<kBytes>(triangles.first + i, triangles.stride, box.center);
        unrolled<3>([&](auto k) {
            const Vec3& axis = box.axes[k];
            const double bins_a_length = half[k] > kLeastExtent ? kBins / (6.0 * half[k]) : 0.0;
            std::array<Reals, 3> y;
            unrolled<3>([&](auto v) {
                y[v] = Reals(axis.x) * t[v][0] + Reals(axis.y) * t[v][1] + Reals(axis.z) * t[v][2];
            });
            const Reals low = lower(lower(y[0], y[1]), y[2]) * unit;
            const Reals high = upper(upper(y[0], y[1]), y[2]) * unit;
            const Reals place = (y[0] + y[1] + y[2]) * bins_a_length + 0.5 * kBins;
            const Reals bin = lower(upper(place, 0.0), kLast);
            for (std::uint32_t lane = 0; lane < kDoubles; ++lane) {
                bounds_[i + lane][k] = static_cast<float>(low[lane]);
                bounds_[i + lane][k + 4] = static_cast<float>(-high[lane]);
                bins_of_[k][i + lane] = static_cast<std::uint8_t>(bin[lane]);
            }
        });
    }
}

template <std::size_t kBytes>
OBB_INLINE void CompactSplit::fill_bins(std::uint32_t count) {
    using Reals = Floats<kBytes>;
    counts_ = {};
    for (auto& bins : bins_) {
        for (Bounds& bin : bins) {
            Reals(std::numeric_limits<float>::infinity()).store(bin.data());
        }
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto bounds = Reals::at(bounds_[i].data());
        unrolled<3>([&](auto k) {
            const std::size_t b = bins_of_[k][i];
            float* bin = bins_[k][b].data();
            lower(Reals::at(bin), bounds).store(bin);
            ++counts_[k][b];
        });
    }
}

// Of the bins that hold something: what lies from there on costs, and what before.
template <std::size_t kBytes>
OBB_INLINE void CompactSplit::weigh(std::size_t axis, float& least,
                                    std::optional<Cut>& found) const {
    using Reals = Floats<kBytes>;
    const auto& bins = bins_[axis];
    const auto& counts = counts_[axis];
    const auto cost_of = [](const Reals& b, std::uint32_t count) {
        const float x = b[0] + b[4], y = b[1] + b[5], z = b[2] + b[6];
        return static_cast<float>(count) * (x * x + y * y + z * z);
    };
    std::array<std::size_t, kBins + 1> full;
    std::size_t full_count = 0;
    for (std::size_t b = 0; b < kBins; ++b) {
        full[full_count] = b;
        full_count += counts[b] > 0 ? 1 : 0;
    }
    std::array<float, kBins> right_cost;
    Reals bounds(std::numeric_limits<float>::infinity());
    std::uint32_t count = 0;
    for (std::size_t i = full_count; i-- > 1;) {
        bounds = lower(bounds, Reals::at(bins[full[i]].data()));
        count += counts[full[i]];
        right_cost[i] = cost_of(bounds, count);
    }
    bounds = std::numeric_limits<float>::infinity();
    count = 0;
    for (std::size_t i = 1; i < full_count; ++i) {
        bounds = lower(bounds, Reals::at(bins[full[i - 1]].data()));
        count += counts[full[i - 1]];
        const float cost = cost_of(bounds, count) + right_cost[i];
        if (cost < least) {
            least = cost;
            found = Cut{axis, full[i - 1], full[i]};
        }
    }
}

std::optional<CompactSplit::Cut> CompactSplit::best(const Box& box,
                                                    const DoubleColumns& triangles) {
    std::optional<Cut> found;
    float least = std::numeric_limits<float>::infinity();
    in_registers([&]<std::size_t kBytes>() {
        measure<kBytes>(box, triangles);
        fill_bins<kBytes>(triangles.count);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            weigh<kBytes>(axis, least, found);
        }
    });
    return found;
}

} // namespace obb
