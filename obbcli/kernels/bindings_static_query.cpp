// Questions about bodies at rest across the border.
#include "bindings.hpp"

#include "static_query.hpp"

#include <nanobind/stl/tuple.h>

#include <tuple>

using namespace nb::literals;

namespace {

Owned<std::int64_t, -1, 2> pairs_of(const obb::StaticQuery& query) {
    const auto found = query.pairs();
    return owned<Owned<std::int64_t, -1, 2>>(
        std::vector<obb::TrianglePair>(found.begin(), found.end()), {found.size(), 2});
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

} // namespace

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
