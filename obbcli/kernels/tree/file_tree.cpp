#include "tree/file_tree.hpp"

#include <algorithm>

namespace obb {

namespace {

constexpr std::size_t padded(std::size_t bytes) { return (bytes + 63) / 64 * 64; }

// Of a buffer that is aligned for all of them, as are the sections in it.
template <typename Record>
std::span<const Record> section(const FileBlocks& blocks, std::size_t begin, std::size_t count) {
    return {reinterpret_cast<const Record*>(blocks.data() + begin), count};
}

} // namespace

std::size_t TreeLayout::corners_begin() const { return node_count * sizeof(Node); }
std::size_t TreeLayout::ids_begin() const {
    return corners_begin() + padded(triangle_count * sizeof(Corners));
}
std::size_t TreeLayout::vertices_begin() const {
    return ids_begin() + padded(triangle_count * sizeof(std::uint32_t));
}
std::size_t TreeLayout::data_bytes() const {
    return vertices_begin() + padded(vertex_count * sizeof(Vec3));
}

FileTree::FileTree(FileBlocks::Descriptor file, const TreeLayout& layout,
                   std::vector<std::uint32_t> checksums)
    : layout_(layout),
      blocks_(std::move(file), layout.start, layout.data_bytes(), std::move(checksums)),
      ready_(layout.node_count), owners_(layout.node_count),
      on_demand_{
          ready_.data(), this,
          [](void* self, const NodeRef& ref) { static_cast<FileTree*>(self)->prepare(ref); }},
      view_{section<Vec3>(blocks_, layout.vertices_begin(), layout.vertex_count),
            section<Corners>(blocks_, layout.corners_begin(), layout.triangle_count),
            section<std::uint32_t>(blocks_, layout.ids_begin(), layout.triangle_count),
            section<Node>(blocks_, 0, layout.node_count),
            layout.scale_exponent,
            layout.node_count > 0 ? &on_demand_ : nullptr} {
    const NodeRef root = view_.root();
    if (root.is_triangle()) {
        load_triangles(root.begin, root.end);
    } else {
        load_node(root);
    }
}

void FileTree::load_all() {
    noting_faults([&] { blocks_.load(0, blocks_.size()); });
}

std::pair<std::size_t, std::size_t> FileTree::loaded_counts() const {
    const std::size_t begin = layout_.corners_begin();
    return {blocks_.loaded_bytes(begin, begin + view_.corners.size_bytes()) / sizeof(Corners),
            blocks_.loaded_bytes(0, view_.nodes.size_bytes()) / sizeof(Node)};
}

std::span<const std::uint32_t> FileTree::load_ids() {
    const std::size_t begin = layout_.ids_begin();
    noting_faults([&] { blocks_.load(begin, begin + view_.triangle_ids.size_bytes()); });
    return view_.triangle_ids;
}

Triangle FileTree::load_triangle(std::uint32_t position) {
    noting_faults([&] { load_triangles(position, position + 1); });
    return view_.triangle(position);
}

std::string FileTree::fault() const {
    const std::lock_guard lock(fault_lock_);
    return fault_;
}

// A question may be about two trees: this tells whose fault it was.
template <typename Load>
void FileTree::noting_faults(Load load) {
    try {
        load();
    } catch (const TreeError& fault) {
        const std::lock_guard lock(fault_lock_);
        fault_ = fault.what();
        throw;
    }
}

void FileTree::prepare(const NodeRef& ref) {
    noting_faults([&] { load_under(ref); });
}

// To do this twice, or from two threads at once, does no harm.
void FileTree::load_under(const NodeRef& ref) {
    const Node& node = view_.node(ref);
    if (TreeView::is_leaf(node)) {
        load_triangles(ref.begin, ref.end);
    } else {
        for (const NodeRef& child : TreeView::links(ref, node)) {
            if (child.is_triangle()) {
                load_triangles(child.begin, child.end);
            } else {
                load_node(child);
            }
        }
    }
    __atomic_store_n(&ready_[ref.slot], std::uint8_t{1}, __ATOMIC_RELEASE);
}

void FileTree::load_node(const NodeRef& ref) {
    if (ref.slot >= view_.nodes.size()) {
        throw TreeError("a link leads beyond the boxes");
    }
    // The flag of a box says what was read for one range; another's triangles it says nothing of.
    const std::uint64_t range = std::uint64_t{ref.begin} << 32 | ref.end;
    std::uint64_t owner = 0;
    if (!__atomic_compare_exchange_n(&owners_[ref.slot], &owner, range, false, __ATOMIC_RELAXED,
                                     __ATOMIC_RELAXED) &&
        owner != range) {
        throw TreeError("two nodes share a box");
    }
    const std::size_t begin = ref.slot * sizeof(Node);
    blocks_.load(begin, begin + sizeof(Node));
}

void FileTree::load_triangles(std::uint32_t begin, std::uint32_t end) {
    const auto load_rows = [&](std::size_t first, std::size_t row_bytes) {
        blocks_.load(first + begin * row_bytes, first + end * row_bytes);
    };
    load_rows(layout_.corners_begin(), sizeof(Corners));
    load_rows(layout_.ids_begin(), sizeof(std::uint32_t));
    for (std::uint32_t i = begin; i < end; ++i) {
        for (const std::uint32_t corner : view_.corners[i]) {
            if (corner >= view_.vertices.size()) {
                throw TreeError("a triangle uses a vertex that is not there");
            }
            const std::size_t vertex = layout_.vertices_begin() + corner * sizeof(Vec3);
            blocks_.load(vertex, vertex + sizeof(Vec3));
            if (!is_finite(view_.vertices[corner])) {
                throw TreeError("a vertex is not made of usable numbers");
            }
        }
    }
}

} // namespace obb
