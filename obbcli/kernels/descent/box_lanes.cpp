#include "descent/box_lanes.hpp"

#include "descent/eight_boxes.hpp"
#include "numbers/lane_moves.hpp"

#include <limits>

namespace obb {

namespace {

// What a distance less radius may be off by, on any of the fifteen axes, against that of the boxes
// that are_separated() means: with axes_of() and the frame in doubles as they are. Let u = 2^-24,
// half a unit in the last place of 1 in floats, and |d|, |a|, |b| be sums of coordinates, which no
// other norm exceeds: of the way between the centres and of the half extents of A and B.
// - Axes. The square of a quaternion's length is off by 3 u of itself, s by 4 u, a product s x y by
//   6 u. Products in an entry off the diagonal sum to 1 at most: 6 u + u. Those of one on it sum to
//   2 at most: 12 u + 2 u. A column of errors (14, 7, 7) u has the length 17.2 u; all three
//   together have the Frobenius norm 29.8 u. The entries of B's matrix round by u, its products by
//   3 u, of unit vectors: a placed axis of B is off by 17.2 u + (1 + 3) sqrt(3) u < 24.2 u. A's
//   matrix is 1.
// - The way D is placed and subtracted in doubles and then rounded, u |d|. t_i = A_i . D is off by
//   (17.2 + 1 + 3) u |d|; all three t, as a vector, by (29.8 + 4 sqrt(3)) u |d| < 36.8 u |d|.
// - c_ij = A_i . B_j is off by (17.2 + 24.2 + 3) u = 44.4 u; the three of one B_j, as a vector, by
//   (29.8 + 24.2 + 3 sqrt(3)) u < 59.2 u.
// - Faces of A: 21.2 u |d| of t_i, (44.4 + 3) u |b| of the radius, and two differences of 1 u each.
// - Faces of B: t . c_j is off by (36.8 + 59.2 + 3) u |d| = 99 u |d|, the radius by 47.4 u |a|, and
//   two differences by 1 u each: 101 u |d| + 50 u |a| + 2 u |b|. This is the worst.
// - Edges: two of the three products of t and c_j, (36.8 + 59.2 + 2) u |d|; radii of two products
//   each, (44.4 + 2) u (|a| + |b|); their sum and the difference 1 u each.
// The bound is 128 u of the sizes. The 27 u beyond 101 u cover products of errors, at most 128 u of
// them, the rounding of the bound itself, 10 u of it, and that vectors called unit are so up to
// 2^-26. The errors in doubles are added: RoundingBound holds for the boxes that are meant.
//
// Products that underflow lose 2^-150 each, and half extents may in their scaling. A hundred of
// them, times coordinates up to 2^10, stay below 2^-120.
//
// A NaN or an infinity separates nothing. In a centre or an extent it makes the bound NaN or
// infinite, which no gap exceeds. In a quaternion it makes every axis NaN, and so the first gap, in
// which both boxes have a part; upper() then keeps that, for no number is greater.
//
// The other way round, where every axis is below minus the bound, are_separated() proves nothing
// either: what it computes is off by less.
constexpr double kFloatBound = 0x1p-17;
constexpr double kFloatUnderflow = 0x1p-120;

template <std::size_t kBytes>
OBB_INLINE void judge(const EightFrame& frame, const EightNodes& nodes, EightVerdicts& verdicts) {
    using Real = Floats<kBytes>;
    const auto node = [&](std::size_t k)
                          __attribute__((always_inline)) -> const Node& { return *nodes[k]; };
    const Boxes<Real> boxes = placed_eight<kBytes>(frame, node);
    const Lanes3<Real> d = ways<kBytes>(frame, node);
    const Lanes3<Real>& h = boxes.half_extents;
    const Real size = h[0] + h[1] + h[2];
    const Real way = magnitude(d[0]) + magnitude(d[1]) + magnitude(d[2]);
    const Real e = Real::at(frame.relative.data()) * (way + of_a(size) + of_b(size)) +
                   Real::at(frame.absolute.data());
    const Lanes3<Real> ha{of_a(h[0]), of_a(h[1]), of_a(h[2])};
    const Lanes3<Real> hb{of_b(h[0]), of_b(h[1]), of_b(h[2])};
    std::array<Lanes3<Real>, 3> b;
    for (std::size_t j = 0; j < 3; ++j) {
        b[j] = {of_b(boxes.axes[j][0]), of_b(boxes.axes[j][1]), of_b(boxes.axes[j][2])};
    }

    // c[i][j] = A_i . B_j, t[i] = A_i . D; as in are_separated().
    Real c[3][3], r[3][3], t[3];
    Real most;
    for (std::size_t i = 0; i < 3; ++i) {
        const Lanes3<Real> a{of_a(boxes.axes[i][0]), of_a(boxes.axes[i][1]),
                             of_a(boxes.axes[i][2])};
        t[i] = inner(a, d);
        for (std::size_t j = 0; j < 3; ++j) {
            c[i][j] = inner(a, b[j]);
            r[i][j] = magnitude(c[i][j]);
        }
        const Real gap =
            magnitude(t[i]) - ha[i] - inner(hb, Lanes3<Real>{r[i][0], r[i][1], r[i][2]});
        most = i == 0 ? gap : upper(gap, most);
    }
    for (std::size_t j = 0; j < 3; ++j) {
        const Lanes3<Real> column{c[0][j], c[1][j], c[2][j]};
        const Lanes3<Real> radii{r[0][j], r[1][j], r[2][j]};
        most = upper(magnitude(inner(Lanes3<Real>{t[0], t[1], t[2]}, column)) - hb[j] -
                         inner(ha, radii),
                     most);
    }
    const unsigned deep_by_faces = bits_of<Real>(most < Real{} - e);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            const Real distance = magnitude(t[i2] * c[i1][j] - t[i1] * c[i2][j]);
            const Real radius_a = ha[i1] * r[i2][j] + ha[i2] * r[i1][j];
            const Real radius_b = hb[j1] * r[i][j2] + hb[j2] * r[i][j1];
            most = upper(distance - (radius_a + radius_b), most);
        }
    }
    verdicts.apart = bits_of<Real>(most > e);
    verdicts.open_by_faces = ~(verdicts.apart | deep_by_faces) & 0xffU;
    verdicts.open = ~(verdicts.apart | bits_of<Real>(most < Real{} - e)) & 0xffU;
    way.store(verdicts.nearness.data());
}

} // namespace

void EightFrame::set(const PosedTree& a, const PosedTree& b, const RoundingBound& bound) {
    scale_a.fill(a.node_scale());
    // Rounded up, as doubles are rounded to floats by at most 2^-24 of them.
    constexpr double kUp = 1 + 0x1p-22;
    relative.fill(static_cast<float>((kFloatBound + bound.relative) * kUp));
    absolute.fill(static_cast<float>((kFloatUnderflow + bound.absolute) * kUp));
    const std::array<const PosedTree*, 2> bodies{&a, &b};
    for (std::size_t lane = 0; lane < 8; ++lane) {
        const PosedTree& body = *bodies[lane / 2 % 2];
        node_scale[lane] = static_cast<float>(body.node_scale());
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                matrix[i][k][lane] = static_cast<float>(body.matrix().rows[i][k]);
            }
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            rows_b[i][k].fill(b.node_scale() * b.matrix().rows[i][k]);
        }
        rows_b[i][3].fill(b.offset()[i]);
    }
}

void judge_boxes(const EightFrame& frame, const EightNodes& nodes, EightVerdicts& verdicts) {
    in_registers([&]<std::size_t kBytes>() { judge<kBytes>(frame, nodes, verdicts); });
}

} // namespace obb
