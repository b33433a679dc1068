// Nodes of so many triangles that memory is what they cost: in floats, a few streams.
#pragma once

#include "build/compact_split.hpp"
#include "build/float_passes.hpp"
#include "build/small_ranges.hpp"
#include "build/tree_slots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace obb {

// A workshop for ranges of more than SmallRanges::kMost triangles. Each has a frame: an origin and
// a power of two that bring it into [-1, 1], where floats hold its corners to 2^-25. That decides
// how it is oriented and parted; boxes hold the corners themselves, proven. What is done to a range
// is a function of its node, its frame and the ids of its triangles, on any thread at any time.
class LargeRanges {
  public:
    // What it takes: coordinates and ids twice, keys once.
    static constexpr std::size_t kBytesATriangle = 84;

    // For `count` triangles; nothing is touched yet. What it is given must outlive it.
    LargeRanges(const UnitMesh& mesh, const BuildOptions& options, TreeSlots& slots,
                std::uint32_t count);

    // Fits the root's box. The ids must be in order.
    void make_root(unsigned threads);
    // Makes the boxes of those children that are large; the ids of the others are left in the
    // tree's slots. Different nodes may be split at the same time. Returns how many boxes it made.
    std::uint32_t split(const NodeRef& ref, unsigned threads);

  private:
    static constexpr std::size_t kNoAxis = 3;

    [[nodiscard]] static bool is_small(const NodeRef& ref) {
        return ref.triangle_count() <= SmallRanges::kMost;
    }

    struct Frame {
        Vec3 origin{0, 0, 0};
        double scale = 1;

        // A scale that brings lengths up to `largest` into [1/4, 1/2]: a power of two.
        [[nodiscard]] static double scale_for(double largest) {
            const int exponent = std::clamp(-1 - exponent_of(largest), -1000, 1000);
            return largest > 0 ? std::ldexp(1.0, exponent) : 1.0;
        }
        [[nodiscard]] Vec3 in(Vec3 point) const { return scale * (point - origin); }
    };
    // What is known of a large node beside its box.
    struct Entry {
        Frame frame;
        std::uint32_t side = 0;           // which half of the arrays holds the range
        std::size_t key_axis = 0;         // along which its keys are; or kNoAxis
        double key_low = 0, key_high = 0; // what they lie between, the box's middle in the middle
    };
    // One half of the arrays: coordinates of corners, and ids. Splits move triangles to the other.
    struct Side {
        std::array<ZeroedArray<float>, 9> coordinates;
        ZeroedArray<std::uint32_t> ids;
    };
    struct Child {
        NodeRef ref{};
        Entry entry;
        FloatPoint reference{}; // near it, in its frame
        Orientation orientation;
    };
    // Coordinates along axes, relative to a reference point.
    struct Extremes {
        static constexpr double kFar = std::numeric_limits<double>::infinity();
        Vec3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};

        void add(std::size_t axis, double y) {
            low[axis] = y < low[axis] ? y : low[axis];
            high[axis] = y > high[axis] ? y : high[axis];
        }
        void add(Vec3 p) {
            for (std::size_t k = 0; k < 3; ++k) {
                add(k, p[k]);
            }
        }
        // Of others, which may be empty along some axes.
        void add(const Extremes& other) {
            for (std::size_t k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], other.low[k]);
                high[k] = std::max(high[k], other.high[k]);
            }
        }
    };
    // Who goes left: keys below, and the first so many of those that equal it.
    struct Threshold {
        float key;
        std::uint32_t tie_count;
        std::uint32_t left_count; // of both kinds
    };

    [[nodiscard]] FloatRange floats(const Child& child) const;
    [[nodiscard]] Child whole(const NodeRef& ref, const Entry& entry) const;
    void fill(const Child& child, unsigned threads);
    [[nodiscard]] Moments moments_of(const Child& child, bool by_corners, unsigned threads) const;
    void orient_children(std::span<Child> children, unsigned threads) const;
    void orient_by_hull(Child& child) const;
    void make_box(Child& child, unsigned threads);
    [[nodiscard]] Vec3 fit_box(Child& child, unsigned threads);
    [[nodiscard]] Extremes measure_child(const Child& child, unsigned threads);
    [[nodiscard]] Threshold choose(const NodeRef& ref, Entry& entry, unsigned threads);
    [[nodiscard]] std::optional<CompactSplit::Cut> compact_cut(const Child& all) const;
    [[nodiscard]] Threshold median(const NodeRef& ref, const Entry& entry) const;
    void move(const NodeRef& ref, const Entry& entry, const std::array<NodeRef, 2>& children,
              const Threshold& threshold, unsigned threads);
    void settle(const Child& child);

    const UnitMesh* mesh_;
    const BuildOptions* options_;
    TreeSlots* slots_;
    std::array<Side, 2> sides_;
    ZeroedArray<float> keys_; // three times a centroid's place along an axis of its node's box
    std::mutex entries_lock_;
    std::unordered_map<std::uint32_t, Entry> entries_; // by slot
};

} // namespace obb
