// Trees in files across the border, and the checksums that guard them.
#include "bindings/module.hpp"

#include "tree/crc32.hpp"
#include "tree/file_tree.hpp"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <array>
#include <tuple>

using namespace nb::literals;

namespace {

std::span<const std::byte> bytes_of(const Column<std::uint8_t>& data) {
    return std::as_bytes(std::span(data.data(), data.shape(0)));
}

Owned<std::uint32_t, -1> block_checksums(const Column<std::uint8_t>& data) {
    constexpr std::size_t kBlock = obb::FileBlocks::kBlockBytes;
    std::vector<std::uint32_t> checksums;
    {
        const nb::gil_scoped_release release;
        for (auto rest = bytes_of(data); !rest.empty();) {
            const std::size_t count = std::min(kBlock, rest.size());
            checksums.push_back(obb::crc32(rest.first(count)));
            rest = rest.subspan(count);
        }
    }
    const std::size_t count = checksums.size();
    return owned<Owned<std::uint32_t, -1>>(std::move(checksums), {count});
}

void init_file_tree(obb::FileTree* self, int file, std::uint64_t start, std::size_t node_count,
                    std::size_t triangle_count, std::size_t vertex_count, int scale_exponent,
                    const Column<std::uint32_t>& checksums) {
    obb::FileBlocks::Descriptor descriptor(file);
    const obb::TreeLayout layout{start, node_count, triangle_count, vertex_count, scale_exponent};
    std::vector<std::uint32_t> kept(checksums.data(), checksums.data() + checksums.shape(0));
    const nb::gil_scoped_release release;
    new (self) obb::FileTree(std::move(descriptor), layout, std::move(kept));
}

using Arrays = std::tuple<Owned<std::uint8_t, -1, 64>, Owned<std::uint32_t, -1, 3>,
                          Owned<std::uint32_t, -1>, Owned<double, -1, 3>>;

Arrays arrays_of(nb::handle_t<obb::FileTree> self) {
    auto& tree = nb::cast<obb::FileTree&>(self);
    {
        const nb::gil_scoped_release release;
        tree.load_all();
    }
    const obb::TreeView view = tree.view();
    return {seen<Owned<std::uint8_t, -1, 64>>(view.nodes, {view.nodes.size(), 64}, self),
            seen<Owned<std::uint32_t, -1, 3>>(view.corners, {view.corners.size(), 3}, self),
            seen<Owned<std::uint32_t, -1>>(view.triangle_ids, {view.triangle_ids.size()}, self),
            seen<Owned<double, -1, 3>>(view.vertices, {view.vertices.size(), 3}, self)};
}

Owned<std::uint32_t, -1> ids_of(nb::handle_t<obb::FileTree> self) {
    auto& tree = nb::cast<obb::FileTree&>(self);
    {
        const nb::gil_scoped_release release;
        static_cast<void>(tree.load_ids());
    }
    const auto ids = tree.view().triangle_ids;
    return seen<Owned<std::uint32_t, -1>>(ids, {ids.size()}, self);
}

Owned<double, -1, 3> triangle_of(obb::FileTree& tree, std::uint32_t position) {
    if (position >= tree.view().triangle_count()) {
        throw std::out_of_range("no triangle stands there");
    }
    const obb::Triangle triangle = tree.load_triangle(position);
    return owned<Owned<double, -1, 3>>(std::vector(triangle.begin(), triangle.end()), {3, 3});
}

} // namespace

void bind_file_tree(nb::module_& m) {
    m.def(
        "crc32", [](const Column<std::uint8_t>& data) { return obb::crc32(bytes_of(data)); },
        "data"_a);
    m.def(
        "crc32_by_tables",
        [](const Column<std::uint8_t>& data) { return obb::crc32_by_tables(bytes_of(data)); },
        "data"_a);
    m.def("block_checksums", &block_checksums, "data"_a);

    nb::class_<obb::FileTree>(m, "FileTree")
        .def("__init__", &init_file_tree, "file"_a, "start"_a, "node_count"_a, "triangle_count"_a,
             "vertex_count"_a, "scale_exponent"_a, "checksums"_a)
        .def(
            "tree", [](const obb::FileTree& self) { return Tree{{}, {}, {}, {}, self.view()}; },
            nb::keep_alive<0, 1>())
        .def("arrays", &arrays_of)
        .def("triangle_ids", &ids_of)
        .def("triangle", &triangle_of, "position"_a)
        .def_prop_ro("loaded_bytes", &obb::FileTree::loaded_bytes)
        .def("loaded_counts", &obb::FileTree::loaded_counts)
        .def_prop_ro("fault", &obb::FileTree::fault);
}
