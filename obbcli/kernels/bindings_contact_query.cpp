// Questions about moving bodies across the border.
#include "bindings.hpp"

#include "contact_query.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <array>
#include <optional>
#include <tuple>

using namespace nb::literals;

namespace {

using Triple = std::array<double, 3>;

obb::Vec3 vec(const Triple& v) { return {v[0], v[1], v[2]}; }
Triple triple(obb::Vec3 v) { return {v.x, v.y, v.z}; }

// low, high, evidence, triangle of A, triangle of B, distance, error bound
using Found =
    std::tuple<double, double, obb::Evidence, std::uint32_t, std::uint32_t, double, double>;
// point on A, point on B, normal, normal of A, normal of B, dimensions of the features
using Place = std::tuple<Triple, Triple, Triple, Triple, Triple, int, int>;

std::optional<Found> contact_of(const obb::ContactQuery& query) {
    const auto& c = query.contact();
    if (!c) {
        return std::nullopt;
    }
    return Found{c->low,           c->high,     c->evidence,   query.id_a(c->a),
                 query.id_b(c->b), c->distance, c->error_bound};
}

Place place_of(obb::ContactQuery& query) {
    if (!query.contact()) {
        throw std::invalid_argument("there is no contact");
    }
    const obb::ContactPlace p = query.place();
    return {triple(p.point_a),  triple(p.point_b), triple(p.normal), triple(p.normal_a),
            triple(p.normal_b), p.dimension_a,     p.dimension_b};
}

} // namespace

void bind_contact_query(nb::module_& m) {
    nb::enum_<obb::Evidence>(m, "Evidence")
        .value("NONE", obb::Evidence::kNone)
        .value("INTERSECTING", obb::Evidence::kIntersecting)
        .value("WITHIN_TOLERANCE", obb::Evidence::kWithinTolerance)
        .value("BOXES", obb::Evidence::kBoxes);

    nb::class_<obb::Screw>(m, "Screw")
        .def(
            "__init__",
            [](obb::Screw* self, const Triple& linear, const Triple& angular, const Triple& pivot) {
                new (self) obb::Screw{vec(linear), vec(angular), vec(pivot)};
            },
            "linear_velocity"_a, "angular_velocity"_a, "pivot"_a);

    nb::class_<obb::ContactQuery>(m, "ContactQuery")
        .def(
            "__init__",
            [](obb::ContactQuery* self, const Tree& a, const obb::Pose& pose_a,
               const obb::Screw& screw_a, const Tree& b, const obb::Pose& pose_b,
               const obb::Screw& screw_b, double duration, double time_tolerance,
               double distance_tolerance, double clearance, bool boxes_for_leaves,
               std::uint32_t max_depth_a, std::uint32_t max_depth_b, bool any_contact) {
                new (self)
                    obb::ContactQuery(a.view, pose_a, screw_a, b.view, pose_b, screw_b,
                                      {duration, time_tolerance, distance_tolerance, clearance,
                                       boxes_for_leaves, max_depth_a, max_depth_b, any_contact});
            },
            "a"_a, "pose_a"_a, "screw_a"_a, "b"_a, "pose_b"_a, "screw_b"_a, nb::kw_only(),
            "duration"_a, "time_tolerance"_a, "distance_tolerance"_a, "clearance"_a,
            "boxes_for_leaves"_a, "max_depth_a"_a, "max_depth_b"_a, "any_contact"_a,
            nb::keep_alive<1, 2>(), nb::keep_alive<1, 5>())
        .def("advance", &obb::ContactQuery::advance, "max_pops"_a,
             nb::call_guard<nb::gil_scoped_release>())
        .def_prop_ro("lower_bound", &obb::ContactQuery::lower_bound)
        .def_prop_ro("has_given_up", &obb::ContactQuery::has_given_up)
        .def("contact", &contact_of)
        .def("place", &place_of)
        .def("counts", [](const obb::ContactQuery& q) {
            const obb::ContactQueryCounts& c = q.counts();
            return std::tuple{c.box_tests, c.triangle_tests, c.exact_triangle_tests, c.pops};
        });
}
