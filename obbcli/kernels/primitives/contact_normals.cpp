#include "primitives/contact_normals.hpp"

#include "shapes/extremes.hpp"
#include "shapes/scaled_shapes.hpp"

#include <algorithm>
#include <cstddef>

namespace obb {

Vec3 face_normal(const Triangle& triangle, const Feature&, const Vec3& towards) {
    const int exponent = -exponent_of(largest_coordinate(triangle)) - 1;
    const Vec3 origin = scaled(triangle[0], exponent);
    const Vec3 normal = unit_normal(placed(triangle, origin, Vec3{0, 0, 0}, exponent), towards);
    return dot(normal, towards) < 0 ? -normal : normal;
}

Vec3 face_normal(const Obb& box, const Feature& feature, const Vec3& towards) {
    Vec3 best = towards;
    double most = -2;
    if (feature.dimension == 3) {
        return best;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 axis = unit_by_powers(box.axes[i], towards);
        for (const int side : {-1, 1}) {
            const Vec3 normal = static_cast<double>(side) * axis;
            const bool lies_in =
                feature.dimension == 3 || feature.signs[i] == side || box.half_extents[i] == 0;
            if (lies_in && dot(normal, towards) > most) {
                most = dot(normal, towards);
                best = normal;
            }
        }
    }
    return best;
}

Vec3 smooth_normal(const Triangle&, const Vec3&, const Vec3& normal) { return normal; }

Vec3 smooth_normal(const Obb& box, const Vec3& point, const Vec3& normal) {
    const Vec3 h = box.half_extents;
    // The gradient sum (x_i / a_i^2) A_i times the smallest extent: a flat box tends to its face.
    const double least = std::min({h.x, h.y, h.z});
    if (!(least > 0)) {
        return normal;
    }
    const Vec3 d = point - box.center;
    Vec3 gradient{0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        const double along = dot(box.axes[i], d) / h[i];
        gradient = gradient + (along * (least / h[i])) * box.axes[i];
    }
    return unit_by_powers(gradient, normal);
}

} // namespace obb
