// Builds a tree top-down, one node at a time. Eberly 2008 §6.
#pragma once

#include "fit.hpp"
#include "tree.hpp"

#include <cstdint>
#include <limits>
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

// Owns the triangles while they are sorted into their tree. Each call of split_node() fits the two
// children of one node; a whole build is nothing but split_node() for every node.
class TreeBuilder {
  public:
    // The corners must index the vertices; checked by the caller.
    TreeBuilder(std::span<const Vec3> vertices, std::span<const Corners> corners,
                const BuildOptions& options);

    // Splits nodes until about `work` triangles have been moved; true when the tree is whole.
    // Iterative: a tree that degenerates to a list costs no stack.
    bool advance(std::uint64_t work);

    // Share of the work done so far, for progress displays.
    [[nodiscard]] double progress() const;

    [[nodiscard]] int scale_exponent() const { return scale_exponent_; }
    // Boxes in depth-first order without gaps; only after advance() returned true.
    [[nodiscard]] std::vector<Node> take_nodes();
    // Rows of the mesh in tree order.
    [[nodiscard]] std::vector<std::uint32_t> triangle_ids() const;

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
    void split_node(const NodeRef& ref);
    [[nodiscard]] std::uint32_t partition(Range range, const Node& node, Vec3 reference,
                                          std::array<Moments, 2>& moments);
    void compute_keys(Range range, Vec3 axis);
    [[nodiscard]] Threshold median_threshold(Range range);
    [[nodiscard]] std::uint32_t partition_at(Range range, const Threshold& threshold,
                                             Vec3 reference, std::array<Moments, 2>& moments);
    void fit_box(Range range, const Moments& moments, Vec3 reference, Node& node) const;
    [[nodiscard]] Moments moments_of(Range range, Vec3 reference) const;

    BuildOptions options_;
    int scale_exponent_ = 0;
    std::vector<Item> items_;
    std::vector<double> keys_;
    std::vector<std::pair<double, std::uint32_t>> candidates_;
    std::vector<Node> nodes_;
    std::vector<NodeRef> pending_;
    std::uint64_t work_done_ = 0;
};

} // namespace obb
