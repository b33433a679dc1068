#include "build/large_ranges.hpp"

#include "work/chunks.hpp"

#include <algorithm>
#include <limits>

namespace obb {

LargeRanges::LargeRanges(const UnitMesh& mesh, const BuildOptions& options, TreeSlots& slots,
                         std::uint32_t count)
    : mesh_(&mesh), options_(&options), slots_(&slots), keys_(count) {
    for (Side& side : sides_) {
        for (ZeroedArray<float>& column : side.coordinates) {
            column = ZeroedArray<float>(count);
        }
        side.ids = ZeroedArray<std::uint32_t>(count);
    }
}

FloatRange LargeRanges::floats(const Child& child) const {
    FloatRange range{{}, child.ref.begin, child.ref.end, child.reference};
    for (std::size_t k = 0; k < 9; ++k) {
        range.columns[k] = sides_[child.entry.side].coordinates[k].data();
    }
    return range;
}

// A large node as its children were made from it: seen from the middle of its box.
LargeRanges::Child LargeRanges::whole(const NodeRef& ref, const Entry& entry) const {
    const Node& node = slots_->nodes[ref.slot];
    Child all{ref, entry, as_floats(entry.frame.in(node.center)), {}};
    all.orientation = {node.rotation, axes_of(node.rotation), entry.key_axis};
    return all;
}

// The frame holds the vertices that triangles use.
void LargeRanges::make_root(unsigned threads) {
    const auto count = static_cast<std::uint32_t>(slots_->ids.size());
    std::vector<Extremes> of_chunks(chunk_count(count));
    for_chunks(0, count, threads, [&](std::uint32_t chunk, std::uint32_t begin, std::uint32_t end) {
        Extremes bounds;
        for (std::uint32_t i = begin; i < end; ++i) {
            sides_[0].ids[i] = i;
            for (const Vec3& corner : mesh_->triangle(i)) {
                bounds.add(corner);
            }
        }
        of_chunks[chunk] = bounds;
    });
    Extremes all;
    for (const Extremes& bounds : of_chunks) {
        all.add(bounds);
    }
    Child root;
    root.ref = {0, count, 0, 0};
    root.entry.frame.origin = 0.5 * all.low + 0.5 * all.high;
    root.entry.frame.scale = Frame::scale_for(norm_inf(all.high - root.entry.frame.origin));
    fill(root, threads);
    orient_children({&root, 1}, threads);
    make_box(root, threads);
    entries_.emplace(0, root.entry);
}

// Brings the corners into the frame.
void LargeRanges::fill(const Child& child, unsigned threads) {
    Side& side = sides_[child.entry.side];
    const auto fill_chunk = [&](std::uint32_t, std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            const Triangle t = mesh_->triangle(side.ids[i]);
            for (std::size_t v = 0; v < 3; ++v) {
                const FloatPoint p = as_floats(child.entry.frame.in(t[v]));
                for (std::size_t k = 0; k < 3; ++k) {
                    side.coordinates[3 * v + k][i] = p[k];
                }
            }
        }
    };
    for_chunks(child.ref.begin, child.ref.end, threads, fill_chunk);
}

// Nothing that a second attempt needs is overwritten: memory may end anywhere.
std::uint32_t LargeRanges::split(const NodeRef& ref, unsigned threads) {
    Entry entry;
    {
        const std::lock_guard lock(entries_lock_);
        Entry& stored = entries_.at(ref.slot);
        entry = stored;
        stored.key_axis = kNoAxis;
    }
    const Threshold threshold = choose(ref, entry, threads);
    const std::array<NodeRef, 2> refs = parted(ref, ref.begin + threshold.left_count);
    move(ref, entry, refs, threshold, threads);
    std::array<Child, 2> children;
    std::size_t count = 0;
    for (const NodeRef& child : refs) {
        if (!is_small(child)) {
            children[count] = whole(ref, entry);
            children[count].ref = child;
            children[count++].entry.side = 1 - entry.side;
        }
    }
    orient_children({children.data(), count}, threads);
    for (std::size_t k = 0; k < count; ++k) {
        make_box(children[k], threads);
        if (options_->is_leaf(children[k].ref)) {
            settle(children[k]);
        }
    }
    const std::lock_guard lock(entries_lock_);
    for (std::size_t k = 0; k < count; ++k) {
        entries_.insert_or_assign(children[k].ref.slot, children[k].entry);
    }
    entries_.erase(ref.slot);
    Node& node = slots_->nodes[ref.slot];
    // fetch_children() and is_leaf() may be reading them.
    __atomic_store_n(&node.right, refs[1].slot, __ATOMIC_RELAXED);
    __atomic_store_n(&node.split, refs[1].begin, __ATOMIC_RELAXED);
    return static_cast<std::uint32_t>(count);
}

void LargeRanges::settle(const Child& child) {
    for (std::uint32_t i = child.ref.begin; i < child.ref.end; ++i) {
        slots_->settle(*mesh_, i, sides_[child.entry.side].ids[i]);
    }
}

} // namespace obb
