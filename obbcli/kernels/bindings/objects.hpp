// Objects of Python whose memory is laid out here, as the classes `Pose`, `Body` and `Collision` of
// the package derive from them. Bound by nanobind they would take several times as long to make,
// and that is most of what a question about two bodies far from each other takes.
#pragma once

#include "bindings/module.hpp"

#include "at_rest/static_query.hpp"
#include "in_motion/contact_query.hpp"

// ---- Poses

struct PoseObject {
    PyObject ob_base; // what every object begins with
    obb::Pose pose;
    PyObject* rotation; // read-only arrays, made when they are first looked at
    PyObject* translation;
};

// What a Python object holds of a type made here; null for objects of other kinds.
[[nodiscard]] PoseObject* as_pose(PyObject* object);

// ---- Bodies, and trees where a pose puts them

struct PlacedObject {
    PyObject ob_base; // what every object begins with
    PyObject* shape;  // of bodies, as the next two
    PyObject* pose;
    PyObject* motion;
    Placed here; // no tree where the shape is none yet
    bool rests;
    bool is_steady; // its velocities are constant
};

[[nodiscard]] PlacedObject* as_placed(PyObject* object);

// One of many, as the memory of its object has it, which the caller keeps alive.
struct PlacedRef {
    const Placed* placed = nullptr;

    const Placed& operator*() const { return *placed; }
};

// ---- Answers that need no more than numbers

struct AtRestFound {
    bool is_complete = false, is_by_boxes = false, has_witness = false;
    std::int64_t triangle_a = 0, triangle_b = 0;
    double error_bound = 0;
    double load_seconds = 0, seconds = 0;
    std::array<std::uint64_t, 9> counts{}; // as `QueryStats` has them
};

inline std::array<std::uint64_t, 9> all_counts(const obb::WalkCounts& counts, const Tree& a,
                                               const Tree& b) {
    return {counts.box_tests, counts.triangle_tests, counts.exact_triangle_tests,
            counts.pops,      counts.image_tests,    a.node_count(),
            b.node_count(),   a.possible_node_count, b.possible_node_count};
}

// Takes over the first pair of triangles that a query found, if it found any.
inline void set_witness(AtRestFound& found, std::span<const obb::TrianglePair> pairs) {
    found.has_witness = !pairs.empty();
    if (found.has_witness) {
        found.triangle_a = pairs.front().a;
        found.triangle_b = pairs.front().b;
    }
}

// An answer of the class that was made known; std::logic_error while none was.
[[nodiscard]] nanobind::object answer_of(const AtRestFound& found);

// What the kernels say of two placed trees. Throws std::domain_error, obb::TreeError, and what a
// signal's handler raised.
[[nodiscard]] AtRestFound ask_at_rest(const Placed& a, const Placed& b, const obb::Limits& limits);

// The first few pops of a question about bodies of constant velocities.
struct MovingAsked {
    // Whether that is all: they are proven apart for the whole duration, or they meet at t = 0 and
    // no more than that is asked.
    bool is_told = false;
    AtRestFound found;
    nb::tuple queries; // elsewhere: at t = 0, of the motion or None, and whether all is answered
};

// Throws as `ask_at_rest`.
[[nodiscard]] MovingAsked ask_moving(const Placed& a, const obb::Screw& screw_a, const Placed& b,
                                     const obb::Screw& screw_b,
                                     const obb::ContactQueryOptions& options);

// ---- How functions bound by nanobind take them

namespace nanobind::detail {

template <>
struct type_caster<obb::Pose> {
    NB_TYPE_CASTER(obb::Pose, const_name("Pose"))

    bool from_python(handle source, std::uint8_t, cleanup_list*) noexcept {
        const PoseObject* object = as_pose(source.ptr());
        if (object != nullptr) {
            value = object->pose;
        }
        return object != nullptr;
    }
};

template <>
struct type_caster<Placed> {
    NB_TYPE_CASTER(Placed, const_name("Placed"))

    bool from_python(handle source, std::uint8_t, cleanup_list*) noexcept {
        const PlacedObject* object = as_placed(source.ptr());
        if (object == nullptr || object->here.tree == nullptr) {
            return false;
        }
        value = object->here;
        return true;
    }
};

template <>
struct type_caster<PlacedRef> {
    NB_TYPE_CASTER(PlacedRef, const_name("Placed"))

    bool from_python(handle source, std::uint8_t, cleanup_list*) noexcept {
        const PlacedObject* object = as_placed(source.ptr());
        value = {object == nullptr || object->here.tree == nullptr ? nullptr : &object->here};
        return value.placed != nullptr;
    }
};

} // namespace nanobind::detail

// ---- What types made here have in common

// Adds a type that Python classes may derive from to the module; a borrowed reference.
PyTypeObject* add_type(nb::module_& m, const char* name, PyType_Spec& spec,
                       PyTypeObject* base = nullptr);

// Arguments of a call, by position or name; those not given are null. False where there are others
// or one is given twice: the Python function that is asked then says so.
template <std::size_t kCount>
[[nodiscard]] bool take_arguments(PyObject* args, PyObject* kwargs,
                                  const std::array<PyObject*, kCount>& names,
                                  std::array<PyObject*, kCount>& values) {
    const auto given = static_cast<std::size_t>(PyTuple_Size(args));
    if (given > kCount) {
        return false;
    }
    for (std::size_t k = 0; k < given; ++k) {
        values[k] = PyTuple_GetItem(args, static_cast<Py_ssize_t>(k));
    }
    if (kwargs == nullptr) {
        return true;
    }
    std::size_t named = 0;
    for (std::size_t k = given; k < kCount; ++k) {
        values[k] = PyDict_GetItemWithError(kwargs, names[k]);
        named += values[k] != nullptr ? 1 : 0;
    }
    return named == static_cast<std::size_t>(PyDict_Size(kwargs));
}

// Calls the method `name` of an object, as its class or a class derived has it.
[[nodiscard]] PyObject* call_method(PyObject* self, const char* name, PyObject* args,
                                    PyObject* kwargs);
// Replaces a reference that an object holds.
inline void hold(PyObject*& place, PyObject* value) {
    PyObject* before = place;
    Py_XINCREF(value);
    place = value;
    Py_XDECREF(before);
}
// Gives the memory of an object back, and its hold on its type.
void free_object(PyObject* self);
