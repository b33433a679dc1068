// What `Collision` derives from: what the kernels found of bodies at rest, as numbers until it is
// read, or the fields of any other answer.
#include "bindings/objects.hpp"

#include <array>
#include <new>
#include <stdexcept>

namespace {

enum Field : std::size_t { kStatus, kWitness, kApproximate, kErrorBound, kStats, kFieldCount };

struct AnswerObject {
    PyObject ob_base;                          // what every object begins with
    std::array<PyObject*, kFieldCount> fields; // null until it is read
    AtRestFound found;
};

// What the package makes known of its classes.
PyTypeObject* answer_type = nullptr; // the base of them
PyTypeObject* collision_class = nullptr;
PyObject *separated = nullptr, *overlapping = nullptr, *unresolved = nullptr;
PyObject *stats_class = nullptr, *is_contact = nullptr;

AnswerObject* cast(PyObject* self) { return reinterpret_cast<AnswerObject*>(self); }

PyObject* new_answer(PyTypeObject* type, PyObject*, PyObject*) {
    PyObject* self = PyType_GenericAlloc(type, 0); // which clears it
    if (self != nullptr) {
        new (&cast(self)->found) AtRestFound;
    }
    return self;
}

PyObject* status_of(const AtRestFound& found) {
    if (found.is_by_boxes || found.has_witness) {
        return overlapping;
    }
    return found.is_complete ? separated : unresolved;
}

nb::object stats_of(const AtRestFound& found) {
    nb::dict seconds;
    seconds["load"] = found.load_seconds;
    seconds["query"] = found.seconds;
    const auto& c = found.counts;
    return nb::handle(stats_class)(c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], seconds);
}

nb::object made(const AtRestFound& found, Field field) {
    switch (field) {
    case kStatus:
        return nb::borrow(status_of(found));
    case kWitness:
        return found.has_witness ? nb::make_tuple(found.triangle_a, found.triangle_b)
                                 : nb::object(nb::none());
    case kApproximate:
        return nb::cast(found.is_by_boxes);
    case kErrorBound:
        return nb::cast(found.error_bound);
    default:
        return stats_of(found);
    }
}

template <Field kField>
PyObject* field_of(PyObject* self, void*) try {
    PyObject*& kept = cast(self)->fields[kField];
    if (kept == nullptr) {
        nb::object value = made(cast(self)->found, kField);
        if (kept == nullptr) { // else another thread was sooner
            kept = value.release().ptr();
        }
    }
    Py_INCREF(kept);
    return kept;
} catch (nb::python_error& error) {
    error.restore();
    return nullptr;
}

PyObject* collides(PyObject* self, void*) {
    PyObject* status = cast(self)->fields[kStatus];
    if (status == nullptr) {
        status = status_of(cast(self)->found);
    }
    if (status == unresolved) { // which is refused
        return PyObject_CallFunctionObjArgs(is_contact, status, nullptr);
    }
    return PyBool_FromLong(status != separated ? 1 : 0);
}

// Takes over the fields of an answer.
PyObject* hold_fields(PyObject* self, PyObject* args) {
    std::array<PyObject*, kFieldCount> given{};
    if (PyArg_ParseTuple(args, "OOOOO", &given[0], &given[1], &given[2], &given[3], &given[4]) ==
        0) {
        return nullptr;
    }
    for (std::size_t k = 0; k < kFieldCount; ++k) {
        hold(cast(self)->fields[k], given[k]);
    }
    Py_RETURN_NONE;
}

int visit_answer(PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    for (PyObject* field : cast(self)->fields) {
        Py_VISIT(field);
    }
    return 0;
}

int clear_answer(PyObject* self) {
    for (PyObject*& field : cast(self)->fields) {
        Py_CLEAR(field);
    }
    return 0;
}

void delete_answer(PyObject* self) {
    PyObject_GC_UnTrack(self);
    (void)clear_answer(self);
    free_object(self);
}

constexpr const char* kCollidesDoc =
    "Whether the bodies touch.\n\nRaises:\n    UnresolvedError: a limit was reached before the "
    "answer was known.";

PyGetSetDef answer_properties[] = {
    {"_status", &field_of<kStatus>, nullptr, "How the question ended.", nullptr},
    {"_witness", &field_of<kWitness>, nullptr, "Triangles that meet, or None.", nullptr},
    {"_approximate", &field_of<kApproximate>, nullptr, "Whether contact is not proven.", nullptr},
    {"_error_bound", &field_of<kErrorBound>, nullptr, "Mesh units.", nullptr},
    {"_stats", &field_of<kStats>, nullptr, "What the question cost.", nullptr},
    {"collides", &collides, nullptr, kCollidesDoc, nullptr},
    {}};
PyMethodDef answer_methods[] = {
    {"_hold", &hold_fields, METH_VARARGS,
     "_hold($self, status, witness, approximate, error_bound, stats, /)\n--\n\n"},
    {}};
PyType_Slot answer_slots[] = {{Py_tp_new, reinterpret_cast<void*>(&new_answer)},
                              {Py_tp_dealloc, reinterpret_cast<void*>(&delete_answer)},
                              {Py_tp_traverse, reinterpret_cast<void*>(&visit_answer)},
                              {Py_tp_clear, reinterpret_cast<void*>(&clear_answer)},
                              {Py_tp_getset, answer_properties},
                              {Py_tp_methods, answer_methods},
                              {0, nullptr}};
PyType_Spec answer_spec{"obbcli.kernels._core.AtRestAnswer", sizeof(AnswerObject), 0,
                        Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_HAVE_GC,
                        answer_slots};

PyObject* kept(const nb::object& object) { return nb::object(object).release().ptr(); }

void set_answer_classes(const nb::object& collision, const nb::object& stats,
                        const nb::tuple& statuses, const nb::object& contact) {
    if (PyType_Check(collision.ptr()) == 0 ||
        PyType_IsSubtype(reinterpret_cast<PyTypeObject*>(collision.ptr()), answer_type) == 0) {
        throw nb::type_error("answers are of a class derived from AtRestAnswer");
    }
    collision_class = reinterpret_cast<PyTypeObject*>(kept(collision));
    stats_class = kept(stats);
    separated = kept(statuses[0]);
    overlapping = kept(statuses[1]);
    unresolved = kept(statuses[2]);
    is_contact = kept(contact);
}

} // namespace

nb::object answer_of(const AtRestFound& found) {
    if (collision_class == nullptr) {
        throw std::logic_error("set_answer_classes() comes before questions at rest");
    }
    const nb::object self = nb::steal(PyType_GenericAlloc(collision_class, 0));
    if (!self.is_valid()) {
        throw nb::python_error();
    }
    new (&cast(self.ptr())->found) AtRestFound(found);
    return self;
}

void bind_answer(nb::module_& m) {
    answer_type = add_type(m, "AtRestAnswer", answer_spec);
    m.def("set_answer_classes", &set_answer_classes, nb::arg("collision"), nb::arg("stats"),
          nb::arg("statuses"), nb::arg("is_contact"));
}
