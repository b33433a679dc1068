// Builds a tree top-down, one node at a time, all at once or as it is used. Eberly 2008 §6.
#pragma once

#include "fit.hpp"
#include "tree.hpp"
#include "zeroed_array.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <span>
#include <vector>

namespace obb {

enum class Split { kMedian, kCenter };

struct BuildOptions {
    Fit fit = Fit::kTriangles;
    Split split = Split::kMedian;
    // A range of at most this many triangles is a leaf.
    std::uint32_t leaf_size = 1;
    // A node this deep is a leaf, whatever it holds; the root's depth is 0.
    std::uint32_t max_depth = std::numeric_limits<std::uint32_t>::max();
};

// Owns the triangles while they are sorted into their tree, and the tree. A node's children are
// made by split_node() and nothing else: when a question first goes down from the node, or when the
// whole tree is asked for. A range of triangles and its box determine what becomes of them, so that
// the tree is the same whatever is split first, and by whom.
class TreeBuilder {
  public:
    // The corners must index the vertices; checked by the caller. Both must outlive the builder.
    TreeBuilder(std::span<const Vec3> vertices, std::span<const Corners> corners,
                const BuildOptions& options);
    TreeBuilder(const TreeBuilder&) = delete;
    TreeBuilder& operator=(const TreeBuilder&) = delete;

    // The tree as far as it is made; it makes the rest on demand, for any number of threads.
    [[nodiscard]] TreeView view() const;

    // Splits nodes until about `work` triangles have been moved; true when the tree is whole.
    // Iterative: a tree that degenerates to a list costs no stack. For one thread at a time, others
    // may ask questions meanwhile.
    bool advance(std::uint64_t work);

    // Share of the work done so far, for progress displays.
    [[nodiscard]] double progress() const;

    [[nodiscard]] int scale_exponent() const { return scale_exponent_; }
    [[nodiscard]] std::uint32_t node_count() const;
    // What the tree takes now, vertices and the mesh's own triangles left out.
    [[nodiscard]] std::size_t byte_count() const;

    // Of a whole tree, in tree order. Leaves of several triangles leave gaps between the boxes, for
    // they own more slots than they use: without_gaps() closes them.
    [[nodiscard]] std::span<const Node> nodes() const { return nodes_.span(); }
    [[nodiscard]] std::span<const Corners> corners() const { return corners_.span(); }
    [[nodiscard]] std::span<const std::uint32_t> triangle_ids() const { return ids_.span(); }
    [[nodiscard]] bool has_gaps() const { return node_count() < nodes_.size(); }
    [[nodiscard]] std::vector<Node> without_gaps() const;

  private:
    // A triangle that moves with its range, in the tree's unit; streaming over these costs a
    // fraction of following indices.
    struct Item {
        Triangle corners;
        std::uint32_t id;
    };
    struct Range {
        std::uint32_t begin, end;
        [[nodiscard]] std::uint32_t size() const { return end - begin; }
    };
    struct Threshold {
        double key;
        std::uint32_t id;
        [[nodiscard]] bool is_above(double k, std::uint32_t i) const {
            return k < key || (k == key && i < id);
        }
    };

    [[nodiscard]] bool is_leaf(const NodeRef& ref) const;
    [[nodiscard]] bool is_ready(std::uint32_t slot) const { return on_demand_.is_ready(slot); }
    void prepare(const NodeRef& ref);
    void split_node(const NodeRef& ref);
    void add_node(const NodeRef& ref);
    void settle(Range range);
    void forget_items();
    [[nodiscard]] std::uint32_t partition(Range range, const Node& node, Vec3 reference,
                                          std::array<Moments, 2>& moments);
    void compute_keys(Range range, Vec3 axis);
    [[nodiscard]] Threshold median_threshold(Range range);
    [[nodiscard]] std::uint32_t partition_at(Range range, const Threshold& threshold,
                                             Vec3 reference, std::array<Moments, 2>& moments);
    void fit_box(Range range, const Moments& moments, Vec3 reference, Node& node) const;
    [[nodiscard]] std::vector<Vec3> corners_of(Range range) const;
    [[nodiscard]] Moments moments_of(Range range, Vec3 reference) const;

    BuildOptions options_;
    std::span<const Vec3> vertices_;
    std::span<const Corners> mesh_corners_;
    int scale_exponent_ = 0;

    ZeroedArray<Node> nodes_;
    ZeroedArray<Corners> corners_;
    ZeroedArray<std::uint32_t> ids_;
    ZeroedArray<std::uint8_t> ready_;
    OnDemand on_demand_{};
    std::vector<Item> items_;
    std::vector<double> keys_;

    // Splitting a node holds the lock that its slot shares with some others'.
    static constexpr std::size_t kLockCount = 64;
    std::array<std::mutex, kLockCount> locks_;
    std::atomic<std::uint32_t> node_count_{0};
    std::atomic<std::uint32_t> unsplit_count_{0};
    std::atomic<std::uint64_t> work_done_{0};
    std::vector<NodeRef> pending_; // what advance() has still to visit
};

} // namespace obb
