// Passes over triangles in floats, stored coordinate by coordinate, at the pace of memory.
#pragma once

#include "fit/fit.hpp"

#include <array>
#include <cstdint>

namespace obb {

// Arrays of the nine coordinates of triangles.
using FloatColumns = std::array<const float*, 9>;
using FloatPoint = std::array<float, 3>;

[[nodiscard]] inline FloatPoint as_floats(Vec3 p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}
[[nodiscard]] inline Vec3 as_doubles(const FloatPoint& p) { return {p[0], p[1], p[2]}; }

// Triangles [begin, end) of some columns, to be seen from a point near them.
struct FloatRange {
    FloatColumns columns;
    std::uint32_t begin, end;
    FloatPoint reference;
};

struct FloatExtremes {
    FloatPoint low, high;
};

// What is extreme is told batch by batch, so that few need a second look.
inline constexpr std::uint32_t kBatch = 256;
[[nodiscard]] inline std::uint32_t batch_count(std::uint32_t count) {
    return (count + kBatch - 1) / kBatch;
}

// Adds up moments about the reference point: floats for some triangles at a time, doubles for all.
void add_moments(const FloatRange& range, bool by_corners, Moments& moments);

// What the corners of each batch reach along three axes; and the sums of the three corners' places
// along one of them, which are keys to sort by. keys[i] is that of triangle i.
void measure(const FloatRange& range, const std::array<FloatPoint, 3>& axes, std::size_t key_axis,
             float* keys, FloatExtremes* of_batches);

// Those keys alone.
void compute_keys(const FloatRange& range, const FloatPoint& axis, float* keys);

// The triangles with a corner as low or as high as given along an axis, as measure() sees it: the
// first from `at` on, and where to go on; `end` where there is none.
[[nodiscard]] std::uint32_t find_extreme(const FloatRange& range, const FloatPoint& axis, float low,
                                         float high, std::uint32_t at);

} // namespace obb
