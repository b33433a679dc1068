// How large ranges are parted.
#include "build/large_ranges.hpp"
#include "work/chunks.hpp"

#include <algorithm>

namespace obb {

// Eberly 2008 §6.2, as SmallRanges::part().
LargeRanges::Threshold LargeRanges::choose(const NodeRef& ref, Entry& entry, unsigned threads) {
    const Node& node = slots_->nodes[ref.slot];
    const auto order = longest_first(half_extents_of(node));
    const auto use_axis = [&](std::size_t axis) {
        if (entry.key_axis == axis) {
            return;
        }
        const Child all = whole(ref, entry);
        const FloatRange range = floats(all);
        const FloatPoint a = as_floats(all.orientation.axes[axis]);
        for_chunks(ref.begin, ref.end, threads,
                   [&](std::uint32_t, std::uint32_t begin, std::uint32_t end) {
                       compute_keys({range.columns, begin, end, range.reference}, a, keys_.data());
                   });
        entry.key_axis = axis;
        entry.key_high = 3 * entry.frame.scale * half_extents_of(node)[axis];
        entry.key_low = -entry.key_high;
    };
    const auto count_below = [&](float limit) {
        return static_cast<std::uint32_t>(std::count_if(keys_.data() + ref.begin,
                                                        keys_.data() + ref.end,
                                                        [&](float key) { return key < limit; }));
    };
    if (options_->split == Split::kCenter) {
        for (const std::size_t axis : order) {
            use_axis(axis);
            const auto middle = static_cast<float>(0.5 * (entry.key_low + entry.key_high));
            const std::uint32_t left = count_below(middle);
            if (0 < left && left < ref.triangle_count()) {
                return {middle, 0, left};
            }
        }
    }
    if (options_->split == Split::kCompact) {
        if (const auto cut = compact_cut(whole(ref, entry))) {
            use_axis(cut->axis);
            const double middle = 0.5 * (entry.key_low + entry.key_high);
            const double half = 3 * entry.frame.scale * half_extents_of(node)[cut->axis];
            const auto plane = static_cast<float>(middle + cut->place() * half);
            const std::uint32_t left = count_below(plane);
            if (0 < left && left < ref.triangle_count()) { // the floats of keys may all be equal
                return {plane, 0, left};
            }
        }
    }
    use_axis(order[0]);
    return median(ref, entry);
}

// So many, evenly taken, tell as much as all.
std::optional<CompactSplit::Cut> LargeRanges::compact_cut(const Child& all) const {
    constexpr std::uint32_t kSampled = 4096;
    const std::uint32_t step = 1 + (all.ref.triangle_count() - 1) / kSampled;
    const std::uint32_t count = 1 + (all.ref.triangle_count() - 1) / step;
    const std::size_t stride = std::size_t{count} + kDoubles;
    const FloatRange range = floats(all);
    std::vector<double> columns(9 * stride);
    for (std::size_t k = 0; k < 9; ++k) {
        for (std::uint32_t i = 0; i < count; ++i) {
            columns[k * stride + i] = range.columns[k][range.begin + i * step];
        }
    }
    const Vec3 half = all.entry.frame.scale * half_extents_of(slots_->nodes[all.ref.slot]);
    CompactSplit compact(count);
    return compact.best({all.orientation.axes, as_doubles(all.reference), half},
                        {columns.data(), stride, count});
}

// Counts keys in buckets, and looks closer at the one that holds the median. Of equal keys the
// first are the lower ones: ranges are in the order of ids.
LargeRanges::Threshold LargeRanges::median(const NodeRef& ref, const Entry& entry) const {
    constexpr std::uint32_t kBuckets = 1024;
    const auto low = static_cast<float>(entry.key_low);
    const double width = entry.key_high - entry.key_low;
    const auto factor = static_cast<float>(width > 0x1p-100 ? kBuckets / width : 0.0);
    const auto bucket_of = [&](float key) {
        const float bucket = (key - low) * factor;
        return static_cast<std::uint32_t>(std::clamp(bucket, 0.0F, kBuckets - 1.0F));
    };
    std::array<std::array<std::uint32_t, kBuckets>, 2> counts{}; // neighbours often share a bucket
    for (std::uint32_t i = ref.begin; i < ref.end; ++i) {
        ++counts[i % 2][bucket_of(keys_[i])];
    }
    const std::uint32_t half = ref.triangle_count() / 2;
    std::uint32_t bucket = 0, below = 0;
    for (; below + counts[0][bucket] + counts[1][bucket] <= half; ++bucket) {
        below += counts[0][bucket] + counts[1][bucket];
    }
    std::vector<float> candidates;
    candidates.reserve(counts[0][bucket] + counts[1][bucket]);
    for (std::uint32_t i = ref.begin; i < ref.end; ++i) {
        if (bucket_of(keys_[i]) == bucket) {
            candidates.push_back(keys_[i]);
        }
    }
    const auto middle = candidates.begin() + (half - below);
    std::nth_element(candidates.begin(), middle, candidates.end());
    const auto lower_count = static_cast<std::uint32_t>(
        std::count_if(candidates.begin(), middle, [&](float key) { return key < *middle; }));
    return {*middle, half - below - lower_count, half};
}

// Keeps the order of both sides' triangles.
void LargeRanges::move(const NodeRef& ref, const Entry& entry,
                       const std::array<NodeRef, 2>& children, const Threshold& threshold,
                       unsigned threads) {
    struct Count {
        std::uint32_t below = 0, equal = 0;
    };
    std::vector<Count> before(chunk_count(ref.triangle_count()) + 1);
    const auto count_chunk = [&](std::uint32_t chunk, std::uint32_t begin, std::uint32_t end) {
        Count count;
        for (std::uint32_t i = begin; i < end; ++i) {
            count.below += keys_[i] < threshold.key ? 1 : 0;
            count.equal += keys_[i] == threshold.key ? 1 : 0;
        }
        before[chunk + 1] = count;
    };
    for_chunks(ref.begin, ref.end, threads, count_chunk);
    for (std::size_t chunk = 1; chunk < before.size(); ++chunk) {
        before[chunk].below += before[chunk - 1].below;
        before[chunk].equal += before[chunk - 1].equal;
    }
    const Side& from = sides_[entry.side];
    Side& to = sides_[1 - entry.side];
    const auto move_chunk = [&](std::uint32_t chunk, std::uint32_t begin, std::uint32_t end) {
        std::array<std::array<std::uint16_t, kChunk>, 2> sources;
        std::array<std::uint32_t, 2> found{0, 0};
        std::uint32_t ties = std::min(threshold.tie_count, before[chunk].equal);
        const std::uint32_t left_before = before[chunk].below + ties;
        ties = threshold.tie_count - ties;
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t is_tie = ((keys_[i] == threshold.key) & (ties > 0)) ? 1 : 0;
            const std::uint32_t is_left = (keys_[i] < threshold.key ? 1U : 0U) | is_tie;
            ties -= is_tie;
            sources[0][found[0]] = sources[1][found[1]] = static_cast<std::uint16_t>(i - begin);
            found[0] += is_left;
            found[1] += 1 - is_left;
        }
        const std::array<std::uint32_t, 2> places{
            children[0].begin + left_before, children[1].begin + begin - ref.begin - left_before};
        for (std::size_t k = 0; k < 2; ++k) {
            const std::uint16_t* source = sources[k].data();
            const std::uint32_t* ids = from.ids.data() + begin;
            std::uint32_t* target =
                (is_small(children[k]) ? slots_->ids : to.ids).data() + places[k];
            for (std::uint32_t i = 0; i < found[k]; ++i) {
                target[i] = ids[source[i]];
            }
            for (std::size_t v = 0; v < 3 && !is_small(children[k]); ++v) {
                const auto& columns = from.coordinates;
                const float* x = columns[3 * v].data() + begin;
                const float* y = columns[3 * v + 1].data() + begin;
                const float* z = columns[3 * v + 2].data() + begin;
                float* to_x = to.coordinates[3 * v].data() + places[k];
                float* to_y = to.coordinates[3 * v + 1].data() + places[k];
                float* to_z = to.coordinates[3 * v + 2].data() + places[k];
                for (std::uint32_t i = 0; i < found[k]; ++i) {
                    to_x[i] = x[source[i]];
                    to_y[i] = y[source[i]];
                    to_z[i] = z[source[i]];
                }
            }
        }
    };
    for_chunks(ref.begin, ref.end, threads, move_chunk);
}

} // namespace obb
