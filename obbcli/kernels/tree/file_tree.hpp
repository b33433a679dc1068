// A tree in a file, of which questions read what they reach.
#pragma once

#include "tree/file_blocks.hpp"
#include "tree/tree.hpp"
#include "tree/zeroed_array.hpp"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace obb {

// Where the data of a tree file stand, and what they hold. Sections are padded to multiples of 64.
struct TreeLayout {
    std::uint64_t start; // byte of the file at which the data begin
    std::size_t node_count;
    std::size_t triangle_count;
    std::size_t vertex_count;
    int scale_exponent;

    [[nodiscard]] std::size_t corners_begin() const;
    [[nodiscard]] std::size_t ids_begin() const;
    [[nodiscard]] std::size_t vertices_begin() const;
    [[nodiscard]] std::size_t data_bytes() const;
};

// What stands under a node is read when a question first goes down from it. Links are checked
// before they are followed, and a box may belong to one node alone: then whatever a damaged file
// holds, nothing is looked at that was not read.
class FileTree {
  public:
    // The counts must agree with each other and with the file; checked by the caller.
    FileTree(FileBlocks::Descriptor file, const TreeLayout& layout,
             std::vector<std::uint32_t> checksums);
    FileTree(const FileTree&) = delete;
    FileTree& operator=(const FileTree&) = delete;

    [[nodiscard]] TreeView view() const { return view_; }

    // Reads all that is missing. Throws TreeError, as all that reads.
    void load_all();

    // Row of the mesh file for each triangle in tree order; only these are read.
    [[nodiscard]] std::span<const std::uint32_t> load_ids();

    // The corners of one triangle, in tree order.
    [[nodiscard]] Triangle load_triangle(std::uint32_t position);

    [[nodiscard]] std::size_t loaded_bytes() const {
        return blocks_.loaded_bytes(0, blocks_.size());
    }
    // How many triangles and boxes were read.
    [[nodiscard]] std::pair<std::size_t, std::size_t> loaded_counts() const;

    // What the first fault was, empty while there was none.
    [[nodiscard]] std::string fault() const;

  private:
    void prepare(const NodeRef& ref);
    void load_under(const NodeRef& ref);
    void load_node(const NodeRef& ref);
    void load_triangles(std::uint32_t begin, std::uint32_t end);
    template <typename Load>
    void noting_faults(Load load);

    TreeLayout layout_;
    FileBlocks blocks_;
    ZeroedArray<std::uint8_t> ready_;
    ZeroedArray<std::uint64_t> owners_; // of each box, the range of triangles of its node
    OnDemand on_demand_;
    TreeView view_;
    mutable std::mutex fault_lock_;
    std::string fault_;
};

} // namespace obb
