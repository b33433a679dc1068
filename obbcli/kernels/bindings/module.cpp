// The module: what the border consists of. No geometry in the bindings*.cpp files.
#include "bindings/module.hpp"

#include <limits>

namespace {

// Whether denormals survive: libraries linked with -ffast-math switch them off for the whole
// process, and every rounding bound here assumes them.
bool keeps_denormals() {
    volatile double smallest = std::numeric_limits<double>::denorm_min();
    volatile double one = 1.0;
    return smallest / one != 0.0; // zero where operands or results are flushed
}

} // namespace

NB_MODULE(_core, m) {
    nb::set_leak_warnings(false); // what a caller still holds at exit is no leak
    nb::exception<obb::TreeError>(m, "TreeError", PyExc_RuntimeError);
    m.def("keeps_denormals", &keeps_denormals);
    bind_limits(m);
    bind_hull(m);
    bind_thickness(m);
    bind_tree(m);
    bind_file_tree(m);
    bind_pose(m);
    bind_placed(m);
    bind_answer(m);
    bind_quick_call(m);
    bind_static_query(m);
    bind_contact_query(m);
    bind_steady_pairs(m);
    bind_sweep(m);
    bind_containment(m);
    bind_solid_probe(m);
    bind_protrusion(m);
    bind_primitives(m);
    bind_distance(m);
    bind_swept_pairs(m);
    bind_overlap_volume(m);
    bind_overlap_regions(m);
    bind_clearance(m);
}
