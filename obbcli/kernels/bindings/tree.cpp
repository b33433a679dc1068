// Trees across the border: building, proving, looking at them.
#include "bindings/module.hpp"

#include "build/tree_build.hpp"
#include "tree/tree_boxes.hpp"
#include "tree/tree_check.hpp"

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

// A builder with the arrays of the mesh that it reads.
struct TreeBuilder {
    Rows<double, 3> vertices;
    Rows<std::uint32_t, 3> corners;
    obb::TreeBuilder builder;
};

void init_builder(TreeBuilder* self, const Rows<double, 3>& vertices,
                  const Rows<std::uint32_t, 3>& corners, obb::Fit fit, obb::Split split,
                  std::uint32_t leaf_size, std::uint32_t max_depth, bool on_demand,
                  unsigned threads) {
    const auto v = records<obb::Vec3>(vertices);
    const auto c = records<obb::Corners>(corners);
    const obb::BuildOptions options{fit, split, leaf_size, max_depth};
    nb::gil_scoped_release release;
    new (self) TreeBuilder{vertices, corners, obb::TreeBuilder(v, c, options, on_demand, threads)};
}

using Arrays =
    std::tuple<Owned<std::uint8_t, -1, 64>, Owned<std::uint32_t, -1, 3>, Owned<std::uint32_t, -1>>;

Arrays arrays_of(nb::handle_t<TreeBuilder> self) {
    const obb::TreeBuilder& builder = nb::cast<const TreeBuilder&>(self).builder;
    const auto nodes = [&] {
        using Nodes = Owned<std::uint8_t, -1, 64>;
        if (!builder.has_gaps()) {
            return seen<Nodes>(builder.nodes(), {builder.nodes().size(), 64}, self);
        }
        std::vector<obb::Node> together;
        {
            nb::gil_scoped_release release;
            together = builder.without_gaps();
        }
        const std::size_t count = together.size();
        return owned<Nodes>(std::move(together), {count, 64});
    };
    const std::size_t count = builder.corners().size();
    return {nodes(), seen<Owned<std::uint32_t, -1, 3>>(builder.corners(), {count, 3}, self),
            seen<Owned<std::uint32_t, -1>>(builder.triangle_ids(), {count}, self)};
}

std::vector<std::tuple<std::uint64_t, std::uint64_t, double>> levels_of(const Tree& tree) {
    nb::gil_scoped_release release; // only numbers are made here
    std::vector<std::tuple<std::uint64_t, std::uint64_t, double>> levels;
    for (const obb::Level& level : obb::tree_levels(tree.view)) {
        levels.emplace_back(level.box_count, level.leaf_count, level.volume);
    }
    return levels;
}

using BoxArrays = std::tuple<Owned<std::uint32_t, -1, 4>, Owned<double, -1, 15>, std::uint32_t>;

// A row each: slot, depth, first triangle, end of triangles; center, axes, half extents.
BoxArrays box_arrays(const obb::ShownBoxes& found) {
    std::vector<std::array<std::uint32_t, 4>> refs;
    std::vector<obb::Obb> boxes;
    for (const auto& [ref, box] : found.boxes) {
        refs.push_back({ref.slot, ref.depth, ref.begin, ref.end});
        boxes.push_back(box);
    }
    const std::size_t count = boxes.size();
    return {owned<Owned<std::uint32_t, -1, 4>>(std::move(refs), {count, 4}),
            owned<Owned<double, -1, 15>>(std::move(boxes), {count, 15}), found.deepest};
}

BoxArrays level_of(const Tree& tree, std::uint32_t level) {
    const obb::ShownBoxes found = [&] {
        nb::gil_scoped_release release;
        return obb::boxes_of_level(tree.view, level);
    }();
    return box_arrays(found);
}

std::optional<BoxArrays> under(const Tree& tree, std::uint32_t slot) {
    const std::optional<obb::ShownBoxes> found = [&] {
        nb::gil_scoped_release release;
        return obb::last_boxes_under(tree.view, slot);
    }();
    return found ? std::optional(box_arrays(*found)) : std::nullopt;
}

} // namespace

std::uint64_t Tree::node_count() const {
    return builder == nullptr ? view.nodes.size() : builder->node_count();
}

void bind_tree(nb::module_& m) {
    nb::enum_<obb::Fit>(m, "Fit")
        .value("TRIANGLES", obb::Fit::kTriangles)
        .value("POINTS", obb::Fit::kPoints)
        .value("HULL", obb::Fit::kHull)
        .value("MIN_VOLUME", obb::Fit::kMinVolume)
        .value("AXIS_ALIGNED", obb::Fit::kAxisAligned);
    nb::enum_<obb::Split>(m, "Split")
        .value("MEDIAN", obb::Split::kMedian)
        .value("CENTER", obb::Split::kCenter)
        .value("COMPACT", obb::Split::kCompact);

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
        .def("levels", &levels_of)
        .def("boxes_of_level", &level_of, "level"_a)
        .def("last_boxes_under", &under, "slot"_a)
        .def_prop_ro("node_count", &Tree::node_count)
        .def_rw("possible_node_count", &Tree::possible_node_count)
        .def_rw("unit", &Tree::unit)
        .def_rw("has_parts", &Tree::has_parts);

    nb::class_<TreeBuilder>(m, "TreeBuilder")
        .def("__init__", &init_builder, "vertices"_a, "corners"_a, "fit"_a, "split"_a,
             "leaf_size"_a, "max_depth"_a, "on_demand"_a, "threads"_a)
        .def(
            "advance",
            [](TreeBuilder& self, std::uint64_t work) { return self.builder.advance(work); },
            "work"_a, nb::call_guard<nb::gil_scoped_release>())
        .def("progress", [](const TreeBuilder& self) { return self.builder.progress(); })
        .def(
            "tree",
            [](const TreeBuilder& self) {
                return Tree{{}, {}, {}, {}, self.builder.view(), &self.builder};
            },
            nb::keep_alive<0, 1>())
        .def("arrays", &arrays_of)
        .def_prop_ro("scale_exponent",
                     [](const TreeBuilder& self) { return self.builder.scale_exponent(); })
        .def_prop_ro("node_count",
                     [](const TreeBuilder& self) { return self.builder.node_count(); })
        .def_prop_ro("byte_count",
                     [](const TreeBuilder& self) { return self.builder.byte_count(); });
}
