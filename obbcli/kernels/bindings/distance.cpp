// Distances of bodies at rest across the border.
#include "bindings/module.hpp"

#include "distance/distance_query.hpp"

#include <nanobind/stl/tuple.h>

#include <tuple>

using namespace nb::literals;

void bind_distance(nb::module_& m) {
    nb::class_<obb::DistanceQuery>(m, "DistanceQuery")
        .def(
            "__init__",
            [](obb::DistanceQuery* self, const Tree& a, const obb::Pose& pose_a, const Tree& b,
               const obb::Pose& pose_b, bool boxes_for_leaves, std::uint32_t max_depth_a,
               std::uint32_t max_depth_b, double tolerance) {
                nb::gil_scoped_release release; // goes down to a pair of triangles
                new (self)
                    obb::DistanceQuery(a.view, pose_a, b.view, pose_b,
                                       {boxes_for_leaves, max_depth_a, max_depth_b, tolerance});
            },
            "a"_a, "pose_a"_a, "b"_a, "pose_b"_a, "boxes_for_leaves"_a, "max_depth_a"_a,
            "max_depth_b"_a, "tolerance"_a, nb::keep_alive<1, 2>(), nb::keep_alive<1, 4>())
        .def("advance", &obb::DistanceQuery::advance, "max_pops"_a,
             nb::call_guard<nb::gil_scoped_release>())
        .def_prop_ro("pops", [](const obb::DistanceQuery& q) { return q.counts().pops; })
        // low, high, point_a, point_b, triangle_a, triangle_b, counts: box tests, triangle tests,
        // exact ones, pops
        .def("answer", [](const obb::DistanceQuery& q) {
            const obb::DistanceBounds b = q.bounds();
            const obb::DistanceQueryCounts& c = q.counts();
            const auto point = [](const obb::Vec3& p) { return std::tuple{p.x, p.y, p.z}; };
            return std::tuple{
                b.low,
                b.high,
                point(b.point_a),
                point(b.point_b),
                b.triangle_a,
                b.triangle_b,
                std::tuple{c.box_tests, c.triangle_tests, c.exact_triangle_tests, c.pops}};
        });
}
