// The border to Python: arrays in, arrays and plain values out. No geometry here.
#include "static_query.hpp"
#include "tree_build.hpp"
#include "tree_check.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

namespace nb = nanobind;
using namespace nb::literals;

namespace {

template <typename T, nb::ssize_t kColumns>
using Rows =
    nb::ndarray<const T, nb::numpy, nb::shape<-1, kColumns>, nb::c_contig, nb::device::cpu>;
template <typename T>
using Column = nb::ndarray<const T, nb::numpy, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

// Reinterprets the rows of a contiguous array as records of the same size.
template <typename Record, typename T, nb::ssize_t kColumns>
std::span<const Record> records(const Rows<T, kColumns>& rows) {
    static_assert(sizeof(Record) == sizeof(T) * kColumns);
    if (rows.shape(0) == 0) {
        return {}; // the pointer of an empty array means nothing
    }
    if (reinterpret_cast<std::uintptr_t>(rows.data()) % alignof(Record) != 0) {
        throw std::invalid_argument("array is not aligned");
    }
    return {reinterpret_cast<const Record*>(rows.data()), rows.shape(0)};
}

template <typename Number, nb::ssize_t... kShape>
using Owned = nb::ndarray<nb::numpy, const Number, nb::shape<kShape...>>;

// Hands a vector over to NumPy without copying it.
template <typename Array, typename Record>
Array owned(std::vector<Record>&& records, std::initializer_list<std::size_t> shape) {
    auto* kept = new std::vector<Record>(std::move(records));
    const nb::capsule owner(kept,
                            [](void* p) noexcept { delete static_cast<std::vector<Record>*>(p); });
    return Array(kept->data(), shape, owner);
}

// Arrays of a tree, kept alive, and the view on them that the kernels use.
struct Tree {
    Rows<double, 3> vertices;
    Rows<std::uint32_t, 3> corners;
    Column<std::uint32_t> triangle_ids;
    Rows<std::uint8_t, 64> nodes;
    obb::TreeView view;
};

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
    auto nodes = builder.take_nodes();
    auto ids = builder.triangle_ids();
    const std::size_t node_count = nodes.size(), id_count = ids.size();
    return {owned<Owned<std::uint8_t, -1, 64>>(std::move(nodes), {node_count, 64}),
            owned<Owned<std::uint32_t, -1>>(std::move(ids), {id_count}), builder.scale_exponent()};
}

std::vector<std::tuple<std::uint64_t, std::uint64_t, double>> levels_of(const Tree& tree) {
    std::vector<std::tuple<std::uint64_t, std::uint64_t, double>> levels;
    for (const obb::Level& level : obb::tree_levels(tree.view)) {
        levels.emplace_back(level.box_count, level.leaf_count, level.volume);
    }
    return levels;
}

Owned<std::int64_t, -1, 2> pairs_of(const obb::StaticQuery& query) {
    const auto found = query.pairs();
    return owned<Owned<std::int64_t, -1, 2>>(
        std::vector<obb::TrianglePair>(found.begin(), found.end()), {found.size(), 2});
}

// Whether denormals survive: libraries linked with -ffast-math switch them off for the whole
// process, and every rounding bound here assumes them.
bool keeps_denormals() {
    volatile double smallest = std::numeric_limits<double>::denorm_min();
    volatile double one = 1.0;
    return smallest / one != 0.0; // zero where operands or results are flushed
}

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

void init_pose(
    obb::Pose* self,
    const nb::ndarray<const double, nb::numpy, nb::shape<3, 3>, nb::c_contig>& rotation,
    const nb::ndarray<const double, nb::numpy, nb::shape<3>, nb::c_contig>& translation) {
    new (self) obb::Pose;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            self->rotation.rows[i][k] = rotation(i, k);
        }
        self->translation[i] = translation(i);
    }
}

void bind_static_query(nb::module_& m) {
    nb::class_<obb::Pose>(m, "Pose").def("__init__", &init_pose, "rotation"_a, "translation"_a);
    nb::class_<obb::StaticQuery>(m, "StaticQuery")
        .def(
            "__init__",
            [](obb::StaticQuery* self, const Tree& a, const obb::Pose& pose_a, const Tree& b,
               const obb::Pose& pose_b, bool all_pairs, bool boxes_for_leaves,
               std::uint32_t max_depth_a, std::uint32_t max_depth_b, std::uint64_t limit) {
                new (self) obb::StaticQuery(
                    a.view, pose_a, b.view, pose_b,
                    {all_pairs, boxes_for_leaves, max_depth_a, max_depth_b, limit});
            },
            "a"_a, "pose_a"_a, "b"_a, "pose_b"_a, "all_pairs"_a, "boxes_for_leaves"_a,
            "max_depth_a"_a, "max_depth_b"_a, "limit"_a, nb::keep_alive<1, 2>(),
            nb::keep_alive<1, 4>())
        .def("advance", &obb::StaticQuery::advance, "max_pops"_a,
             nb::call_guard<nb::gil_scoped_release>())
        .def("pairs", &pairs_of)
        .def_prop_ro("is_contact", &obb::StaticQuery::is_contact)
        .def_prop_ro("is_by_boxes", &obb::StaticQuery::is_by_boxes)
        .def_prop_ro("error_bound", &obb::StaticQuery::error_bound)
        // One call for all the counters: reading them one by one would cost more than many a query.
        .def("counts", [](const obb::StaticQuery& q) {
            const obb::StaticQueryCounts& c = q.counts();
            return std::tuple{c.box_tests, c.triangle_tests, c.exact_triangle_tests, c.pops};
        });
}

} // namespace

NB_MODULE(_core, m) {
    nb::exception<obb::TreeError>(m, "TreeError", PyExc_RuntimeError);
    m.def("keeps_denormals", &keeps_denormals);
    bind_tree(m);
    bind_static_query(m);
}
