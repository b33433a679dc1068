// What types of Python objects made here have in common.
#include "bindings/objects.hpp"

PyTypeObject* add_type(nb::module_& m, const char* name, PyType_Spec& spec, PyTypeObject* base) {
    const nb::object bases = base == nullptr ? nb::object() : nb::make_tuple(nb::handle(base));
    PyObject* made = PyType_FromSpecWithBases(&spec, bases.ptr());
    if (made == nullptr) {
        throw nb::python_error();
    }
    m.attr(name) = nb::handle(made);
    return reinterpret_cast<PyTypeObject*>(made); // never given back: types live as long as we do
}

PyObject* call_method(PyObject* self, const char* name, PyObject* args, PyObject* kwargs) {
    const nb::object method = nb::steal(PyObject_GetAttrString(self, name));
    return method.is_valid() ? PyObject_Call(method.ptr(), args, kwargs) : nullptr;
}

void free_object(PyObject* self) {
    PyTypeObject* type = Py_TYPE(self);
    reinterpret_cast<freefunc>(PyType_GetSlot(type, Py_tp_free))(self);
    Py_DECREF(type);
}
