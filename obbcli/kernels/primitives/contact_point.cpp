#include "primitives/contact_point.hpp"

#include "primitives/overlap_point.hpp"
#include "shapes/convex_polygon.hpp"
#include "shapes/extremes.hpp"
#include "shapes/scaled_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace obb {
namespace {

// B's way relative to A until `time`, times 2^exponent; scaled so that nothing overflows early.
[[nodiscard]] Vec3 relative_way(const LinearMotion& motion, double time, int exponent) {
    const int speed = exponent_of(
        std::max(largest_coordinate(motion.velocity_a), largest_coordinate(motion.velocity_b)));
    int moment = 0;
    const double fraction = std::frexp(time, &moment);
    const Vec3 w = scaled(motion.velocity_b, -speed - 1) - scaled(motion.velocity_a, -speed - 1);
    return scaled(fraction * w, speed + 1 + moment + exponent);
}

[[nodiscard]] ConvexPolygon polygon_of(const Triangle& t, const Feature& feature) {
    ConvexPolygon polygon;
    for (std::size_t k = 0; k < 3; ++k) {
        if (((feature.points >> k) & 1u) != 0) {
            polygon.add(t[k]);
        }
    }
    return polygon;
}

[[nodiscard]] ConvexPolygon polygon_of(const Obb& box, const Feature& feature) {
    Vec3 base = box.center;
    std::array<Vec3, 3> free{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 arm = box.half_extents[i] * box.axes[i];
        if (feature.signs[i] != 0) {
            base = base + static_cast<double>(feature.signs[i]) * arm;
        } else if (box.half_extents[i] != 0) {
            free[count++] = arm;
        }
    }
    ConvexPolygon polygon;
    if (count == 0) {
        polygon.add(base);
    } else if (count == 1) {
        polygon.add(base - free[0]);
        polygon.add(base + free[0]);
    } else {
        polygon.add(base - free[0] - free[1]);
        polygon.add(base + free[0] - free[1]);
        polygon.add(base + free[0] + free[1]);
        polygon.add(base - free[0] + free[1]);
    }
    return polygon;
}

} // namespace

template <typename A, typename B>
Vec3 contact_point(const A& a, const B& b, const LinearMotion& motion, double time,
                   const Touch& touch) {
    // All coordinates below one, which the polygons count on.
    const int exponent = exponent_of(larger(largest_coordinate(a), largest_coordinate(b))) + 2;
    const Vec3 origin = scaled(origin_of(a), -exponent);
    const A at_a = placed(a, origin, Vec3{0, 0, 0}, -exponent);
    const B at_b = placed(b, origin, relative_way(motion, time, -exponent), -exponent);
    Vec3 point;
    if (touch.axis.kind != AxisKind::kNone) {
        point =
            middle_of_common(polygon_of(at_a, touch.feature_a), polygon_of(at_b, touch.feature_b));
    } else {
        point = overlap_point(at_a, at_b);
    }
    return scaled(origin + point, exponent) + time * motion.velocity_a;
}

template Vec3 contact_point(const Triangle&, const Triangle&, const LinearMotion&, double,
                            const Touch&);
template Vec3 contact_point(const Obb&, const Triangle&, const LinearMotion&, double, const Touch&);
template Vec3 contact_point(const Obb&, const Obb&, const LinearMotion&, double, const Touch&);

} // namespace obb
