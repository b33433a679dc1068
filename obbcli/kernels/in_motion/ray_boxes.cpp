#include "in_motion/ray_boxes.hpp"

#include "descent/eight_boxes.hpp"
#include "numbers/lane_moves.hpp"

#include <cmath>
#include <limits>

namespace obb {

namespace {

// RayFrame::kRelative is 256 u, with u = 2^-24 and |x| the length of x.
// - An axis of a box is computed from a quaternion of floats: entries within 20 u, the vector
//   within 35 u. Turned by a matrix that is rounded to floats (2 u), by three products a coordinate
//   (9 u), it is within 46 u.
// - c = A_i . B_j is within 46 + 46 + 3 = 95 u. The way D between centres is rounded once from
//   doubles: t = A_i . D is within (46 + 1 + 3) u = 50 u of |D|, and so is w = A_i . V of |V|.
// - Along faces: the distance is within 50 u |D|, the radius within 100 u of the extents.
// - Along A_i x B_j the distance is t c - t' c' with (t, t') no longer than D and (c, c') than 1:
//   within (50 sqrt 2 + 95 sqrt 2 + 4) u = 210 u of |D|, and the radii within 100 u of the extents.
// What is left of 256 u covers the sum of these sizes and the radius, which are computed in floats.
//
// Extents, speeds and products that underflow: of the query's unit, in which all is at most about
// 4. Speeds below 2^-126, whose inverse is no number, move nothing by as much.
constexpr double kUnderflow = 0x1p-110;
// Doubles rounded to floats, upwards.
constexpr double kUp = 1 + 0x1p-22;
// Of a quotient by way of an inverse: the inverse, the product and the difference that is divided
// are within u each, and this is 64 u. Quotients below the second may have lost digits.
constexpr float kLoss = 0x1p-18F, kLostTime = 0x1p-100F;

template <typename Real>
OBB_INLINE Lanes3<Real> of_a(const Lanes3<Real>& v) {
    return {of_a(v[0]), of_a(v[1]), of_a(v[2])};
}
template <typename Real>
OBB_INLINE Lanes3<Real> of_b(const Lanes3<Real>& v) {
    return {of_b(v[0]), of_b(v[1]), of_b(v[2])};
}

// From A's centres to B's at the times, by pairs.
template <std::size_t kBytes>
OBB_INLINE Lanes3<Floats<kBytes>> ways(const RayFrame& frame,
                                       const std::array<RayOpening, 2>& openings) {
    using Wide = Doubles<kBytes>;
    const auto centers = [&](std::size_t first) __attribute__((always_inline)) {
        const auto low = [&](std::size_t k) __attribute__((always_inline)) {
            return &openings[k / 2].nodes[first + k % 2]->center.x;
        };
        Lanes3<Wide> c;
        Wide above; // extents
        gather_pairs<kBytes>(low, c[0], c[1]);
        gather_pairs<kBytes>(
            [&](std::size_t k) __attribute__((always_inline)) { return low(k) + 2; }, c[2], above);
        return c;
    };
    const Lanes3<Wide> a = centers(0), b = centers(2);
    alignas(32) const std::array<double, 4> times{openings[0].time, openings[0].time,
                                                  openings[1].time, openings[1].time};
    const Wide time = Wide::at(times.data());
    Lanes3<Floats<kBytes>> result;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& row = frame.rows_b[i];
        const Wide center_a = Wide(frame.scale_a) * a[i];
        const Wide center_b = inner(Lanes3<Wide>{Wide(row[0]), Wide(row[1]), Wide(row[2])}, b) +
                              (Wide(row[3]) + time * Wide(frame.velocity[i]));
        result[i] = rounded_pairs<kBytes>(center_b - center_a, shuffled<1, 0>(center_b) - center_a);
    }
    return result;
}

// The latest entry and the earliest exit so far. Of a NaN, from the damaged box of an unverified
// tree, no comparison holds: it cuts nothing.
template <typename Real>
struct Stay {
    Real entry, exit;

    // Projections meet while |distance + t speed| <= radius.
    OBB_INLINE void cut(const Real& distance, const Real& speed, const Real& radius) {
        const Real pace = Real(1.0F) / speed;
        const Real one = (Real{} - distance - radius) * pace, other = (radius - distance) * pace;
        entry = upper(lower(one, other), entry);
        exit = lower(upper(one, other), exit);
    }
};

template <std::size_t kBytes>
OBB_INLINE void enter(const RayFrame& frame, const std::array<RayOpening, 2>& openings,
                      EightEntries& entries) {
    using Real = Floats<kBytes>;
    const auto node = [&](std::size_t k) __attribute__((always_inline)) -> const Node& {
        return *openings[k / 4].nodes[k % 4];
    };
    const Boxes<Real> boxes = placed_eight<kBytes>(frame, node);
    const Lanes3<Real> d = ways<kBytes>(frame, openings);
    const Lanes3<Real>& h = boxes.half_extents;
    const float first = static_cast<float>(openings[0].span * kUp),
                second = static_cast<float>(openings[1].span * kUp);
    alignas(32) const std::array<float, 8> spans{first,  first,  first,  first,
                                                 second, second, second, second};
    const Real span = Real::at(spans.data());
    const Real size = h[0] + h[1] + h[2];
    const Real way = magnitude(d[0]) + magnitude(d[1]) + magnitude(d[2]);
    const Real e =
        Real(frame.relative) * (way + of_a(size) + of_b(size) + span * Real(frame.speed)) +
        Real(frame.absolute);
    const Lanes3<Real> ha = of_a(h), hb = of_b(h);
    const Lanes3<Real> v{Real(static_cast<float>(frame.velocity.x)),
                         Real(static_cast<float>(frame.velocity.y)),
                         Real(static_cast<float>(frame.velocity.z))};
    std::array<Lanes3<Real>, 3> b;
    for (std::size_t j = 0; j < 3; ++j) {
        b[j] = of_b(boxes.axes[j]);
    }
    // c[i][j] = A_i . B_j, t[i] = A_i . D, w[i] = A_i . V; as in box_entries().
    Real c[3][3], r[3][3], t[3], w[3];
    Stay<Real> stay{Real{}, span};
    for (std::size_t i = 0; i < 3; ++i) {
        const Lanes3<Real> a = of_a(boxes.axes[i]);
        t[i] = inner(a, d);
        w[i] = inner(a, v);
        for (std::size_t j = 0; j < 3; ++j) {
            c[i][j] = inner(a, b[j]);
            r[i][j] = magnitude(c[i][j]);
        }
        stay.cut(t[i], w[i], ha[i] + inner(hb, Lanes3<Real>{r[i][0], r[i][1], r[i][2]}) + e);
    }
    for (std::size_t j = 0; j < 3; ++j) {
        stay.cut(inner(b[j], d), inner(b[j], v),
                 hb[j] + inner(ha, Lanes3<Real>{r[0][j], r[1][j], r[2][j]}) + e);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            const Real radius_a = ha[i1] * r[i2][j] + ha[i2] * r[i1][j];
            const Real radius_b = hb[j1] * r[i][j2] + hb[j2] * r[i][j1];
            stay.cut(t[i2] * c[i1][j] - t[i1] * c[i2][j], w[i2] * c[i1][j] - w[i1] * c[i2][j],
                     radius_a + radius_b + e);
        }
    }
    (stay.entry * Real(1 - kLoss) - Real(kLostTime)).store(entries.entry.data());
    (stay.exit * Real(1 + kLoss) + Real(kLostTime)).store(entries.exit.data());
}

} // namespace

// An affine map changes no time of contact: what poses lack of rotations goes into the bound of
// projections, as in set_common_frame().
RayFrame::RayFrame(const MovingPair& pair) {
    const MovingTree &a = pair.a(), &b = pair.b();
    const Mat3 to_a = inverse(a.rotation()), turned = to_a * b.rotation();
    const MovingFrame now = pair.box_frame(0);
    const Vec3 between = to_a * (b.offset() - a.offset() + now.between);
    velocity = to_a * now.closing_velocity;
    scale_a = a.node_scale();
    speed = static_cast<float>(norm_1(velocity) * kUp);
    relative = static_cast<float>((kRelative + 8 * skew_of(turned)) * kUp);
    absolute = static_cast<float>((kUnderflow + 2 * now.absolute + 0x1p-44) * kUp);
    for (std::size_t lane = 0; lane < 8; ++lane) {
        const bool is_a = lane / 2 % 2 == 0;
        node_scale[lane] = static_cast<float>(is_a ? a.node_scale() : b.node_scale());
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                const double entry = is_a ? (i == k ? 1.0 : 0.0) : turned.rows[i][k];
                matrix[i][k][lane] = static_cast<float>(entry);
            }
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            rows_b[i][k] = b.node_scale() * turned.rows[i][k];
        }
        rows_b[i][3] = between[i];
    }
}

void enter_boxes(const RayFrame& frame, const std::array<RayOpening, 2>& openings,
                 EightEntries& entries) {
    in_registers([&]<std::size_t kBytes>() { enter<kBytes>(frame, openings, entries); });
}

} // namespace obb
