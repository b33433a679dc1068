// `Pose` across the border: from two arrays or triples of numbers in C++, else as its class says.
#include "bindings/objects.hpp"

#include <cmath>
#include <cstring>
#include <new>

namespace {

// As `ORTHONORMAL_TOLERANCE` in pose.py, which tells why.
constexpr double kOrthonormal = 1e-9;

std::array<PyObject*, 2> names{};
PyTypeObject* pose_type = nullptr;
PyTypeObject* array_type = nullptr; // numpy.ndarray, once a pose is made of arrays

PoseObject* cast(PyObject* self) { return reinterpret_cast<PoseObject*>(self); }

// The numbers of a C-contiguous array of doubles of the given shape, copied; false of other
// objects.
template <std::size_t kCount>
bool read_array(PyObject* object, std::initializer_list<Py_ssize_t> shape,
                std::array<double, kCount>& numbers) {
    Py_buffer view;
    if (PyObject_GetBuffer(object, &view, PyBUF_FORMAT | PyBUF_C_CONTIGUOUS) != 0) {
        PyErr_Clear();
        return false;
    }
    const bool fits = std::strcmp(view.format, "d") == 0 &&
                      view.ndim == static_cast<int>(shape.size()) &&
                      std::equal(shape.begin(), shape.end(), view.shape);
    if (fits) {
        std::memcpy(numbers.data(), view.buf, sizeof numbers);
    }
    PyBuffer_Release(&view);
    return fits;
}

// Of an array, a list or a tuple of Python's own numbers. False of others, which Python looks at.
bool read_vector(PyObject* object, obb::Vec3& vector) {
    std::array<double, 3> numbers;
    if (Py_TYPE(object) == array_type) {
        if (!read_array(object, {3}, numbers)) {
            return false;
        }
    } else if (PyList_CheckExact(object) || PyTuple_CheckExact(object)) {
        if (PySequence_Size(object) != 3) {
            return false;
        }
        for (Py_ssize_t k = 0; k < 3; ++k) {
            PyObject* item =
                PyList_CheckExact(object) ? PyList_GetItem(object, k) : PyTuple_GetItem(object, k);
            if (!PyFloat_CheckExact(item) && !PyLong_CheckExact(item)) {
                return false;
            }
            const double number = PyFloat_AsDouble(item);
            if (number == -1.0 && PyErr_Occurred() != nullptr) {
                PyErr_Clear(); // too large for a double
                return false;
            }
            numbers[static_cast<std::size_t>(k)] = number;
        }
    } else {
        return false;
    }
    vector = {numbers[0], numbers[1], numbers[2]};
    return obb::is_finite(vector);
}

// Decides as `_as_rotation` in pose.py does, operation by operation.
bool is_rotation(const obb::Mat3& matrix) {
    const auto& [x, y, z] = matrix.rows;
    for (const double defect :
         {dot(x, x) - 1.0, dot(y, y) - 1.0, dot(z, z) - 1.0, dot(x, y), dot(y, z), dot(z, x)}) {
        if (!(std::fabs(defect) <= kOrthonormal)) { // NaN is none
            return false;
        }
    }
    return !(dot(cross(x, y), z) < 0);
}

bool read_rotation(PyObject* object, obb::Mat3& matrix) {
    std::array<double, 9> n;
    if (Py_TYPE(object) != array_type || !read_array(object, {3, 3}, n)) {
        return false;
    }
    matrix = {{obb::Vec3{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}}};
    return is_rotation(matrix);
}

// NumPy is imported by the time poses are made, but not when this module is.
void find_array_type() {
    if (array_type == nullptr) {
        const nb::object found = nb::module_::import_("numpy").attr("ndarray");
        array_type = reinterpret_cast<PyTypeObject*>(nb::object(found).release().ptr());
    }
}

bool is_given(const PyObject* object) { return object != nullptr && object != Py_None; }

void set_pose(PyObject* self, const obb::Pose& pose) {
    cast(self)->pose = pose;
    hold(cast(self)->rotation, nullptr);
    hold(cast(self)->translation, nullptr);
}

PyObject* new_pose(PyTypeObject* type, PyObject*, PyObject*) {
    PyObject* self = PyType_GenericAlloc(type, 0); // which clears it
    if (self != nullptr) {
        new (&cast(self)->pose) obb::Pose;
    }
    return self;
}

int init_pose(PyObject* self, PyObject* args, PyObject* kwargs) try {
    find_array_type();
    std::array<PyObject*, 2> given{};
    obb::Pose pose;
    if (take_arguments(args, kwargs, names, given) &&
        (!is_given(given[0]) || read_rotation(given[0], pose.rotation)) &&
        (!is_given(given[1]) || read_vector(given[1], pose.translation))) {
        set_pose(self, pose);
        return 0;
    }
    return nb::steal(call_method(self, "_checked", args, kwargs)).is_valid() ? 0 : -1;
} catch (nb::python_error& error) {
    error.restore();
    return -1;
}

// Takes the numbers of two arrays that were checked already.
PyObject* hold_arrays(PyObject* self, PyObject* args) {
    PyObject *rotation = nullptr, *translation = nullptr;
    std::array<double, 9> n;
    std::array<double, 3> s;
    if (PyArg_ParseTuple(args, "OO", &rotation, &translation) == 0) {
        return nullptr;
    }
    if (!read_array(rotation, {3, 3}, n) || !read_array(translation, {3}, s)) {
        PyErr_SetString(PyExc_TypeError, "a pose takes arrays of doubles, (3, 3) and (3,)");
        return nullptr;
    }
    const obb::Mat3 matrix{{obb::Vec3{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}}};
    set_pose(self, {matrix, {s[0], s[1], s[2]}});
    Py_RETURN_NONE;
}

void delete_pose(PyObject* self) {
    set_pose(self, {});
    free_object(self);
}

template <typename Array>
PyObject* seen_once(PyObject*& kept, std::span<const double> numbers,
                    std::initializer_list<std::size_t> shape) try {
    if (kept == nullptr) {
        std::vector<double> copy(numbers.begin(), numbers.end());
        nb::object array = nb::cast(owned<Array>(std::move(copy), shape));
        if (kept == nullptr) { // else another thread was sooner
            kept = array.release().ptr();
        }
    }
    Py_INCREF(kept);
    return kept;
} catch (nb::python_error& error) {
    error.restore();
    return nullptr;
}

PyObject* rotation_of(PyObject* self, void*) {
    const auto& rows = cast(self)->pose.rotation.rows;
    return seen_once<Owned<double, 3, 3>>(cast(self)->rotation, {&rows[0].x, 9}, {3, 3});
}

PyObject* translation_of(PyObject* self, void*) {
    const obb::Vec3& translation = cast(self)->pose.translation;
    return seen_once<Owned<double, 3>>(cast(self)->translation, {&translation.x, 3}, {3});
}

PyObject* is_identity(PyObject* self, void*) {
    return PyBool_FromLong(cast(self)->pose.is_identity() ? 1 : 0);
}

PyGetSetDef pose_properties[] = {
    {"_rotation", &rotation_of, nullptr, "Q, float64 (3, 3), read-only.", nullptr},
    {"_translation", &translation_of, nullptr, "s, float64 (3,), read-only.", nullptr},
    {"is_identity", &is_identity, nullptr,
     "Whether the pose moves nothing; such a pose rounds nothing either.", nullptr},
    {}};
PyMethodDef pose_methods[] = {
    {"_hold", &hold_arrays, METH_VARARGS, "_hold($self, rotation, translation, /)\n--\n\n"}, {}};
PyType_Slot pose_slots[] = {
    {Py_tp_doc, const_cast<char*>("Pose(rotation=None, translation=None)\n--\n\n")},
    {Py_tp_new, reinterpret_cast<void*>(&new_pose)},
    {Py_tp_init, reinterpret_cast<void*>(&init_pose)},
    {Py_tp_dealloc, reinterpret_cast<void*>(&delete_pose)},
    {Py_tp_getset, pose_properties},
    {Py_tp_methods, pose_methods},
    {0, nullptr}};
PyType_Spec pose_spec{"obbcli.kernels._core.Pose", sizeof(PoseObject), 0,
                      Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE, pose_slots};

} // namespace

PoseObject* as_pose(PyObject* object) {
    return PyObject_TypeCheck(object, pose_type) != 0 ? cast(object) : nullptr;
}

void bind_pose(nb::module_& m) {
    names = {PyUnicode_InternFromString("rotation"), PyUnicode_InternFromString("translation")};
    pose_type = add_type(m, "Pose", pose_spec);
}
