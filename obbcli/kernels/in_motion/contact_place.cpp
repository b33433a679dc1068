#include "in_motion/contact_place.hpp"

#include "nearest/closest_points.hpp"
#include "primitives/contact_normals.hpp"
#include "primitives/pair_query.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

// Vertices this close to the farthest along the normal belong to the feature, relative to the
// triangle's size: what lies flat at the contact is tilted by so little at the time before it.
constexpr double kFlat = 0x1p-26;

// Dimension of the face of a triangle that is farthest along n: repeated corners count once.
int dimension_along(const Triangle& t, Vec3 n, double size) {
    double farthest = -std::numeric_limits<double>::infinity();
    for (const Vec3& p : t) {
        farthest = std::max(farthest, dot(n, p));
    }
    int corners = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const bool is_new = k == 0 || (t[k] != t[0] && (k == 1 || t[k] != t[1]));
        corners += is_new && dot(n, t[k]) >= farthest - kFlat * size ? 1 : 0;
    }
    return corners - 1;
}

// The point of a box that is nearest to p.
Vec3 nearest_in(const Obb& box, Vec3 p) {
    Vec3 result = box.center;
    for (std::size_t k = 0; k < 3; ++k) {
        const double y = dot(box.axes[k], p - box.center);
        result = result + std::clamp(y, -box.half_extents[k], box.half_extents[k]) * box.axes[k];
    }
    return result;
}

// The exact question about the pair knows its features as well.
ContactPlace place_in_translation(const MovingPair& pair, const Contact& contact) {
    const std::optional<PairContact> found =
        first_contact(pair.a().posed_triangle(contact.a), pair.b().posed_triangle(contact.b),
                      pair.linear_motion());
    return {found->point,
            found->point,
            found->touch.normal,
            found->normal_a,
            found->normal_b,
            feature_code(found->touch.feature_a.dimension, found->touch.feature_b.dimension)};
}

ContactPlace place_of_triangles(MovingPair& pair, const Contact& contact) {
    const double time = pair.scaled_time(contact.low);
    const PlacedTriangles placed = pair.triangles_at({contact.a, contact.b}, time);
    const SpinningTriangle &a = placed.a, &b = placed.b;
    const Triangle& moved = placed.moved_b;
    const MovingFrame now = pair.frame(0, time);
    const TriangleDistance closest = measure(a.points, moved);
    const bool is_apart = closest.low > 0;
    Vec3 point_a = closest.point_a, point_b = closest.point_b;
    const std::optional<PairContact> meeting =
        is_apart ? std::nullopt : first_contact(a.points, moved, LinearMotion{});
    if (!is_apart) {
        point_a = meeting ? meeting->point : point_a;
        point_b = meeting ? meeting->point : point_b;
    }
    const TriangleStep step =
        triangle_step(a, b, now, is_apart ? point_b - point_a : Vec3{0, 0, 0});
    const Vec3 towards_b = -1.0 * now.closing_velocity;
    const Vec3 last_resort = meeting && meeting->touch.axis.kind != AxisKind::kNone
                                 ? meeting->touch.normal
                                 : unit_or(point_b - point_a, unit_or(towards_b, Vec3{1, 0, 0}));
    const Vec3 normal = step.time > 0 ? step.normal : last_resort;
    const double size = a.size + b.size;
    return {pair.in_world(point_a, contact.low),
            pair.in_world(point_b, contact.low),
            normal,
            face_normal(a.points, Feature{}, normal),
            face_normal(moved, Feature{}, -normal),
            feature_code(dimension_along(a.points, normal, size),
                         dimension_along(moved, -normal, size))};
}

ContactPlace place_of_boxes(MovingPair& pair, const Contact& contact) {
    const double time = pair.scaled_time(contact.low);
    pair.set_time(time);
    const Obb a = pair.a().box(contact.a);
    Obb b = pair.b().box(contact.b);
    b.center = b.center + pair.frame(0, time).between;
    const Vec3 point_a = nearest_in(a, b.center);
    const Vec3 point_b = nearest_in(b, point_a);
    const Vec3 normal = unit_or(b.center - a.center, Vec3{1, 0, 0});
    return {pair.in_world(point_a, contact.low), pair.in_world(point_b, contact.low), normal,
            smooth_normal(a, point_a, normal),   smooth_normal(b, point_b, -normal),  kBoxFeature};
}

} // namespace

ContactPlace place_of(MovingPair& pair, const Contact& contact) {
    const bool is_exact = pair.is_translation() && pair.clearance() == 0;
    ContactPlace place = contact.evidence == Evidence::kBoxes ? place_of_boxes(pair, contact)
                         : is_exact                           ? place_in_translation(pair, contact)
                                                              : place_of_triangles(pair, contact);
    place.point = 0.5 * place.point_a + 0.5 * place.point_b;
    for (Vec3* v : {&place.point, &place.point_a, &place.point_b, &place.normal, &place.normal_a,
                    &place.normal_b}) {
        *v = *v + Vec3{0, 0, 0}; // no negative zeros
    }
    return place;
}

} // namespace obb
