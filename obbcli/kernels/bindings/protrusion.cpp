// How deep one surface reaches into another solid, across the border.
#include "bindings/module.hpp"

#include "overlap/protrusion_query.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <optional>
#include <tuple>

using namespace nb::literals;

namespace {

using obb::ProtrusionQuery;

[[nodiscard]] std::optional<std::uint32_t> where_found(const ProtrusionQuery& query,
                                                       std::uint32_t triangle) {
    return query.deepest().depth > 0 ? std::optional(triangle) : std::nullopt;
}

} // namespace

void bind_protrusion(nb::module_& m) {
    nb::class_<ProtrusionQuery>(m, "ProtrusionQuery")
        .def(
            "__init__",
            [](ProtrusionQuery* self, const Tree& a, const obb::Pose& pose_a, const Tree& b,
               const obb::Pose& pose_b, double tolerance, std::optional<double> deeper_than,
               double floor, std::uint64_t max_cells, bool inside_only) {
                nb::gil_scoped_release release; // may make the trees' roots
                new (self) ProtrusionQuery(a.view, pose_a, b.view, pose_b,
                                           {tolerance, deeper_than, floor, max_cells, inside_only});
            },
            "tree_a"_a, "pose_a"_a, "tree_b"_a, "pose_b"_a, nb::kw_only(), "tolerance"_a,
            "deeper_than"_a = nb::none(), "floor"_a, "max_cells"_a, "inside_only"_a = true,
            nb::keep_alive<1, 2>(), nb::keep_alive<1, 4>())
        .def("advance", &ProtrusionQuery::advance, "max_cells"_a,
             nb::call_guard<nb::gil_scoped_release>())
        .def_prop_ro("bounds",
                     [](const ProtrusionQuery& q) { return std::tuple{q.low(), q.high()}; })
        .def_prop_ro("point",
                     [](const ProtrusionQuery& q) {
                         const obb::Vec3& p = q.deepest().world;
                         return q.deepest().depth > 0 ? std::optional(std::tuple{p.x, p.y, p.z})
                                                      : std::nullopt;
                     })
        .def_prop_ro(
            "triangle_a",
            [](const ProtrusionQuery& q) { return where_found(q, q.deepest().triangle_a); })
        .def_prop_ro(
            "triangle_b",
            [](const ProtrusionQuery& q) { return where_found(q, q.deepest().triangle_b); })
        .def_prop_ro("deeper", &ProtrusionQuery::is_deeper)
        .def_prop_ro("cells", &ProtrusionQuery::cells)
        .def_prop_ro("rays", &ProtrusionQuery::rays)
        .def_prop_ro("points", &ProtrusionQuery::points);
}
