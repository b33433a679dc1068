// Questions about moving bodies across the border.
#include "bindings/module.hpp"

#include "in_motion/contact_query.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <array>
#include <limits>
#include <optional>
#include <tuple>

using namespace nb::literals;

namespace {

using Triple = std::array<double, 3>;

obb::Vec3 vec(const Triple& v) { return {v[0], v[1], v[2]}; }
Triple triple(obb::Vec3 v) { return {v.x, v.y, v.z}; }

// point on A, point on B, normal, normal of A, normal of B, dimensions of the features
using Place = std::tuple<Triple, Triple, Triple, Triple, Triple, int, int>;

Place place_of(obb::ContactQuery& query, const obb::Contact& contact) {
    const obb::ContactPlace p = query.place(contact);
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

    nb::class_<obb::Contact>(m, "Contact")
        .def_ro("low", &obb::Contact::low)
        .def_ro("high", &obb::Contact::high)
        .def_ro("evidence", &obb::Contact::evidence)
        .def_ro("triangle_a", &obb::Contact::triangle_a)
        .def_ro("triangle_b", &obb::Contact::triangle_b)
        // Which pair it is, boxes included.
        .def_prop_ro("ranges",
                     [](const obb::Contact& c) {
                         return std::tuple{c.a.begin, c.a.end, c.b.begin, c.b.end};
                     })
        .def_ro("distance", &obb::Contact::distance)
        .def_ro("error_bound", &obb::Contact::error_bound);

    nb::class_<obb::ContactQuery>(m, "ContactQuery")
        .def(
            "__init__",
            [](obb::ContactQuery* self, const Tree& a, const obb::Pose& pose_a,
               const obb::Screw& screw_a, const Tree& b, const obb::Pose& pose_b,
               const obb::Screw& screw_b, double duration, double time_tolerance,
               double distance_tolerance, double clearance, bool boxes_for_leaves,
               std::uint32_t max_depth_a, std::uint32_t max_depth_b, bool any_contact,
               bool each_pair) {
                new (self) obb::ContactQuery(a.view, pose_a, screw_a, b.view, pose_b, screw_b,
                                             {duration, time_tolerance, distance_tolerance,
                                              clearance, boxes_for_leaves, max_depth_a, max_depth_b,
                                              any_contact, each_pair});
            },
            "a"_a, "pose_a"_a, "screw_a"_a, "b"_a, "pose_b"_a, "screw_b"_a, nb::kw_only(),
            "duration"_a, "time_tolerance"_a, "distance_tolerance"_a, "clearance"_a,
            "boxes_for_leaves"_a, "max_depth_a"_a, "max_depth_b"_a, "any_contact"_a, "each_pair"_a,
            nb::keep_alive<1, 2>(), nb::keep_alive<1, 5>())
        .def("advance", &obb::ContactQuery::advance, "max_pops"_a,
             "until"_a = std::numeric_limits<double>::infinity(),
             nb::call_guard<nb::gil_scoped_release>())
        .def_prop_ro("lower_bound", &obb::ContactQuery::lower_bound)
        .def_prop_ro("has_given_up", &obb::ContactQuery::has_given_up)
        .def("contact", &obb::ContactQuery::contact)
        .def("take", &obb::ContactQuery::take)
        .def("place", &place_of)
        .def("counts", [](const obb::ContactQuery& q) {
            const obb::ContactQueryCounts& c = q.counts();
            return std::tuple{c.box_tests, c.triangle_tests, c.exact_triangle_tests, c.pops};
        });
}
