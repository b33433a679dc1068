#include "build/float_passes.hpp"

#include "numbers/registers.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace obb {

namespace {

// Some triangles relative to the reference point; lanes beyond the end repeat the first one.
template <std::size_t kBytes>
OBB_INLINE LaneTriangles<Floats<kBytes>> triangles_at(const FloatRange& range, std::uint32_t at,
                                                      std::uint32_t end) {
    LaneTriangles<Floats<kBytes>> t;
    if (end - at >= kFloats) [[likely]] {
        unrolled<9>([&](auto k) {
            t[k / 3][k % 3] = Floats<kBytes>::at(range.columns[k] + at) - range.reference[k % 3];
        });
        return t;
    }
    for (std::size_t k = 0; k < 9; ++k) {
        for (std::uint32_t lane = 0; lane < kFloats; ++lane) {
            t[k / 3][k % 3].set(lane, range.columns[k][lane < end - at ? at + lane : at]);
        }
        t[k / 3][k % 3] -= range.reference[k % 3];
    }
    return t;
}

template <typename Reals>
OBB_INLINE Reals along(const FloatPoint& axis, const std::array<Reals, 3>& p) {
    return Reals(axis[0]) * p[0] + Reals(axis[1]) * p[1] + Reals(axis[2]) * p[2];
}

template <typename Reals>
OBB_INLINE void store_keys(const Reals& lanes, const FloatRange& range, std::uint32_t at,
                           float* keys) {
    if (range.end - at >= kFloats) [[likely]] {
        lanes.store(keys + at);
        return;
    }
    for (std::uint32_t lane = 0; lane < range.end - at; ++lane) {
        keys[at + lane] = lanes[lane];
    }
}

} // namespace

void add_moments(const FloatRange& range, bool by_corners, Moments& moments) {
    in_registers([&]<std::size_t kBytes>() {
        for (std::uint32_t first = range.begin; first < range.end; first += kBatch) {
            const std::uint32_t last = std::min(range.end - first, kBatch) + first;
            MomentSums<Floats<kBytes>> sums;
            for (std::uint32_t i = first; i < last; i += kFloats) {
                sums.add(triangles_at<kBytes>(range, i, last), Floats<kBytes>::first(last - i),
                         by_corners);
            }
            sums.add_to(moments);
        }
    });
}

void measure(const FloatRange& range, const std::array<FloatPoint, 3>& axes, std::size_t key_axis,
             float* keys, FloatExtremes* of_batches) {
    in_registers([&]<std::size_t kBytes>() {
        using Reals = Floats<kBytes>;
        for (std::uint32_t first = range.begin; first < range.end; first += kBatch) {
            const std::uint32_t last = std::min(range.end - first, kBatch) + first;
            std::array<Reals, 3> low, high;
            low.fill(std::numeric_limits<float>::infinity());
            high.fill(-std::numeric_limits<float>::infinity());
            for (std::uint32_t i = first; i < last; i += kFloats) {
                const auto t = triangles_at<kBytes>(range, i, last);
                std::array<Reals, 3> sums;
                unrolled<9>([&](auto j) {
                    constexpr std::size_t k = j / 3;
                    const Reals y = along(axes[k], t[j % 3]);
                    low[k] = lower(low[k], y);
                    high[k] = upper(high[k], y);
                    sums[k] += y;
                });
                const Reals& key = key_axis == 0 ? sums[0] : key_axis == 1 ? sums[1] : sums[2];
                store_keys(key, range, i, keys);
            }
            for (std::size_t k = 0; k < 3; ++k) {
                of_batches->low[k] = lowest_of(low[k]);
                of_batches->high[k] = highest_of(high[k]);
            }
            ++of_batches;
        }
    });
}

void compute_keys(const FloatRange& range, const FloatPoint& axis, float* keys) {
    in_registers([&]<std::size_t kBytes>() {
        for (std::uint32_t i = range.begin; i < range.end; i += kFloats) {
            const auto t = triangles_at<kBytes>(range, i, range.end);
            store_keys(along(axis, t[0]) + along(axis, t[1]) + along(axis, t[2]), range, i, keys);
        }
    });
}

std::uint32_t find_extreme(const FloatRange& range, const FloatPoint& axis, float low, float high,
                           std::uint32_t at) {
    std::uint32_t found = range.end;
    in_registers([&]<std::size_t kBytes>() {
        for (std::uint32_t i = at; i < range.end && found == range.end; i += kFloats) {
            typename Floats<kBytes>::Mask wanted;
            for (const auto& p : triangles_at<kBytes>(range, i, range.end)) {
                const Floats<kBytes> y = along(axis, p);
                wanted = wanted | (y <= low) | (y >= high);
            }
            if (wanted.is_any()) {
                std::uint32_t lane = 0;
                while (!wanted[lane]) {
                    ++lane;
                }
                found = std::min(range.end, i + lane);
            }
        }
    });
    return found;
}

} // namespace obb
