// Pairs of many moving bodies across the border.
#include "bindings/module.hpp"

#include "scene/swept_pairs.hpp"

#include <nanobind/stl/tuple.h>

#include <tuple>

using namespace nb::literals;

namespace {

using Pairs = std::tuple<Owned<std::uint32_t, -1, 2>, Owned<double, -1>>;

// Corners and velocities are rows of (low, high, velocity); times of (start, end).
Pairs swept_pairs_of(const Column<std::uint32_t>& numbers, const Rows<double, 2>& times,
                     const Rows<double, 9>& boxes, const Column<std::uint32_t>& groups,
                     const Column<std::uint8_t>& is_static, const Column<std::uint8_t>& is_ignored,
                     std::size_t group_count, double reach) {
    const std::size_t count = numbers.shape(0);
    if (times.shape(0) != count || boxes.shape(0) != count) {
        throw std::invalid_argument("arrays differ in length");
    }
    std::vector<obb::SweptBox> swept(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double* b = boxes.data() + 9 * i;
        swept[i] = {times.data()[2 * i], times.data()[2 * i + 1], {b[0], b[1], b[2]},
                    {b[3], b[4], b[5]},  {b[6], b[7], b[8]},      numbers.data()[i]};
    }
    const obb::SweptBodies bodies{{groups.data(), groups.shape(0)},
                                  {is_static.data(), is_static.shape(0)},
                                  {is_ignored.data(), is_ignored.shape(0)},
                                  group_count};
    std::vector<std::uint32_t> pairs;
    std::vector<double> keys;
    {
        nb::gil_scoped_release release;
        for (const obb::NearPair& pair : obb::swept_pairs(swept, bodies, reach)) {
            pairs.insert(pairs.end(), {pair.a, pair.b});
            keys.push_back(pair.time);
        }
    }
    const std::size_t found = keys.size();
    return {owned<Owned<std::uint32_t, -1, 2>>(std::move(pairs), {found, 2}),
            owned<Owned<double, -1>>(std::move(keys), {found})};
}

} // namespace

void bind_swept_pairs(nb::module_& m) {
    m.def("swept_pairs", &swept_pairs_of, "bodies"_a, "times"_a, "boxes"_a, "groups"_a,
          "is_static"_a, "is_ignored"_a, "group_count"_a, "reach"_a);
}
