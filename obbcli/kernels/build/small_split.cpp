// How small ranges are parted.
#include "build/double_passes.hpp"
#include "build/small_ranges.hpp"

#include <algorithm>
#include <limits>

namespace obb {

// Marks the triangles that go left, and returns how many do. The center rule may put all centroids
// on one side; the next longest axes are tried then, and at last the median of the longest axis,
// which always parts them. So it does where the compact rule finds all centroids together.
std::uint32_t SmallRanges::part(const Block& block, const Node& node) {
    const std::uint32_t count = block.ref.triangle_count();
    if (count == 2) { // one on each side, whichever
        is_left_[0] = 1;
        is_left_[1] = 0;
        return 1;
    }
    const auto axes = axes_of(node.rotation);
    const auto order = longest_first(half_extents_of(node));
    if (options_->split == Split::kCenter) {
        for (const std::size_t k : order) {
            compute_keys(block, axes[k], node.center);
            const std::uint32_t left = mark_below_zero(count);
            if (0 < left && left < count) {
                return left;
            }
        }
    }
    if (options_->split == Split::kCompact) {
        const std::uint32_t left = part_compactly(block, node);
        if (left > 0) {
            return left;
        }
    }
    compute_keys(block, axes[order[0]], node.center);
    mark_lower_half(count);
    return count / 2;
}

// Marks no triangle where all centroids are together.
std::uint32_t SmallRanges::part_compactly(const Block& block, const Node& node) {
    const std::uint32_t count = block.ref.triangle_count();
    const auto cut = compact_.best({axes_of(node.rotation), node.center, half_extents_of(node)},
                                   {column(from_, 0) + block.at, stride_, count});
    std::uint32_t left = 0;
    for (std::uint32_t i = 0; cut && i < count; ++i) {
        is_left_[i] = compact_.is_left(*cut, i) ? 1 : 0;
        left += is_left_[i];
    }
    return left;
}

// Three times the centroids' places along an axis.
void SmallRanges::compute_keys(const Block& block, Vec3 axis, Vec3 origin) {
    const double* first = column(from_, 0) + block.at;
    in_registers([&]<std::size_t kBytes>() {
        for (std::uint32_t i = 0; i < block.ref.triangle_count(); i += kDoubles) {
            const auto t = triangles_at<kBytes>(first + i, stride_, origin);
            Doubles<kBytes> key;
            unrolled<3>(
                [&](auto k) { key += Doubles<kBytes>(axis[k]) * (t[0][k] + t[1][k] + t[2][k]); });
            key.store(&keys_[i]);
        }
    });
}

std::uint32_t SmallRanges::mark_below_zero(std::uint32_t count) {
    std::uint32_t left = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        is_left_[i] = keys_[i] < 0 ? 1 : 0;
        left += is_left_[i];
    }
    return left;
}

// Of equal keys the first are the lower ones, so that half of the range lies on each side even
// where all keys are equal. Ranges are in the order of ids: the first of them have the lower ids.
void SmallRanges::mark_lower_half(std::uint32_t count) {
    constexpr std::uint32_t kFew = 32; // counting all pairs is cheaper than any sorting
    if (count <= kFew) {
        mark_few(count);
        return;
    }
    std::copy_n(keys_.begin(), count, sorted_.begin());
    const auto middle = sorted_.begin() + count / 2;
    std::nth_element(sorted_.begin(), middle, sorted_.begin() + count);
    mark_up_to(*middle, count);
}

// A key that fewer than half are below is below the median, or equal to it.
void SmallRanges::mark_few(std::uint32_t count) {
    const std::uint32_t half = count / 2;
    in_registers([&]<std::size_t kBytes>() {
        for (std::uint32_t i = 0; i < count; i += kDoubles) {
            const auto keys = Doubles<kBytes>::at(&keys_[i]);
            Doubles<kBytes> below;
            for (std::uint32_t j = 0; j < count; ++j) {
                below += select(keys > keys_[j], 1.0, 0.0);
            }
            below.store(&sorted_[i]);
        }
    });
    std::uint32_t left = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        is_left_[i] = sorted_[i] < half ? 1 : 0;
        left += is_left_[i];
    }
    if (left > half) { // ties at the median, which is among the marked
        double threshold = -std::numeric_limits<double>::infinity();
        for (std::uint32_t i = 0; i < count; ++i) {
            threshold = is_left_[i] != 0 ? std::max(threshold, keys_[i]) : threshold;
        }
        mark_up_to(threshold, count);
    }
}

// Marks half of the range: what is below the median, and as many as it takes of what equals it.
void SmallRanges::mark_up_to(double threshold, std::uint32_t count) {
    std::uint32_t below = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        is_left_[i] = keys_[i] < threshold ? 1 : 0;
        below += is_left_[i];
    }
    std::uint32_t missing = count / 2 - below;
    for (std::uint32_t i = 0; missing > 0; ++i) {
        if (keys_[i] == threshold) {
            is_left_[i] = 1;
            --missing;
        }
    }
}

} // namespace obb
