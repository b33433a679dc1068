// The least distance of bodies in motion across the border.
#include "bindings/module.hpp"

#include "clearance/clearance_query.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <tuple>
#include <utility>
#include <vector>

using namespace nb::literals;

namespace {

using Query = obb::ClearanceQuery;
using Point = std::tuple<double, double, double>;
using Witness = std::tuple<double, Point, Point, std::uint32_t, std::uint32_t>;

void init_query(Query* self, const Tree& a, const obb::Pose& pose_a, const obb::Screw& screw_a,
                const Tree& b, const obb::Pose& pose_b, const obb::Screw& screw_b, double start,
                double end, double tolerance, std::optional<double> at_least, double high,
                double slack) {
    const nb::gil_scoped_release release; // goes down to pairs of triangles
    new (self) Query(a.view, pose_a, screw_a, b.view, pose_b, screw_b,
                     {.from = start,
                      .until = end,
                      .tolerance = tolerance,
                      .at_least = at_least,
                      .high = high,
                      .slack = slack});
}

// s, point_a, point_b, triangle_a, triangle_b
std::optional<Witness> witness_of(const Query& query) {
    const auto witness = query.witness();
    if (!witness) {
        return std::nullopt;
    }
    const auto point = [](const obb::Vec3& p) { return Point{p.x, p.y, p.z}; };
    return Witness{witness->seconds, point(witness->point_a), point(witness->point_b),
                   witness->triangle_a, witness->triangle_b};
}

std::vector<std::pair<double, double>> when(const Query& query, double limit) {
    std::vector<std::pair<double, double>> spans;
    for (const obb::TimeSpan& span : query.when(limit)) {
        spans.emplace_back(span.low, span.high);
    }
    return spans;
}

} // namespace

void bind_clearance(nb::module_& m) {
    nb::class_<Query>(m, "ClearanceQuery")
        .def("__init__", &init_query, "tree_a"_a, "pose_a"_a, "screw_a"_a, "tree_b"_a, "pose_b"_a,
             "screw_b"_a, nb::kw_only(), "start"_a, "end"_a, "tolerance"_a,
             "at_least"_a.none() = nb::none(), "high"_a, "slack"_a, nb::keep_alive<1, 2>(),
             nb::keep_alive<1, 5>())
        .def("advance", &Query::advance, "max_pops"_a, nb::call_guard<nb::gil_scoped_release>())
        .def_prop_ro("bounds", [](const Query& q) { return std::pair{q.low(), q.high()}; })
        .def_prop_ro("is_contact", &Query::is_contact)
        .def_prop_ro("witness", &witness_of)
        .def("when", &when, "limit"_a)
        .def("counts", [](const Query& q) { return counts_of(q.counts()); });
}
