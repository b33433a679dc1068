// Nodes of so few triangles that they fit the nearest cache: all in doubles, close by.
#pragma once

#include "build/compact_split.hpp"
#include "build/tree_slots.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace obb {

// A workshop for ranges of at most kMost triangles. A node's split is a function of its box and of
// the ids of its range, whether its descendants are made at once or one by one.
class SmallRanges {
  public:
    static constexpr std::uint32_t kMost = 512;

    // Room for a range of so many triangles. What it is given must outlive it.
    SmallRanges(const UnitMesh& mesh, const BuildOptions& options, TreeSlots& slots,
                std::uint32_t most);

    // Fetches the triangles of a range.
    void load(const NodeRef& ref);
    // Fits the box of the range that was loaded, its moments taken about a point near it.
    void fit_loaded(Vec3 reference);
    // The same for the child of a large node that was loaded; settles it if it goes no deeper.
    void fit_child(Vec3 reference);
    // Makes the children of the node that was loaded, and no more.
    void split_loaded();
    // Makes all descendants of the node that was loaded.
    void build_loaded();

    // Boxes made since the last call.
    [[nodiscard]] std::uint32_t take_box_count();

  private:
    // A range and where its triangles stand. Blocks begin at multiples of a register's lanes; the
    // lanes beyond their end repeat their first triangle.
    struct Block {
        NodeRef ref;
        std::uint32_t at;
    };
    // Coordinates of triangles in the tree's unit, one array for each of nine, and their ids.
    struct Side {
        std::vector<double> coordinates;
        std::vector<std::uint32_t> ids;
    };

    [[nodiscard]] const double* column(const Side& side, std::size_t k) const {
        return side.coordinates.data() + k * stride_;
    }
    void pad(Side& side, std::uint32_t at, std::uint32_t count) const;

    void add_moments(const Side& side, const Block& block, Vec3 reference, bool by_corners,
                     Moments& moments) const;
    [[nodiscard]] Moments moments_of(const Side& side, const Block& block, Vec3 reference) const;
    void fit(const Side& side, std::span<const Block> blocks, std::span<const Vec3> references);
    void orient_by_hull(const Side& side, const Block& block, Orientation& orientation);
    void fit_box(const Side& side, const Block& block, const Orientation& orientation);

    [[nodiscard]] std::uint32_t part(const Block& block, const Node& node);
    [[nodiscard]] std::uint32_t part_compactly(const Block& block, const Node& node);
    void compute_keys(const Block& block, Vec3 axis, Vec3 origin);
    [[nodiscard]] std::uint32_t mark_below_zero(std::uint32_t count);
    void mark_lower_half(std::uint32_t count);
    void mark_few(std::uint32_t count);
    void mark_up_to(double threshold, std::uint32_t count);
    [[nodiscard]] std::array<Block, 2> split(const Block& block);
    void split_two(const Block& block);
    void move(const Block& block, const std::array<Block, 2>& children);
    void settle(const Side& side, const Block& block);

    const UnitMesh* mesh_;
    const BuildOptions* options_;
    TreeSlots* slots_;
    std::size_t stride_;
    Side from_, to_;
    std::uint32_t filled_ = 0; // of to_
    Block loaded_{};
    std::vector<double> keys_, sorted_;
    std::vector<std::uint8_t> is_left_;
    CompactSplit compact_;
    std::vector<Block> blocks_, next_;
    std::vector<Vec3> references_;
    std::uint32_t box_count_ = 0;
};

} // namespace obb
