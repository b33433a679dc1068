// What the bindings share: arrays across the border, and the trees that keep theirs alive.
#pragma once

#include "at_rest/root_tests.hpp"
#include "descent/limits.hpp"
#include "shapes/pose.hpp"
#include "tree/tree.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace nb = nanobind;

namespace obb {
class TreeBuilder;
}

template <typename T, nb::ssize_t kColumns>
using Rows =
    nb::ndarray<const T, nb::numpy, nb::shape<-1, kColumns>, nb::c_contig, nb::device::cpu>;
template <typename T>
using Column = nb::ndarray<const T, nb::numpy, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

// Reinterprets the rows of a contiguous array as records of the same size.
template <typename Record, typename T, nb::ssize_t kColumns>
inline std::span<const Record> records(const Rows<T, kColumns>& rows) {
    static_assert(sizeof(Record) == sizeof(T) * kColumns);
    if (rows.shape(0) == 0) {
        return {}; // the pointer of an empty array means nothing
    }
    if (reinterpret_cast<std::uintptr_t>(rows.data()) % alignof(Record) != 0) {
        throw std::invalid_argument("array is not aligned");
    }
    return {reinterpret_cast<const Record*>(rows.data()), rows.shape(0)};
}

template <typename Number, nb::ssize_t... kShape>
using Owned = nb::ndarray<nb::numpy, const Number, nb::shape<kShape...>>;

// Hands a vector over to NumPy without copying it.
template <typename Array, typename Record>
inline Array owned(std::vector<Record>&& records, std::initializer_list<std::size_t> shape) {
    auto* kept = new std::vector<Record>(std::move(records));
    const nb::capsule owner(kept,
                            [](void* p) noexcept { delete static_cast<std::vector<Record>*>(p); });
    return Array(kept->data(), shape, owner);
}

// What an object of the kernels owns, for NumPy to read: the array keeps the object alive.
template <typename Array, typename Record>
Array seen(std::span<const Record> records, std::initializer_list<std::size_t> shape,
           nb::handle owner) {
    return Array(records.data(), shape, owner);
}

// Counters as Python reads them, in the order of `Counts` in counts.py: one call for all, as
// reading them one by one would cost more than many a query.
using Counts =
    std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t>;

inline Counts counts_of(const obb::WalkCounts& c) {
    return {c.box_tests, c.triangle_tests, c.exact_triangle_tests, c.pops, c.image_tests};
}

// Arrays of a tree, kept alive, and the view on them that the kernels use.
struct Tree {
    Rows<double, 3> vertices;
    Rows<std::uint32_t, 3> corners;
    Column<std::uint32_t> triangle_ids;
    Rows<std::uint8_t, 64> nodes;
    obb::TreeView view;
    const obb::TreeBuilder* builder = nullptr; // of a tree that grows
    // How many boxes the whole tree has; where its builder leaves that open, at most.
    std::uint64_t possible_node_count = view.nodes.size();
    std::string unit{};     // of length; empty where none is stated
    bool has_parts = false; // with names, which answers tell

    [[nodiscard]] std::uint64_t node_count() const;
};

// A tree as the object that Python knows, for those who keep it alive.
using TreeObject = nb::typed<nb::object, Tree>;

// A tree where a pose puts it. It keeps the tree alive itself, as nanobind's keep_alive takes
// longer than many a query does.
struct Placed {
    nb::object owner;
    const Tree* tree = nullptr;
    obb::Pose pose = {};
    obb::RootBox root = {};
};

// Pops between two looks at clock and signals: a few milliseconds.
inline constexpr std::uint64_t kPopsASlice = 16'384;

// How much of a query takes less time than to let other threads run meanwhile. Nothing where trees
// grow: a node near the root takes long to make.
inline std::uint64_t brief_pops(const Tree& a, const Tree& b) {
    return a.view.on_demand == nullptr && b.view.on_demand == nullptr ? 32 : 0;
}

// Does a slice of at most so many pops of a query, and lets other threads run after the first few;
// true when its answer is complete.
template <typename Query>
inline bool advance(Query& query, std::uint64_t brief, std::uint64_t max_pops) {
    brief = std::min(brief, max_pops);
    if (query.advance(brief)) {
        return true;
    }
    const nb::gil_scoped_release release;
    return query.advance(max_pops - brief);
}

// Wall time since it was made.
class Stopwatch {
  public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Lets handlers of signals run every now and then, for work that goes on without the GIL: called
// between its slices. Throws what a handler raised.
class SignalWatch {
  public:
    void operator()() const {
        const auto now = std::chrono::steady_clock::now();
        if (now - last_ < std::chrono::milliseconds(50)) {
            return;
        }
        const nb::gil_scoped_acquire acquire;
        if (PyErr_CheckSignals() != 0) {
            throw nb::python_error();
        }
        last_ = now;
    }

  private:
    mutable std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void bind_answer(nb::module_& m);
void bind_clearance(nb::module_& m);
void bind_containment(nb::module_& m);
void bind_distance(nb::module_& m);
void bind_contact_query(nb::module_& m);
void bind_file_tree(nb::module_& m);
void bind_hull(nb::module_& m);
void bind_limits(nb::module_& m);
void bind_overlap_regions(nb::module_& m);
void bind_overlap_volume(nb::module_& m);
void bind_placed(nb::module_& m);
void bind_pose(nb::module_& m);
void bind_primitives(nb::module_& m);
void bind_protrusion(nb::module_& m);
void bind_quick_call(nb::module_& m);
void bind_solid_probe(nb::module_& m);
void bind_static_query(nb::module_& m);
void bind_steady_pairs(nb::module_& m);
void bind_swept_pairs(nb::module_& m);
void bind_sweep(nb::module_& m);
void bind_thickness(nb::module_& m);
void bind_tree(nb::module_& m);

// How Python's objects for `obb::Pose` and `Placed` are read: wherever functions are bound.
#include "bindings/objects.hpp"
