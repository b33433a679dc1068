// `QuickCall`: a Python function, and in front of it the question about two bodies as they are, at
// rest or of constant velocities, asked in C++ alone: a Python function called for it would take as
// long as the question.
#include "bindings/objects.hpp"

#include <cstddef>
#include <exception>
#include <new>

#if PY_VERSION_HEX < 0x030c0000 // later versions name these themselves
#include <structmember.h>
#define Py_T_PYSSIZET T_PYSSIZET
#define Py_READONLY READONLY
#endif

namespace {

struct CallObject {
    PyObject ob_base; // what every object begins with
    vectorcallfunc call;
    PyObject* dict; // what functools.wraps() sets
    PyObject* weak_references;
    PyObject* function;
    PyObject* screw_of; // of a body and its tree: how it moves, as the kernels see it
    PyObject* going_on; // answers a question about moving bodies that is not over yet
    PyObject* told;     // makes the answer of bodies and what was found; None: that is the answer
    PyObject* named;    // names the parts in an answer that is what was found
    obb::ContactQueryOptions options; // of a question without more arguments
};

using CallField = PyObject* CallObject::*;
constexpr std::array<CallField, 6> kHeld{&CallObject::dict,     &CallObject::function,
                                         &CallObject::screw_of, &CallObject::going_on,
                                         &CallObject::told,     &CallObject::named};

PyObject* at_rest_name = nullptr;

CallObject* cast(PyObject* self) { return reinterpret_cast<CallObject*>(self); }

// A body whose tree is there, at rest or of constant velocities, or what says that it is one at
// rest, as trees do; else null.
PlacedObject* askable(PyObject* object, nb::object& owner) {
    PlacedObject* placed = as_placed(object);
    if (placed == nullptr) {
        owner = nb::steal(PyObject_GetAttr(object, at_rest_name));
        if (!owner.is_valid()) {
            if (PyErr_ExceptionMatches(PyExc_AttributeError) == 0) {
                throw nb::python_error();
            }
            PyErr_Clear();
            return nullptr;
        }
        placed = as_placed(owner.ptr());
    }
    const bool is_askable =
        placed != nullptr && placed->here.tree != nullptr && (placed->rests || placed->is_steady);
    return is_askable ? placed : nullptr;
}

nb::object called(PyObject* function, std::initializer_list<PyObject*> args) {
    nb::object result =
        nb::steal(PyObject_Vectorcall(function, std::data(args), args.size(), nullptr));
    if (!result.is_valid()) {
        throw nb::python_error();
    }
    return result;
}

nb::object answer_told(const CallObject& self, PyObject* a, PyObject* b, const AtRestFound& found,
                       bool has_parts) {
    nb::object answer = answer_of(found);
    if (self.told != Py_None) {
        return called(self.told, {a, b, answer.ptr()});
    }
    return found.has_witness && has_parts ? called(self.named, {a, b, answer.ptr()}) : answer;
}

// Two units are for the function to refuse.
bool are_comparable(const Tree& a, const Tree& b) {
    return a.unit == b.unit || a.unit.empty() || b.unit.empty();
}

obb::Screw screw_of(const CallObject& self, PlacedObject& body) {
    if (body.rests) {
        return {};
    }
    return nb::cast<obb::Screw>(
        called(self.screw_of, {reinterpret_cast<PyObject*>(&body), body.shape}));
}

// Null without an error where the function is to answer, which says too what is wrong.
PyObject* quick_answer(const CallObject& self, PyObject* first, PyObject* second) try {
    nb::object owner_a, owner_b;
    PlacedObject* a = askable(first, owner_a);
    PlacedObject* b = a == nullptr ? nullptr : askable(second, owner_b);
    if (b == nullptr || !are_comparable(*a->here.tree, *b->here.tree)) {
        return nullptr;
    }
    const bool has_parts = a->here.tree->has_parts || b->here.tree->has_parts;
    if (a->rests && b->rests) {
        const AtRestFound found = ask_at_rest(a->here, b->here, self.options.limits);
        return answer_told(self, first, second, found, has_parts).release().ptr();
    }
    const obb::Screw screw_a = screw_of(self, *a), screw_b = screw_of(self, *b);
    const MovingAsked asked = ask_moving(a->here, screw_a, b->here, screw_b, self.options);
    const nb::object answer = asked.is_told
                                  ? answer_told(self, first, second, asked.found, has_parts)
                                  : called(self.going_on, {first, second, asked.queries.ptr()});
    return nb::object(answer).release().ptr();
} catch (nb::python_error& error) {
    error.restore();
    return nullptr;
} catch (const std::exception&) {
    return nullptr;
}

PyObject* call(PyObject* self, PyObject* const* args, std::size_t flags, PyObject* names) {
    if (PyVectorcall_NARGS(flags) == 2 && names == nullptr) {
        PyObject* answer = quick_answer(*cast(self), args[0], args[1]);
        if (answer != nullptr || PyErr_Occurred() != nullptr) {
            return answer;
        }
    }
    return PyObject_Vectorcall(cast(self)->function, args, flags, names);
}

PyObject* new_call(PyTypeObject* type, PyObject* args, PyObject*) {
    PyObject *function = nullptr, *limits = nullptr, *screw = nullptr, *going_on = nullptr,
             *told = nullptr, *named = nullptr;
    double duration = 0, tolerance = 0;
    int any_contact = 0;
    if (PyArg_ParseTuple(args, "OOddpOOOO", &function, &limits, &duration, &tolerance, &any_contact,
                         &screw, &going_on, &told, &named) == 0) {
        return nullptr;
    }
    if (!nb::isinstance<obb::Limits>(nb::handle(limits))) {
        PyErr_SetString(PyExc_TypeError, "a quick call takes limits of the kernels");
        return nullptr;
    }
    PyObject* self = PyType_GenericAlloc(type, 0); // which clears it
    if (self != nullptr) {
        cast(self)->call = &call;
        hold(cast(self)->function, function);
        hold(cast(self)->screw_of, screw);
        hold(cast(self)->going_on, going_on);
        hold(cast(self)->told, told);
        hold(cast(self)->named, named);
        const obb::Limits& given = *nb::inst_ptr<obb::Limits>(limits);
        new (&cast(self)->options) obb::ContactQueryOptions{.duration = duration,
                                                            .time_tolerance = tolerance,
                                                            .limits = given,
                                                            .any_contact = any_contact != 0};
    }
    return self;
}

int visit_call(PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    for (const CallField field : kHeld) {
        Py_VISIT(cast(self)->*field);
    }
    return 0;
}

int clear_call(PyObject* self) {
    for (const CallField field : kHeld) {
        Py_CLEAR(cast(self)->*field);
    }
    return 0;
}

void delete_call(PyObject* self) {
    PyObject_GC_UnTrack(self);
    if (cast(self)->weak_references != nullptr) {
        PyObject_ClearWeakRefs(self);
    }
    (void)clear_call(self);
    free_object(self);
}

// As a function, it is bound where it is an attribute of a class.
PyObject* bind_call(PyObject* self, PyObject* object, PyObject*) {
    if (object == nullptr || object == Py_None) {
        Py_INCREF(self);
        return self;
    }
    const nb::object method = nb::module_::import_("types").attr("MethodType");
    return PyObject_CallFunctionObjArgs(method.ptr(), self, object, nullptr);
}

PyObject* shown(PyObject* self) { return PyObject_Repr(cast(self)->function); }

// Pickled and copied as functions are: by name.
PyObject* name_of(PyObject* self, PyObject*) {
    return PyObject_GetAttrString(self, "__qualname__");
}

PyMemberDef call_members[] = {
    {"__vectorcalloffset__", Py_T_PYSSIZET, offsetof(CallObject, call), Py_READONLY, nullptr},
    {"__dictoffset__", Py_T_PYSSIZET, offsetof(CallObject, dict), Py_READONLY, nullptr},
    {"__weaklistoffset__", Py_T_PYSSIZET, offsetof(CallObject, weak_references), Py_READONLY,
     nullptr},
    {}};
PyGetSetDef call_properties[] = {
    {"__dict__", &PyObject_GenericGetDict, &PyObject_GenericSetDict, nullptr, nullptr}, {}};
PyMethodDef call_methods[] = {{"__reduce__", &name_of, METH_NOARGS, nullptr}, {}};
PyType_Slot call_slots[] = {{Py_tp_new, reinterpret_cast<void*>(&new_call)},
                            {Py_tp_call, reinterpret_cast<void*>(&PyVectorcall_Call)},
                            {Py_tp_descr_get, reinterpret_cast<void*>(&bind_call)},
                            {Py_tp_repr, reinterpret_cast<void*>(&shown)},
                            {Py_tp_dealloc, reinterpret_cast<void*>(&delete_call)},
                            {Py_tp_traverse, reinterpret_cast<void*>(&visit_call)},
                            {Py_tp_clear, reinterpret_cast<void*>(&clear_call)},
                            {Py_tp_members, call_members},
                            {Py_tp_getset, call_properties},
                            {Py_tp_methods, call_methods},
                            {0, nullptr}};
PyType_Spec call_spec{"obbcli.kernels._core.QuickCall", sizeof(CallObject), 0,
                      Py_TPFLAGS_DEFAULT | Py_TPFLAGS_HAVE_GC | Py_TPFLAGS_HAVE_VECTORCALL,
                      call_slots};

} // namespace

void bind_quick_call(nb::module_& m) {
    at_rest_name = PyUnicode_InternFromString("at_rest");
    (void)add_type(m, "QuickCall", call_spec);
}
