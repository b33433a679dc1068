#include "shapes/screw.hpp"

#include "numbers/scale.hpp"

#include <cmath>
#include <limits>

namespace obb {

Spin::Spin(Vec3 velocity) : velocity_(velocity) {
    if (!std::isfinite(norm_inf(velocity))) { // in a query's units; digits would be NaN, not many
        speed_ = {std::numeric_limits<double>::infinity(), 0};
        return;
    }
    const int exponent = exponent_of(norm_inf(velocity)); // or the squares of slow turns vanish
    const Vec3 w = scaled(velocity, -exponent);
    DoubleDouble square{0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        const DoubleDouble p = two_product(w[k], w[k]);
        const DoubleDouble s = two_sum(square.high, p.high);
        square = two_sum(s.high, s.low + square.low + p.low);
    }
    const double root = std::sqrt(square.high);
    if (root == 0) {
        return;
    }
    const DoubleDouble back = two_product(root, root);
    const double rest = ((square.high - back.high) - back.low + square.low) / (2 * root);
    speed_ = {std::ldexp(root, exponent), std::ldexp(rest, exponent)};
    axis_ = {w.x / root, w.y / root, w.z / root};
}

Turn Spin::turn(double time) const {
    if (is_still()) {
        return {};
    }
    const DoubleDouble angle = two_product(speed_.high, time);
    const double rest = angle.low + speed_.low * time;
    const double sine_high = std::sin(angle.high), cosine_high = std::cos(angle.high);
    return {sine_high + cosine_high * rest, cosine_high - sine_high * rest};
}

Mat3 Spin::matrix(const Turn& turn) const {
    const double cosine = turn.cosine, versine = 1 - cosine;
    const Vec3 k = axis_;
    const Vec3 s = turn.sine * k;
    const Vec3 v = versine * k;
    return {{Vec3{cosine + v.x * k.x, v.x * k.y - s.z, v.x * k.z + s.y},
             Vec3{v.x * k.y + s.z, cosine + v.y * k.y, v.y * k.z - s.x},
             Vec3{v.x * k.z - s.y, v.y * k.z + s.x, cosine + v.z * k.z}}};
}

} // namespace obb
