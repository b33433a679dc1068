// Volumes that solids share, with others or with themselves, across the border.
#include "bindings/module.hpp"

#include "overlap/column_volume.hpp"
#include "overlap/self_overlap.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <optional>
#include <tuple>

using namespace nb::literals;

namespace {

using Triple = std::tuple<double, double, double>;
using Box = std::tuple<Triple, Triple>;

Triple triple(const obb::Vec3& p) { return {p.x, p.y, p.z}; }
obb::Vec3 vector(const Triple& p) { return {std::get<0>(p), std::get<1>(p), std::get<2>(p)}; }
std::tuple<double, double> pair(const obb::Bracket& b) { return {b.low, b.high}; }

std::optional<obb::Bounds> bounds(const std::optional<Box>& box) {
    if (!box) {
        return std::nullopt;
    }
    return obb::Bounds{vector(std::get<0>(*box)), vector(std::get<1>(*box))};
}

void bind_column_volume(nb::module_& m) {
    nb::class_<obb::ColumnVolume>(m, "ColumnVolume")
        .def(
            "__init__",
            [](obb::ColumnVolume* self, const Tree& a, const obb::Pose& pose_a, const Tree& b,
               const obb::Pose& pose_b) {
                const nb::gil_scoped_release release; // looks for the extents of both
                new (self) obb::ColumnVolume(a.view, pose_a, b.view, pose_b);
            },
            "tree_a"_a, "pose_a"_a, "tree_b"_a, "pose_b"_a, nb::keep_alive<1, 2>(),
            nb::keep_alive<1, 4>())
        .def("advance", &obb::ColumnVolume::advance, "max_pops"_a,
             nb::call_guard<nb::gil_scoped_release>())
        .def_prop_ro("bounds", [](const obb::ColumnVolume& q) { return pair(q.bounds()); })
        .def_prop_ro("integral", [](const obb::ColumnVolume& q) { return pair(q.integral()); })
        .def_prop_ro("centroid",
                     [](const obb::ColumnVolume& q) -> std::optional<Triple> {
                         const auto found = q.centroid();
                         return found ? std::optional(triple(found->point)) : std::nullopt;
                     })
        .def_prop_ro("error",
                     [](const obb::ColumnVolume& q) -> std::optional<double> {
                         const auto found = q.centroid();
                         return found ? std::optional(found->error) : std::nullopt;
                     })
        .def_prop_ro("window",
                     [](const obb::ColumnVolume& q) {
                         const obb::Bounds w = q.window();
                         return Box{triple(w.low), triple(w.high)};
                     })
        .def("counts", [](const obb::ColumnVolume& q) { return counts_of(q.counts()); });
}

} // namespace

void bind_overlap_volume(nb::module_& m) {
    bind_column_volume(m);
    nb::class_<obb::SelfOverlap>(m, "SelfOverlap")
        .def(
            "__init__",
            [](obb::SelfOverlap* self, const Tree& tree, const obb::Pose& pose,
               const std::optional<Box>& within) {
                const nb::gil_scoped_release release;
                new (self) obb::SelfOverlap(tree.view, pose, bounds(within));
            },
            "tree"_a, "pose"_a, "within"_a = nb::none(), nb::keep_alive<1, 2>())
        .def("advance", &obb::SelfOverlap::advance, "max_pops"_a,
             nb::call_guard<nb::gil_scoped_release>())
        .def_prop_ro("volume", [](const obb::SelfOverlap& q) { return pair(q.volume()); })
        .def_prop_ro("excess", [](const obb::SelfOverlap& q) { return pair(q.excess()); })
        .def("counts", [](const obb::SelfOverlap& q) { return counts_of(q.counts()); });
}
