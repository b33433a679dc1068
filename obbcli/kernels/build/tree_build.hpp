// Builds a tree top-down, one node at a time, all at once or as it is used. Eberly 2008 §6.
#pragma once

#include "build/large_ranges.hpp"
#include "build/small_ranges.hpp"
#include "build/tree_slots.hpp"
#include "tree/tree.hpp"
#include "tree/zeroed_array.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace obb {

// Owns the triangles while they are sorted into their tree, and the tree. A node's children are a
// function of its box and its range of triangles, so that the tree is the same whatever is split
// first, and by whom: one by one, when a question first goes down from a node, or all of them.
class TreeBuilder {
  public:
    // The corners must index the vertices; checked by the caller. Both must outlive the builder.
    // Either others may look at the tree while it grows, or advance() makes it in so many threads.
    TreeBuilder(std::span<const Vec3> vertices, std::span<const Corners> corners,
                const BuildOptions& options, bool on_demand, unsigned threads);
    TreeBuilder(const TreeBuilder&) = delete;
    TreeBuilder& operator=(const TreeBuilder&) = delete;

    // The tree, whole or growing on demand, for any number of threads.
    [[nodiscard]] TreeView view() const;

    // Splits nodes until about `work` triangles have been moved; true when the tree is whole.
    // Iterative: a tree that degenerates to a list costs no stack. For one caller at a time, others
    // may ask questions meanwhile of a tree on demand.
    bool advance(std::uint64_t work);

    // Share of the work done so far, for progress displays.
    [[nodiscard]] double progress() const;

    [[nodiscard]] int scale_exponent() const { return mesh_.scale_exponent; }
    [[nodiscard]] std::uint32_t node_count() const { return node_count_; }
    // What the tree takes now, vertices and the mesh's own triangles left out.
    [[nodiscard]] std::size_t byte_count() const;

    // Of a whole tree, in tree order. Leaves of several triangles leave gaps between the boxes, for
    // they own more slots than they use: without_gaps() closes them.
    [[nodiscard]] std::span<const Node> nodes() const { return slots_.nodes.span(); }
    [[nodiscard]] std::span<const Corners> corners() const { return slots_.corners.span(); }
    [[nodiscard]] std::span<const std::uint32_t> triangle_ids() const { return slots_.ids.span(); }
    [[nodiscard]] bool has_gaps() const { return node_count() < slots_.nodes.size(); }
    [[nodiscard]] std::vector<Node> without_gaps() const;

  private:
    [[nodiscard]] static bool is_small(const NodeRef& ref) {
        return ref.triangle_count() <= SmallRanges::kMost;
    }
    void make_root();
    void note_box(const NodeRef& ref);
    void prepare(const NodeRef& ref);
    void split_one(const NodeRef& ref);
    bool grow(std::uint64_t stop);
    void split_largest(std::uint64_t stop);
    void split_large(SmallRanges& small, const NodeRef& ref, unsigned threads,
                     std::vector<NodeRef>& left_to_do);
    void build_small(SmallRanges& small, const NodeRef& ref);
    void work_until(std::uint64_t stop);

    BuildOptions options_;
    UnitMesh mesh_;
    bool is_on_demand_;
    unsigned threads_;
    TreeSlots slots_;
    ZeroedArray<std::uint8_t> ready_;
    OnDemand on_demand_{};
    std::unique_ptr<LargeRanges> large_;

    // Splitting a node holds the lock that its slot shares with some others'.
    static constexpr std::size_t kLockCount = 64;
    std::array<std::mutex, kLockCount> locks_;
    std::atomic<std::uint32_t> node_count_{0};
    std::atomic<std::uint32_t> unsplit_count_{0};
    std::atomic<std::uint64_t> work_done_{0};
    std::mutex pending_lock_;
    std::vector<NodeRef> pending_; // what advance() has still to visit
};

} // namespace obb
