// How far a question is pursued, across the border: `limits_of` in border.py sets what `Accuracy`
// asks.
#include "bindings/module.hpp"

#include "descent/limits.hpp"

namespace {

// A property of the limits that lies in their `boxes`.
template <typename Value>
void bind_of_boxes(nb::class_<obb::Limits>& limits, const char* name,
                   Value obb::BoxLimits::* member) {
    limits.def_prop_rw(
        name, [member](const obb::Limits& self) { return self.boxes.*member; },
        [member](obb::Limits& self, Value value) { self.boxes.*member = value; });
}

} // namespace

void bind_limits(nb::module_& m) {
    nb::class_<obb::Limits> limits(m, "Limits");
    limits.def(nb::init<>());
    bind_of_boxes(limits, "boxes_for_leaves", &obb::BoxLimits::boxes_for_leaves);
    bind_of_boxes(limits, "max_depth_a", &obb::BoxLimits::max_depth_a);
    bind_of_boxes(limits, "max_depth_b", &obb::BoxLimits::max_depth_b);
    limits.def_rw("distance_tolerance", &obb::Limits::distance_tolerance)
        .def_rw("clearance", &obb::Limits::clearance)
        .def_rw("max_pops", &obb::Limits::max_pops)
        .def_rw("seconds", &obb::Limits::seconds);
}
