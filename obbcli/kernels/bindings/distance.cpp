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
               const obb::Pose& pose_b, const obb::Limits& limits) {
                nb::gil_scoped_release release; // goes down to a pair of triangles
                new (self) obb::DistanceQuery(a.view, pose_a, b.view, pose_b, limits);
            },
            "a"_a, "pose_a"_a, "b"_a, "pose_b"_a, "limits"_a, nb::keep_alive<1, 2>(),
            nb::keep_alive<1, 4>())
        .def("advance", &obb::DistanceQuery::advance, "max_pops"_a,
             nb::call_guard<nb::gil_scoped_release>())
        .def_prop_ro("pops", [](const obb::DistanceQuery& q) { return q.counts().pops; })
        // low, high, point_a, point_b, triangle_a, triangle_b, counts: box tests, triangle tests,
        // exact ones, pops
        .def("answer", [](const obb::DistanceQuery& q) {
            const obb::DistanceBounds b = q.bounds();
            const auto point = [](const obb::Vec3& p) { return std::tuple{p.x, p.y, p.z}; };
            return std::tuple{b.low,        b.high,       point(b.point_a),     point(b.point_b),
                              b.triangle_a, b.triangle_b, counts_of(q.counts())};
        });
}
