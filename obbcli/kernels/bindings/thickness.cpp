// How thick the overlap of two solids is, across the border.
#include "bindings/module.hpp"

#include "overlap/matrix_game.hpp"
#include "overlap/thickness_query.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <tuple>
#include <utility>

using namespace nb::literals;

namespace {

using Query = obb::ThicknessQuery;

void init_query(Query* self, const Tree& a, const obb::Pose& pose_a, const Tree& b,
                const obb::Pose& pose_b, double tolerance, std::optional<double> deeper_than,
                double floor, std::uint64_t max_cells) {
    const nb::gil_scoped_release release; // trees may grow
    new (self) Query(a.view, pose_a, b.view, pose_b,
                     {.tolerance = tolerance,
                      .deeper_than = deeper_than,
                      .floor = floor,
                      .max_cells = max_cells});
}

using Point = std::tuple<double, double, double>;

std::optional<Point> point_of(const Query& query) {
    const obb::DeepPoint& deepest = query.deepest();
    if (!(deepest.radius > 0)) {
        return std::nullopt;
    }
    return Point{deepest.world.x, deepest.world.y, deepest.world.z};
}

template <std::uint32_t obb::DeepPoint::* kTriangle>
std::optional<std::uint32_t> triangle_of(const Query& query) {
    const obb::DeepPoint& deepest = query.deepest();
    return deepest.radius > 0 ? std::optional(deepest.*kTriangle) : std::nullopt;
}

// Bound, weights of rows and demands, weights of the corners.
using Solved = std::tuple<double, std::vector<double>, std::vector<double>>;

Solved solve_matrix_game(const Rows<double, 8>& rows, const Rows<double, 8>& demands) {
    obb::MatrixGame game;
    game.clear();
    const auto of_rows = records<obb::MatrixGame::Values>(rows);
    const auto of_demands = records<obb::MatrixGame::Values>(demands);
    const std::size_t count = of_rows.size() + of_demands.size();
    if (of_rows.empty() || count > obb::MatrixGame::kMost) {
        throw std::invalid_argument("a game has 1 to 32 rows and demands");
    }
    for (const auto& values : of_rows) {
        game.add_row(values);
    }
    for (const auto& values : of_demands) {
        game.add_demand(values);
    }
    game.solve();
    Solved solved{game.bound(), {}, {}};
    for (std::size_t k = 0; k < count; ++k) {
        std::get<1>(solved).push_back(game.weight(k));
    }
    const auto& corners = game.corner_weights();
    std::get<2>(solved).assign(corners.begin(), corners.end());
    return solved;
}

} // namespace

void bind_thickness(nb::module_& m) {
    m.def("solve_matrix_game", &solve_matrix_game, "rows"_a, "demands"_a);
    nb::class_<Query>(m, "ThicknessQuery")
        .def("__init__", &init_query, "tree_a"_a, "pose_a"_a, "tree_b"_a, "pose_b"_a, nb::kw_only(),
             "tolerance"_a, "deeper_than"_a.none() = nb::none(), "floor"_a, "max_cells"_a,
             nb::keep_alive<1, 2>(), nb::keep_alive<1, 4>())
        .def("advance", &Query::advance, "max_cells"_a, nb::call_guard<nb::gil_scoped_release>())
        .def_prop_ro("bounds", [](const Query& q) { return std::pair{q.low(), q.high()}; })
        .def_prop_ro("point", &point_of)
        .def_prop_ro("triangle_a", &triangle_of<&obb::DeepPoint::triangle_a>)
        .def_prop_ro("triangle_b", &triangle_of<&obb::DeepPoint::triangle_b>)
        .def_prop_ro("deeper", &Query::is_deeper)
        .def_prop_ro("is_answered", &Query::is_answered)
        .def_prop_ro("cells", &Query::cells)
        .def_prop_ro("points", &Query::points)
        .def_prop_ro("rays", &Query::rays);
}
