// Boxes of large ranges.
#include "build/large_ranges.hpp"
#include "fit/fit_hull.hpp"
#include "work/chunks.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

Moments LargeRanges::moments_of(const Child& child, bool by_corners, unsigned threads) const {
    const FloatRange all = floats(child);
    std::vector<Moments> of_chunks(chunk_count(child.ref.triangle_count()));
    for_chunks(all.begin, all.end, threads,
               [&](std::uint32_t chunk, std::uint32_t begin, std::uint32_t end) {
                   Moments sum;
                   add_moments({all.columns, begin, end, all.reference}, by_corners, sum);
                   of_chunks[chunk] = sum;
               });
    Moments sum;
    for (const Moments& one : of_chunks) {
        sum.add(one);
    }
    return sum;
}

void LargeRanges::orient_children(std::span<Child> children, unsigned threads) const {
    std::array<Moments, kOrientationsAtOnce> moments;
    std::array<Orientation, kOrientationsAtOnce> orientations;
    if (fits_by_moments(options_->fit)) {
        for (std::size_t k = 0; k < children.size(); ++k) {
            moments[k] = moments_of(children[k], options_->fit == Fit::kPoints, threads);
            if (moments[k].is_empty()) { // no area: points or segments
                moments[k] = moments_of(children[k], true, threads);
            }
        }
    }
    orient(moments, orientations);
    for (std::size_t k = 0; k < children.size(); ++k) {
        children[k].orientation = orientations[k];
        if (fits_by_hull(options_->fit)) {
            orient_by_hull(children[k]);
        }
        children[k].entry.key_axis = children[k].orientation.widest;
    }
}

void LargeRanges::orient_by_hull(Child& child) const {
    std::vector<Vec3> points;
    points.reserve(3 * std::size_t{child.ref.triangle_count()});
    for (std::uint32_t i = child.ref.begin; i < child.ref.end; ++i) {
        const Triangle t = mesh_->triangle(sides_[child.entry.side].ids[i]);
        points.insert(points.end(), t.begin(), t.end());
    }
    const bool is_root = child.ref.triangle_count() == slots_->ids.size();
    child.orientation.rotation = hull_rotation(points, options_->fit, is_root);
    child.orientation.axes = axes_of(child.orientation.rotation);
}

// Coordinates in the frame are at most 1, and floats of them off by 2^-25 each, which is 2^-24
// along an axis. With Y the sum of the largest |y_k|, no corner is further than Y from the
// reference point, and subtracting that, rounding the axis and taking the product lose at most 4.5
// sqrt(3) 2^-24 Y. Corners that may be extreme, given all that, are looked at in doubles, which in
// the frame are off by a few 2^-53.
LargeRanges::Extremes LargeRanges::measure_child(const Child& child, unsigned threads) {
    constexpr std::uint32_t kBatchesAChunk = kChunk / kBatch;
    const FloatRange all = floats(child);
    const Vec3 reference = as_doubles(child.reference);
    const auto& axes = child.orientation.axes;
    std::array<FloatPoint, 3> float_axes;
    std::transform(axes.begin(), axes.end(), float_axes.begin(), as_floats);
    std::vector<FloatExtremes> batches(batch_count(child.ref.triangle_count()));
    for_chunks(all.begin, all.end, threads,
               [&](std::uint32_t chunk, std::uint32_t begin, std::uint32_t end) {
                   measure({all.columns, begin, end, all.reference}, float_axes,
                           child.entry.key_axis, keys_.data(), &batches[chunk * kBatchesAChunk]);
               });
    Extremes rough;
    for (const FloatExtremes& batch : batches) {
        rough.add(as_doubles(batch.low));
        rough.add(as_doubles(batch.high));
    }
    double reach = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        reach += std::max(std::fabs(rough.low[k]), std::fabs(rough.high[k]));
    }
    const double error = 0x1.1p-24 + 0x1p-20 * reach;

    std::vector<Extremes> of_chunks(chunk_count(child.ref.triangle_count()));
    const auto look_closer = [&](std::size_t axis, const FloatRange& batch, Extremes& found) {
        const auto low = static_cast<float>(rough.low[axis] + 2 * error);
        const auto high = static_cast<float>(rough.high[axis] - 2 * error);
        for (std::uint32_t i = batch.begin;
             (i = find_extreme(batch, float_axes[axis], low, high, i)) < batch.end; ++i) {
            for (const Vec3& corner : mesh_->triangle(sides_[child.entry.side].ids[i])) {
                found.add(axis, dot(axes[axis], child.entry.frame.in(corner) - reference));
            }
        }
    };
    const auto take_chunk = [&](std::uint32_t chunk, std::uint32_t begin, std::uint32_t end) {
        Extremes found;
        for (std::uint32_t first = begin; first < end; first += kBatch) {
            const std::uint32_t last = std::min(end - first, kBatch) + first;
            const FloatExtremes& batch = batches[(first - all.begin) / kBatch];
            for (std::size_t k = 0; k < 3; ++k) {
                if (batch.low[k] <= rough.low[k] + 2 * error ||
                    batch.high[k] >= rough.high[k] - 2 * error) {
                    look_closer(k, {all.columns, first, last, all.reference}, found);
                }
            }
        }
        of_chunks[chunk] = found;
    };
    for_chunks(all.begin, all.end, threads, take_chunk);
    Extremes exact;
    for (const Extremes& one : of_chunks) {
        exact.add(one);
    }
    return exact;
}

// A range that fills little of its frame gets a frame of its own: the others' floats tell its
// triangles badly apart. Beside one far away even doubles do, and a second frame finds a third.
void LargeRanges::make_box(Child& child, unsigned threads) {
    constexpr double kLittle = 0x1p-9;
    constexpr int kMostFrames = 8;
    for (int frames = 1;; ++frames) {
        const Vec3 half = fit_box(child, threads);
        if (norm_inf(half) >= kLittle || frames == kMostFrames) {
            return;
        }
        const double unit = 1.0 / child.entry.frame.scale;
        const Vec3 center = slots_->nodes[child.ref.slot].center;
        child.entry.frame = {center, Frame::scale_for(unit * norm_inf(half))};
        child.reference = {0, 0, 0};
        fill(child, threads);
        orient_children({&child, 1}, threads);
    }
}

// Returns the half extents in the frame.
Vec3 LargeRanges::fit_box(Child& child, unsigned threads) {
    constexpr double kDoubleError = 0x1p-50;
    Entry& entry = child.entry;
    const Extremes y = measure_child(child, threads);
    entry.key_low = 3 * y.low[entry.key_axis];
    entry.key_high = 3 * y.high[entry.key_axis];
    Vec3 middle = as_doubles(child.reference);
    Vec3 half{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        middle = middle + (0.5 * (y.low[k] + y.high[k])) * child.orientation.axes[k];
        half[k] = 0.5 * (y.high[k] - y.low[k]) + kDoubleError;
    }
    Node& node = slots_->nodes[child.ref.slot];
    const double unit = 1.0 / entry.frame.scale; // a power of two
    node.center = entry.frame.origin + unit * middle;
    const double margin = rounding_margin(unit * norm_1(half), node.center);
    for (std::size_t k = 0; k < 3; ++k) {
        node.half_extents[k] = rounded_up(unit * half[k] + margin);
    }
    node.rotation = child.orientation.rotation;
    node.split = options_->is_leaf(child.ref) ? 0 : kUnsplit;
    return half;
}

} // namespace obb
