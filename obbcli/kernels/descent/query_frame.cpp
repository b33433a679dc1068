#include "descent/query_frame.hpp"

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace obb {

namespace {

// Products of the tiniest coordinates vanish; so does what is 2^-900 of the scene.
constexpr double kTiny = 0x1p-900;

// Coordinates of a posed mesh stay below three times its largest coordinate plus the translation.
void require_range(const PosedTree& body) {
    if (!body.is_posed()) {
        return;
    }
    const double largest = norm_inf(body.pose().translation);
    if (std::max(body.tree().scale_exponent, exponent_of(largest)) > 1020) {
        throw std::domain_error("posed coordinates would exceed the range of double (about 1e307)");
    }
}

// |Q v| >= (1 - 2 skew) |v| for a skew of at most 1e-9, and the boxes' own axes, projected on and
// summed over, are longer than 1 by at most 2^-46.
double shrink_of(double skew) { return 1 - 0x1p-44 - 8 * skew; }

// What takes B's scaled coordinates to A's own. Of an A that stands as loaded that is B's pose; the
// general way would give the same numbers.
struct Between {
    Mat3 matrix;
    Vec3 offset;
};
Between between(const PosedTree& a, const PosedTree& b, int exponent) {
    const Vec3 place_b = scaled(b.pose().translation, -exponent);
    if (!a.is_posed()) {
        return {b.pose().rotation, place_b};
    }
    const Mat3 to_a = inverse(a.pose().rotation);
    return {to_a * b.pose().rotation, to_a * (place_b - scaled(a.pose().translation, -exponent))};
}

} // namespace

// Overlap survives any affine map, so poses need not be exactly orthonormal: what they lack goes
// into the bound. A translation of zero has no length to count: exponent_of() would take it for 1,
// and small meshes would sink into the absolute bound.
QueryFrame set_common_frame(PosedTree& a, PosedTree& b) {
    require_range(a);
    require_range(b);
    const Pose& pa = a.pose();
    const Pose& pb = b.pose();
    int exponent = std::max(a.tree().scale_exponent, b.tree().scale_exponent);
    for (const Pose* pose : {&pa, &pb}) {
        if (const double shift = norm_inf(pose->translation); shift > 0) {
            exponent = std::max(exponent, exponent_of(shift));
        }
    }
    const double skew_a = a.is_posed() ? skew_of(pa.rotation) : 0.0;
    a.set_frame(Mat3::identity(), {0, 0, 0}, exponent);
    if (pa == pb) {
        // A common pose moves no box against the other. It still rounds the triangles.
        b.set_frame(Mat3::identity(), {0, 0, 0}, exponent);
        const double rounding = !a.is_posed() ? 0.0 : 0x1p-46 * 8.0;
        return {exponent, {64 * kUnitRoundoff, rounding + kTiny}, shrink_of(skew_a)};
    }
    const auto [matrix, offset] = between(a, b, exponent);
    b.set_frame(matrix, offset, exponent);
    const double skew = skew_of(matrix);
    // No coordinate or translation exceeds 1 here: 2^-46 is 128 units of roundoff, 8 the sum over
    // both bodies of |vertex|_1 + |translation|.
    return {
        exponent, {64 * kUnitRoundoff + 8 * skew, 0x1p-46 * 8.0 + kTiny}, shrink_of(skew_a + skew)};
}

} // namespace obb
