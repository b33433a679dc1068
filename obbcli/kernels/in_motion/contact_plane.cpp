#include "in_motion/contact_plane.hpp"

#include "exact/exact_shape.hpp"
#include "exact/orientation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace obb {

namespace {

[[nodiscard]] const Vec3& first_of(const Triangle& t, const Feature& feature) {
    return t[static_cast<std::size_t>(std::countr_zero(feature.points))];
}

// Coordinates of a damaged file may be no numbers, and then no vertex is extreme.
[[nodiscard]] bool has_points(const Touch& touch) {
    return touch.feature_a.points != 0 && touch.feature_b.points != 0;
}

} // namespace

ContactPlane::ContactPlane(const Difference& u, const std::optional<Difference>& v, const Vec3& a,
                           const Vec3& b)
    : u_(u), v_(v), a_(a), b_(b) {
    const Vec3 ru = u.rounded();
    n_ = v ? cross(ru, v->rounded()) : ru;
    sizes_ = v ? norm_1(ru) * norm_1(v->rounded()) : norm_1(ru);
}

std::optional<ContactPlane> ContactPlane::of_axis(const Triangle& a, const Triangle& b,
                                                  const LinearMotion& motion, const Touch& touch) {
    if (!has_points(touch)) {
        return std::nullopt;
    }
    const auto edge = [](const Triangle& t, std::size_t k) {
        return Difference{t[k], t[(k + 1) % 3]};
    };
    const Vec3 &on_a = first_of(a, touch.feature_a), &on_b = first_of(b, touch.feature_b);
    const auto face = [&](const Triangle& t) {
        return facing({edge(t, 0), edge(t, 1), on_a, on_b}, motion);
    };
    switch (touch.axis.kind) {
    case AxisKind::kFaceA:
        return face(a);
    case AxisKind::kFaceB:
        return face(b);
    case AxisKind::kPlane: { // the normal of either, unless that is degenerate
        const std::optional<ContactPlane> plane = face(a);
        return plane ? plane : face(b);
    }
    case AxisKind::kEdgeEdge:
        return facing({edge(a, touch.axis.a), edge(b, touch.axis.b), on_a, on_b}, motion);
    default:
        return std::nullopt;
    }
}

std::optional<ContactPlane> ContactPlane::of_motion(const Triangle& a, const Triangle& b,
                                                    const LinearMotion& motion,
                                                    const Touch& touch) {
    if (touch.axis.kind == AxisKind::kNone || !has_points(touch) ||
        touch.feature_a.dimension != 0 || touch.feature_b.dimension != 0) {
        return std::nullopt;
    }
    const Difference velocity{motion.velocity_b, motion.velocity_a};
    return facing(
        {velocity, std::nullopt, first_of(a, touch.feature_a), first_of(b, touch.feature_b)},
        motion);
}

// Bodies that do not approach along the normal say nothing of when they touch.
std::optional<ContactPlane> ContactPlane::facing(ContactPlane plane, const LinearMotion& motion) {
    const int approach = plane.sign(motion.velocity_a, motion.velocity_b);
    if (approach == 0) {
        return std::nullopt;
    }
    plane.direction_ = -approach;
    return plane;
}

Vec3 ContactPlane::normal() const {
    const double length = norm(n_);
    if (!(length > 0) || !std::isfinite(length)) {
        return {0, 0, 0};
    }
    return (direction_ / length) * n_;
}

// Of the product of the normal, as it is directed, with to - from.
int ContactPlane::sign(const Vec3& from, const Vec3& to) const {
    const Vec3 w = to - from;
    const double error = triple_error(sizes_, norm_inf(w));
    const double value = dot(n_, w);
    if (std::fabs(value) > error) {
        return value > 0 ? direction_ : -direction_;
    }
    return w == Vec3{0, 0, 0} ? 0 : direction_ * exact_sign({from, to});
}

// Each difference in a unit of its own: signs of products do not depend on units.
int ContactPlane::exact_sign(const Difference& w) const {
    const auto digits_of_both = [](const Difference& d) {
        DigitRange digits = digits_of(d.from);
        digits.include(d.to);
        return digits;
    };
    const DigitRange u = digits_of_both(u_), v = v_ ? digits_of_both(*v_) : u,
                     x = digits_of_both(w);
    return with_width(std::max({u.bits(), v.bits(), x.bits()}), [&](auto width) {
        constexpr std::size_t kWidth = decltype(width)::value;
        const auto wide = [](const Difference& d, const DigitRange& digits) {
            return to_wide<kWidth>(d.to, digits.low) - to_wide<kWidth>(d.from, digits.low);
        };
        const auto wide_w = wide(w, x);
        return v_ ? dot(cross(wide(u_, u), wide(*v_, v)), wide_w).sign()
                  : dot(wide(u_, u), wide_w).sign();
    });
}

} // namespace obb
