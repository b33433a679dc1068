// Trees across the border: building, proving, looking at them.
#include "bindings.hpp"

#include "tree_build.hpp"
#include "tree_check.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <limits>
#include <tuple>

using namespace nb::literals;

namespace {

void init_tree(Tree* self, Rows<double, 3> vertices, Rows<std::uint32_t, 3> corners,
               Column<std::uint32_t> triangle_ids, Rows<std::uint8_t, 64> nodes,
               int scale_exponent) {
    if (corners.shape(0) == 0 || triangle_ids.shape(0) != corners.shape(0) ||
        nodes.shape(0) >= corners.shape(0) || (corners.shape(0) > 1 && nodes.shape(0) == 0) ||
        corners.shape(0) > std::numeric_limits<std::int32_t>::max()) {
        throw std::invalid_argument("the arrays of a tree do not belong together");
    }
    const obb::TreeView view{records<obb::Vec3>(vertices),
                             records<obb::Corners>(corners),
                             {triangle_ids.data(), triangle_ids.shape(0)},
                             records<obb::Node>(nodes),
                             scale_exponent};
    new (self) Tree{vertices, corners, triangle_ids, nodes, view};
}

using Built = std::tuple<Owned<std::uint8_t, -1, 64>, Owned<std::uint32_t, -1>, int>;

Built finish_build(obb::TreeBuilder& builder) {
    std::vector<obb::Node> nodes;
    std::vector<std::uint32_t> ids;
    {
        nb::gil_scoped_release release;
        nodes = builder.take_nodes();
        ids = builder.triangle_ids();
    }
    const std::size_t node_count = nodes.size(), id_count = ids.size();
    return {owned<Owned<std::uint8_t, -1, 64>>(std::move(nodes), {node_count, 64}),
            owned<Owned<std::uint32_t, -1>>(std::move(ids), {id_count}), builder.scale_exponent()};
}

std::vector<std::tuple<std::uint64_t, std::uint64_t, double>> levels_of(const Tree& tree) {
    nb::gil_scoped_release release; // only numbers are made here
    std::vector<std::tuple<std::uint64_t, std::uint64_t, double>> levels;
    for (const obb::Level& level : obb::tree_levels(tree.view)) {
        levels.emplace_back(level.box_count, level.leaf_count, level.volume);
    }
    return levels;
}

} // namespace

void bind_tree(nb::module_& m) {
    nb::enum_<obb::Fit>(m, "Fit")
        .value("TRIANGLES", obb::Fit::kTriangles)
        .value("POINTS", obb::Fit::kPoints)
        .value("AXIS_ALIGNED", obb::Fit::kAxisAligned);
    nb::enum_<obb::Split>(m, "Split")
        .value("MEDIAN", obb::Split::kMedian)
        .value("CENTER", obb::Split::kCenter);

    nb::class_<Tree>(m, "Tree")
        .def("__init__", &init_tree, "vertices"_a, "corners"_a, "triangle_ids"_a, "nodes"_a,
             "scale_exponent"_a)
        .def(
            "check",
            [](const Tree& tree, std::uint32_t leaf_size, std::uint32_t max_depth) {
                nb::gil_scoped_release release;
                return obb::tree_check(tree.view, leaf_size, max_depth);
            },
            "leaf_size"_a, "max_depth"_a)
        .def("levels", &levels_of);

    nb::class_<obb::TreeBuilder>(m, "TreeBuilder")
        .def(
            "__init__",
            [](obb::TreeBuilder* self, const Rows<double, 3>& vertices,
               const Rows<std::uint32_t, 3>& corners, obb::Fit fit, obb::Split split,
               std::uint32_t leaf_size, std::uint32_t max_depth) {
                const auto v = records<obb::Vec3>(vertices);
                const auto c = records<obb::Corners>(corners);
                nb::gil_scoped_release release;
                new (self) obb::TreeBuilder(v, c, {fit, split, leaf_size, max_depth});
            },
            "vertices"_a, "corners"_a, "fit"_a, "split"_a, "leaf_size"_a, "max_depth"_a)
        .def("advance", &obb::TreeBuilder::advance, "work"_a,
             nb::call_guard<nb::gil_scoped_release>())
        .def("progress", &obb::TreeBuilder::progress)
        .def("finish", &finish_build);
}
