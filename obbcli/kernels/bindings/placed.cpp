// `Placed`, a tree where a pose puts it, and what `Body` derives from: the same with its motion.
#include "bindings/objects.hpp"

#include <new>

namespace {

PyTypeObject* placed_type = nullptr;
PyTypeObject* tree_type = nullptr;
// What a body has whose pose and motion are not given.
PyObject* as_loaded = nullptr;
PyObject* at_rest = nullptr;
PyObject *kernel_name = nullptr, *is_at_rest_name = nullptr;
std::array<PyObject*, 3> names{};

PlacedObject* cast(PyObject* self) { return reinterpret_cast<PlacedObject*>(self); }

PyObject* new_placed(PyTypeObject* type, PyObject*, PyObject*) {
    PyObject* self = PyType_GenericAlloc(type, 0); // which clears it
    if (self != nullptr) {
        new (&cast(self)->here) Placed{};
    }
    return self;
}

// Puts a tree where a pose is; no tree where there is none.
void place(PlacedObject& self, PyObject* tree, const obb::Pose& pose) {
    self.here =
        tree == nullptr ? Placed{} : Placed{nb::borrow(tree), nb::inst_ptr<Tree>(tree), pose};
    if (tree != nullptr) {
        self.here.root = obb::root_box(self.here.tree->view, pose);
    }
}

int init_placed(PyObject* self, PyObject* args, PyObject*) {
    PyObject *tree = nullptr, *pose = nullptr;
    if (PyArg_ParseTuple(args, "OO", &tree, &pose) == 0) {
        return -1;
    }
    const PoseObject* where = as_pose(pose);
    if (Py_TYPE(tree) != tree_type || where == nullptr) {
        PyErr_SetString(PyExc_TypeError, "a tree of the kernels and a pose make a placed tree");
        return -1;
    }
    place(*cast(self), tree, where->pose);
    cast(self)->rests = true;
    return 0;
}

// The kernels' tree of a shape; none where the shape has none yet.
nb::object tree_of(PyObject* shape) {
    nb::object tree = nb::steal(PyObject_GetAttr(shape, kernel_name));
    if (!tree.is_valid()) {
        if (PyErr_ExceptionMatches(PyExc_AttributeError) == 0) {
            throw nb::python_error();
        }
        PyErr_Clear();
        return {};
    }
    return Py_TYPE(tree.ptr()) == tree_type ? tree : nb::object();
}

bool is_at_rest(PyObject* motion) {
    if (motion == at_rest) {
        return true;
    }
    const nb::object said = nb::steal(PyObject_GetAttr(motion, is_at_rest_name));
    const int rests = said.is_valid() ? PyObject_IsTrue(said.ptr()) : -1;
    if (rests < 0) {
        throw nb::python_error();
    }
    return rests != 0;
}

void set_body(PlacedObject& self, PyObject* shape, PyObject* pose, PyObject* motion,
              const nb::object& tree) {
    const bool rests = is_at_rest(motion);
    hold(self.shape, shape);
    hold(self.pose, pose);
    hold(self.motion, motion);
    place(self, tree.ptr(), as_pose(pose)->pose);
    self.rests = rests;
    self.is_steady = Py_TYPE(motion) == Py_TYPE(at_rest);
}

// A tree at a pose, moving with constant velocities if at all. Other arguments are looked at by the
// class.
bool set_quickly(PlacedObject& self, PyObject* args, PyObject* kwargs) {
    std::array<PyObject*, 3> given{};
    if (!take_arguments(args, kwargs, names, given) || given[0] == nullptr) {
        return false;
    }
    PyObject* pose = given[1] == nullptr ? as_loaded : given[1];
    PyObject* motion = given[2] == nullptr ? at_rest : given[2];
    if (as_pose(pose) == nullptr || PyObject_TypeCheck(pose, Py_TYPE(as_loaded)) == 0 ||
        Py_TYPE(motion) != Py_TYPE(at_rest)) {
        return false;
    }
    const nb::object tree = tree_of(given[0]);
    if (!tree.is_valid()) {
        return false;
    }
    set_body(self, given[0], pose, motion, tree);
    return true;
}

int init_body(PyObject* self, PyObject* args, PyObject* kwargs) try {
    if (set_quickly(*cast(self), args, kwargs)) {
        return 0;
    }
    return nb::steal(call_method(self, "_checked", args, kwargs)).is_valid() ? 0 : -1;
} catch (nb::python_error& error) {
    error.restore();
    return -1;
}

// Takes over a shape, a pose and a motion that were checked already.
PyObject* hold_body(PyObject* self, PyObject* args) try {
    PyObject *shape = nullptr, *pose = nullptr, *motion = nullptr;
    if (PyArg_ParseTuple(args, "OOO", &shape, &pose, &motion) == 0) {
        return nullptr;
    }
    if (as_pose(pose) == nullptr) {
        PyErr_SetString(PyExc_TypeError, "a body takes a pose");
        return nullptr;
    }
    set_body(*cast(self), shape, pose, motion, tree_of(shape));
    Py_RETURN_NONE;
} catch (nb::python_error& error) {
    error.restore();
    return nullptr;
}

int visit_placed(PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    Py_VISIT(cast(self)->shape);
    Py_VISIT(cast(self)->pose);
    Py_VISIT(cast(self)->motion);
    Py_VISIT(cast(self)->here.owner.ptr());
    return 0;
}

int clear_placed(PyObject* self) {
    Py_CLEAR(cast(self)->shape);
    Py_CLEAR(cast(self)->pose);
    Py_CLEAR(cast(self)->motion);
    cast(self)->here = {};
    return 0;
}

void delete_placed(PyObject* self) {
    PyObject_GC_UnTrack(self);
    (void)clear_placed(self);
    cast(self)->here.~Placed();
    free_object(self);
}

PyObject* held(PyObject* object, const char* name) {
    if (object == nullptr) { // of what was made past its constructor
        PyErr_SetString(PyExc_AttributeError, name);
        return nullptr;
    }
    Py_INCREF(object);
    return object;
}

PyObject* shape_of(PyObject* self, void*) { return held(cast(self)->shape, "shape"); }
PyObject* pose_of(PyObject* self, void*) { return held(cast(self)->pose, "pose"); }
PyObject* motion_of(PyObject* self, void*) { return held(cast(self)->motion, "motion"); }

PyObject* self_or_none(PyObject* self, bool is_self) {
    PyObject* result = is_self ? self : Py_None;
    Py_INCREF(result);
    return result;
}

PyObject* placed_of(PyObject* self, void*) {
    return self_or_none(self, cast(self)->here.tree != nullptr);
}

PyObject* resting_of(PyObject* self, void*) {
    return self_or_none(self, cast(self)->here.tree != nullptr && cast(self)->rests);
}

PyType_Slot placed_slots[] = {{Py_tp_doc, const_cast<char*>("Placed(tree, pose)\n--\n\n")},
                              {Py_tp_new, reinterpret_cast<void*>(&new_placed)},
                              {Py_tp_init, reinterpret_cast<void*>(&init_placed)},
                              {Py_tp_dealloc, reinterpret_cast<void*>(&delete_placed)},
                              {Py_tp_traverse, reinterpret_cast<void*>(&visit_placed)},
                              {Py_tp_clear, reinterpret_cast<void*>(&clear_placed)},
                              {0, nullptr}};
PyType_Spec placed_spec{"obbcli.kernels._core.Placed", sizeof(PlacedObject), 0,
                        Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_HAVE_GC,
                        placed_slots};

PyGetSetDef body_properties[] = {
    {"_shape", &shape_of, nullptr, "What the body is made of.", nullptr},
    {"_pose", &pose_of, nullptr, "Where it is at t = 0.", nullptr},
    {"_motion", &motion_of, nullptr, "How it moves from there.", nullptr},
    {"placed", &placed_of, nullptr,
     "The tree at its pose as the kernels see it; None where the shape is no tree yet.", nullptr},
    {"at_rest", &resting_of, nullptr, "The same of a body that does not move; None of others.",
     nullptr},
    {}};
PyMethodDef body_methods[] = {
    {"_hold", &hold_body, METH_VARARGS, "_hold($self, shape, pose, motion, /)\n--\n\n"}, {}};
PyType_Slot body_slots[] = {
    {Py_tp_doc, const_cast<char*>("PlacedBody(shape, pose=..., motion=...)\n--\n\n")},
    {Py_tp_init, reinterpret_cast<void*>(&init_body)},
    {Py_tp_traverse, reinterpret_cast<void*>(&visit_placed)},
    {Py_tp_clear, reinterpret_cast<void*>(&clear_placed)},
    {Py_tp_getset, body_properties},
    {Py_tp_methods, body_methods},
    {0, nullptr}};
PyType_Spec body_spec{"obbcli.kernels._core.PlacedBody", sizeof(PlacedObject), 0,
                      Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_HAVE_GC, body_slots};

} // namespace

PlacedObject* as_placed(PyObject* object) {
    return PyObject_TypeCheck(object, placed_type) != 0 ? cast(object) : nullptr;
}

void bind_placed(nb::module_& m) {
    tree_type = reinterpret_cast<PyTypeObject*>(nb::type<Tree>().ptr());
    kernel_name = PyUnicode_InternFromString("kernel");
    is_at_rest_name = PyUnicode_InternFromString("is_at_rest");
    names = {PyUnicode_InternFromString("shape"), PyUnicode_InternFromString("pose"),
             PyUnicode_InternFromString("motion")};
    placed_type = add_type(m, "Placed", placed_spec);
    (void)add_type(m, "PlacedBody", body_spec, placed_type);
    // Bodies are not made before.
    m.def(
        "set_body_defaults",
        [](const nb::object& pose, const nb::object& motion) {
            as_loaded = nb::object(pose).release().ptr();
            at_rest = nb::object(motion).release().ptr();
        },
        nb::arg("pose"), nb::arg("motion"));
    m.def(
        "roots_are_apart",
        [](const Placed& a, const Placed& b) {
            return obb::compare_roots(a.root, b.root) == obb::RootVerdict::kApart;
        },
        nb::arg("a"), nb::arg("b"));
}
