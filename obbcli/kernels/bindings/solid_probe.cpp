// What one posed surface answers about points, boxes and cells across the border: for the question
// which solid lies in which, and for tests, which hold the parts of overlap queries against
// definitions.
#include "bindings/module.hpp"

#include "overlap/escape_row.hpp"
#include "overlap/nearest_triangle.hpp"
#include "overlap/triangles_in_box.hpp"
#include "overlap/winding_number.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

using namespace nb::literals;

namespace {

using Triple = std::array<double, 3>;

[[nodiscard]] obb::Vec3 vec(const Triple& t) { return {t[0], t[1], t[2]}; }
[[nodiscard]] Triple triple(const obb::Vec3& v) { return {v.x, v.y, v.z}; }

// Coordinates and lengths are those of the frame but where the world's are named.
class SolidProbe {
  public:
    SolidProbe(const Tree& tree, const obb::Pose& pose)
        : surface_(tree.view, pose, obb::overlap_frame(tree.view, pose, tree.view, pose)) {}

    [[nodiscard]] std::pair<Triple, int> frame() const {
        return {triple(surface_.frame().origin), surface_.frame().exponent};
    }
    // low, high, triangle, foot
    [[nodiscard]] std::tuple<double, double, std::uint32_t, Triple>
    nearest(const Triple& point, double slack, double enough) const {
        const obb::PointDistance found =
            obb::NearestSearch(surface_).find(vec(point), slack, {}, enough);
        return {found.low, found.high, surface_.id(found.triangle), triple(found.foot)};
    }
    // The winding number around a point of the world, none on the surface.
    [[nodiscard]] std::optional<std::int64_t> winding(const Triple& world) const {
        const obb::Winding found = obb::WindingSearch(surface_).find(vec(world));
        return found.is_on_surface ? std::nullopt : std::optional{found.number};
    }
    [[nodiscard]] std::pair<bool, std::vector<std::uint32_t>>
    triangles_in_box(const std::array<Triple, 5>& box, double pad, std::size_t most) const {
        const obb::Obb asked{vec(box[0]), {vec(box[1]), vec(box[2]), vec(box[3])}, vec(box[4])};
        std::vector<obb::NodeRef> found;
        const bool is_all = obb::BoxSearch(surface_).find(asked, pad, most, found);
        std::vector<std::uint32_t> ids;
        for (const obb::NodeRef& ref : found) {
            ids.push_back(surface_.id(ref));
        }
        return {is_all, ids};
    }
    // up, height
    [[nodiscard]] std::optional<std::pair<Triple, double>>
    escape_row(const Rows<double, 3>& corners, const Triple& up, const Triple& side,
               const std::tuple<double, std::size_t, double>& effort) const {
        const auto [thin, most, useful] = effort;
        const auto row = obb::EscapeSearch(surface_).find(records<obb::Vec3>(corners), vec(up),
                                                          vec(side), {thin, most, useful});
        return row ? std::optional{std::pair{triple(row->up), row->height}} : std::nullopt;
    }

  private:
    obb::SolidSurface surface_;
};

} // namespace

void bind_solid_probe(nb::module_& m) {
    nb::class_<SolidProbe>(m, "SolidProbe")
        .def(nb::init<const Tree&, const obb::Pose&>(), "tree"_a, "pose"_a, nb::keep_alive<1, 2>())
        .def_prop_ro("frame", &SolidProbe::frame)
        .def("nearest", &SolidProbe::nearest, "point"_a, "slack"_a, "enough"_a)
        .def("winding", &SolidProbe::winding, "world"_a)
        .def("triangles_in_box", &SolidProbe::triangles_in_box, "box"_a, "pad"_a, "most"_a)
        .def("escape_row", &SolidProbe::escape_row, "corners"_a, "up"_a, "side"_a, "effort"_a);
}
