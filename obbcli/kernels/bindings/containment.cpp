// Closed surfaces as solids across the border.
#include "bindings/module.hpp"

#include "at_rest/connected_parts.hpp"
#include "at_rest/containment_query.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <array>
#include <tuple>

using namespace nb::literals;

namespace {

Owned<std::int64_t, -1> parts_of(const Rows<std::int64_t, 3>& corners,
                                 std::int64_t position_count) {
    const auto rows = records<std::array<std::int64_t, 3>>(corners);
    std::vector<std::int64_t> firsts;
    {
        const nb::gil_scoped_release release;
        firsts = obb::first_triangles_of_parts(rows, position_count);
    }
    const std::size_t count = firsts.size();
    return owned<Owned<std::int64_t, -1>>(std::move(firsts), {count});
}

} // namespace

void bind_containment(nb::module_& m) {
    m.def("first_triangles_of_parts", &parts_of, "corners"_a, "position_count"_a);
    nb::class_<obb::ContainmentQuery>(m, "ContainmentQuery")
        .def(
            "__init__",
            [](obb::ContainmentQuery* self, const Tree& tree, const obb::Pose& pose,
               const Rows<double, 3>& points) {
                const auto rows = records<obb::Vec3>(points);
                new (self) obb::ContainmentQuery(tree.view, pose, {rows.begin(), rows.end()});
            },
            "tree"_a, "pose"_a, "points"_a, nb::keep_alive<1, 2>())
        .def("advance", &obb::ContainmentQuery::advance, "max_pops"_a,
             nb::call_guard<nb::gil_scoped_release>())
        .def_prop_ro("inside", &obb::ContainmentQuery::inside)
        .def("counts", [](const obb::ContainmentQuery& q) { return counts_of(q.counts()); });
}
