// The parts of what two solids share across the border.
#include "bindings/module.hpp"

#include "overlap/overlap_regions.hpp"

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <vector>

using namespace nb::literals;

namespace {

using Query = obb::OverlapRegions;
using Triple = std::tuple<double, double, double>;
// low, high, point, thickness: low and high, triangle_a, triangle_b
using Region =
    std::tuple<Triple, Triple, Triple, std::tuple<double, double>, std::uint32_t, std::uint32_t>;

void init_query(Query* self, const Tree& a, const obb::Pose& pose_a, const Tree& b,
                const obb::Pose& pose_b, double resolution, double tolerance, double floor,
                std::uint64_t max_cells) {
    if (!(resolution > 0) || !std::isfinite(resolution)) {
        throw std::invalid_argument("a resolution is a positive number");
    }
    const nb::gil_scoped_release release; // trees may grow
    new (self) Query(
        a.view, pose_a, b.view, pose_b,
        {.resolution = resolution, .tolerance = tolerance, .floor = floor, .max_cells = max_cells});
}

Triple triple(const obb::Vec3& p) { return {p.x, p.y, p.z}; }

std::vector<Region> regions(const Query& query) {
    std::vector<Region> found;
    for (const obb::OverlapRegion& r : query.regions()) {
        found.emplace_back(triple(r.low), triple(r.high), triple(r.deepest.world),
                           std::tuple{r.thin, r.thick}, r.deepest.triangle_a, r.deepest.triangle_b);
    }
    return found;
}

} // namespace

void bind_overlap_regions(nb::module_& m) {
    nb::class_<Query>(m, "OverlapRegions")
        .def("__init__", &init_query, "tree_a"_a, "pose_a"_a, "tree_b"_a, "pose_b"_a, nb::kw_only(),
             "resolution"_a, "tolerance"_a = 0.01, "floor"_a = 0.0, "max_cells"_a = 200'000,
             nb::keep_alive<1, 2>(), nb::keep_alive<1, 4>())
        .def("advance", &Query::advance, "max_cells"_a, nb::call_guard<nb::gil_scoped_release>())
        .def_prop_ro("regions", &regions)
        .def_prop_ro("unproven", &Query::unproven)
        .def_prop_ro("is_complete", &Query::is_complete)
        .def_prop_ro("cells", &Query::cells);
}
