// Questions about moving bodies across the border.
#include "bindings/contact_place.hpp"
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

std::tuple<double, double, double> as_python(obb::Vec3 v) { return {v.x, v.y, v.z}; }
template <typename Number>
Number as_python(Number number) {
    return number;
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

    nb::class_<obb::ContactPlace> place(m, "ContactPlace");
    each_place_field([&place](const char* name, auto member) {
        place.def_prop_ro(name,
                          [member](const obb::ContactPlace& p) { return as_python(p.*member); });
    });

    nb::class_<obb::ContactQuery>(m, "ContactQuery")
        .def(
            "__init__",
            [](obb::ContactQuery* self, const Tree& a, const obb::Pose& pose_a,
               const obb::Screw& screw_a, const Tree& b, const obb::Pose& pose_b,
               const obb::Screw& screw_b, const obb::Limits& limits, double duration,
               double time_tolerance, bool any_contact, bool each_pair,
               std::optional<std::uint64_t> box_tests_before_screw) {
                new (self) obb::ContactQuery(a.view, pose_a, screw_a, b.view, pose_b, screw_b,
                                             {duration, time_tolerance, limits, any_contact,
                                              each_pair, box_tests_before_screw});
            },
            "a"_a, "pose_a"_a, "screw_a"_a, "b"_a, "pose_b"_a, "screw_b"_a, "limits"_a,
            nb::kw_only(), "duration"_a, "time_tolerance"_a, "any_contact"_a, "each_pair"_a,
            "box_tests_before_screw"_a = nb::none(), nb::keep_alive<1, 2>(), nb::keep_alive<1, 5>())
        .def("advance", &obb::ContactQuery::advance, "max_pops"_a,
             "until"_a = std::numeric_limits<double>::infinity(),
             nb::call_guard<nb::gil_scoped_release>())
        .def_prop_ro("lower_bound", &obb::ContactQuery::lower_bound)
        .def_prop_ro("has_given_up", &obb::ContactQuery::has_given_up)
        .def("contact", &obb::ContactQuery::contact)
        .def("take", &obb::ContactQuery::take)
        .def(
            "place",
            [](obb::ContactQuery& q, const obb::Contact& contact) { return q.place(contact); },
            "contact"_a)
        .def("counts", [](const obb::ContactQuery& q) { return counts_of(q.counts()); });
}
