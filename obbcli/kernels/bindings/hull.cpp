// The convex hull across the border, for those who look at it alone.
#include "bindings/module.hpp"

#include "fit/convex_hull.hpp"

#include <nanobind/stl/tuple.h>

#include <tuple>

using namespace nb::literals;

namespace {

using Hull = std::tuple<int, Owned<std::uint32_t, -1>, Owned<std::uint32_t, -1, 3>>;

Hull convex_hull_of(const Rows<double, 3>& points, std::size_t max_vertices) {
    const auto p = records<obb::Vec3>(points);
    obb::ConvexHull hull;
    {
        nb::gil_scoped_release release;
        hull = obb::convex_hull(p, max_vertices);
    }
    const std::size_t vertex_count = hull.vertices.size(), count = hull.triangles.size();
    return {hull.rank, owned<Owned<std::uint32_t, -1>>(std::move(hull.vertices), {vertex_count}),
            owned<Owned<std::uint32_t, -1, 3>>(std::move(hull.triangles), {count, 3})};
}

} // namespace

void bind_hull(nb::module_& m) {
    m.def("convex_hull", &convex_hull_of, "points"_a, "max_vertices"_a);
}
