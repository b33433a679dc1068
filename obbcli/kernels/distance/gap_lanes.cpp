#include "distance/gap_lanes.hpp"

#include "descent/eight_boxes.hpp"
#include "numbers/lane_moves.hpp"

namespace obb {

namespace {

// What a gap along a unit direction may be off by. Let u = 2^-24, half a unit in the last place of
// 1 in floats, |d| the sum of coordinates of the way D between the centres, and |a|, |b| those of
// the half extents of A and B. As box_lanes.cpp proves, axes are off by 17.2 u of A and 24.2 u of
// B, all three axes of A together by 29.8 u; t_i = A_i . D by 21.2 u |d|, all three t by 36.8 u
// |d|; and c_ij = A_i . B_j by 44.4 u, the three of one B_j together by 59.2 u.
// - Faces of A: 21.2 u |d| of t_i, (44.4 + 3) u |b| of the radius; two differences of 1 u each:
//   24 u |d| + 2 u |a| + 50 u |b|.
// - Faces of B: B_j . D is off by (24.2 + 1 + 3) u |d|, the radius by 47.4 u |a|; two differences:
//   31 u |d| + 50 u |a| + 2 u |b|.
// - Along N = sum_i n_i A_i, for the numbers n_i at hand, whatever they are; all times |n|, the
// root
//   of their squares, of which the length of N differs by 2^-26. The sum of n_i t_i is off by
//   (36.8 + 3) u |d|; that of a_i |n_i| by 3 u |a|; n . c_j by (59.2 + 3) u, and the sum of
//   b_j |n . c_j| by 3 u more, 65.2 u |b|; two differences: 42 u |d| + 5 u |a| + 68 u |b|. What is
//   subtracted is the bound times the sum of the |n_i|, which is no less than |n|.
// The bound is 48 u |d| + 76 u (|a| + |b|). What it has beyond the above, a tenth, covers products
// of errors, the rounding of the bound itself and of its product with the |n_i|, 10 u of it, and
// that vectors called unit are so up to 2^-26. The errors in doubles are added.
//
// Along three axes at right angles the squares of gaps add up. Squares, sums, the quotient and the
// root are off by at most 8 u of a length together, which kShrink takes off.
//
// Products that underflow lose 2^-150 each, and half extents may in their scaling: fewer than a
// hundred times coordinates up to 2^10 stay below 2^-120, which gaps along axes lose. A gap along
// an axis below 2^-60 is taken for none, so that squares that count have all digits. Along n, a gap
// is so much smaller as n is: of one above 2^-110 the products lose less than u, a |n|^2 above
// 2^-100 loses as little, and what comes out counts above 2^-120.
//
// A NaN proves nothing. No comparison with one is true, so that a gap of NaN is taken for none; a
// NaN of the direction is one in the gap along it.
constexpr float kOfWay = 48 * 0x1p-24F;
constexpr float kOfSizes = 76 * 0x1p-24F;
constexpr double kShrink = 1 - 0x1p-20;
constexpr float kUnderflow = 0x1p-120F;
constexpr float kLeastGap = 0x1p-60F;
constexpr float kLeastAlong = 0x1p-110F;
constexpr float kLeastSquare = 0x1p-100F;

// What is large enough to count, and 0 for all else.
template <typename Real>
OBB_INLINE Real counted(const Real& gap, float least) {
    return select(gap > Real(least), gap, Real{});
}
// What a coordinate has beyond a half extent, with its sign.
template <typename Real>
OBB_INLINE Real beyond(const Real& value, const Real& radius) {
    return value - upper(lower(value, radius), Real{} - radius);
}

// A direction, in A's coordinates: from A's point nearest B's centre to B's point nearest that, and
// from there to A again. Any will do, so it need not be exact.
template <typename Real>
OBB_INLINE Lanes3<Real> direction(const Lanes3<Real>& t, const std::array<Lanes3<Real>, 3>& c,
                                  const Lanes3<Real>& ha, const Lanes3<Real>& hb) {
    Lanes3<Real> w = t;
    const Lanes3<Real> y{beyond(t[0], ha[0]), beyond(t[1], ha[1]), beyond(t[2], ha[2])};
    for (std::size_t j = 0; j < 3; ++j) {
        const Real way = Real{} - inner(y, c[j]);
        const Real z = upper(lower(way, hb[j]), Real{} - hb[j]);
        for (std::size_t i = 0; i < 3; ++i) {
            w[i] += z * c[j][i];
        }
    }
    return {beyond(w[0], ha[0]), beyond(w[1], ha[1]), beyond(w[2], ha[2])};
}

template <typename Real>
OBB_INLINE Real square_of(const Real& a) {
    return a * a;
}
template <typename Real>
OBB_INLINE Lanes3<Real> magnitudes(const Lanes3<Real>& v) {
    return {magnitude(v[0]), magnitude(v[1]), magnitude(v[2])};
}
// Of each row with a vector.
template <typename Real>
OBB_INLINE Lanes3<Real> products(const std::array<Lanes3<Real>, 3>& rows, const Lanes3<Real>& v) {
    return {inner(rows[0], v), inner(rows[1], v), inner(rows[2], v)};
}
// Of one body's boxes, by pairs.
template <typename Real, typename Pick>
OBB_INLINE std::array<Lanes3<Real>, 3> axes_of_lanes(const Boxes<Real>& boxes, const Pick& pick) {
    const auto axis = [&](std::size_t k) __attribute__((always_inline)) {
        return Lanes3<Real>{pick(boxes.axes[k][0]), pick(boxes.axes[k][1]), pick(boxes.axes[k][2])};
    };
    return {axis(0), axis(1), axis(2)};
}

template <std::size_t kBytes>
OBB_INLINE void measure(const GapFrame& frame, const EightNodes& nodes, EightGaps& gaps) {
    using Real = Floats<kBytes>;
    const auto node = [&](std::size_t k)
                          __attribute__((always_inline)) -> const Node& { return *nodes[k]; };
    const Boxes<Real> boxes = placed_eight<kBytes>(frame, node);
    const Lanes3<Real> d = ways<kBytes>(frame, node);
    const Lanes3<Real>& h = boxes.half_extents;
    const Real size = h[0] + h[1] + h[2];
    const Real way = absolute_sum(d);
    const Real e = Real::at(frame.of_way.data()) * way +
                   Real::at(frame.of_sizes.data()) * (of_a(size) + of_b(size)) +
                   Real::at(frame.absolute.data());
    const Lanes3<Real> ha{of_a(h[0]), of_a(h[1]), of_a(h[2])};
    const Lanes3<Real> hb{of_b(h[0]), of_b(h[1]), of_b(h[2])};

    // c[j][i] = A_i . B_j, t[i] = A_i . D. Edge-edge axes were measured: they save one box in
    // twenty and cost as much as all the rest.
    const auto a = axes_of_lanes(boxes, [](const Real& lanes)
                                            __attribute__((always_inline)) { return of_a(lanes); });
    const auto b = axes_of_lanes(boxes, [](const Real& lanes)
                                            __attribute__((always_inline)) { return of_b(lanes); });
    const Lanes3<Real> t = products(a, d);
    const std::array<Lanes3<Real>, 3> c{products(a, b[0]), products(a, b[1]), products(a, b[2])};
    Real by_a{}, by_b{};
    for (std::size_t j = 0; j < 3; ++j) {
        const Real radius = inner(ha, magnitudes(c[j]));
        const Real gap = magnitude(inner(b[j], d)) - hb[j] - radius - e;
        by_b += square_of(counted<Real>(gap, kLeastGap));
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const Real radius = inner(hb, magnitudes(Lanes3<Real>{c[0][i], c[1][i], c[2][i]}));
        const Real gap = magnitude(t[i]) - ha[i] - radius - e;
        by_a += square_of(counted<Real>(gap, kLeastGap));
    }
    const Lanes3<Real> n = direction(t, c, ha, hb);
    const Lanes3<Real> sizes = magnitudes(n);
    const Lanes3<Real> on_b = magnitudes(products(c, n));
    const Real gap = counted<Real>(inner(n, t) - (inner(ha, sizes) + inner(hb, on_b)) -
                                       e * (sizes[0] + sizes[1] + sizes[2]),
                                   kLeastAlong);
    const Real square = inner(n, n);
    const auto is_known = square > Real(kLeastSquare);
    const Real share = select(is_known, gap / select(is_known, square, Real(1.0F)), Real{});
    const Real by_n = counted<Real>(share * gap, kLeastGap * kLeastGap);
    root_of(upper(upper(by_a, by_b), by_n)).store(gaps.low.data());
    e.store(gaps.error.data());
    way.store(gaps.nearness.data());
}

} // namespace

void GapFrame::set(const PosedTree& a, const PosedTree& b, const RoundingBound& bound,
                   double factor) {
    EightFrame::set(a, b, bound);
    shrink = factor * kShrink;
    // Rounded up, as doubles are rounded to floats by at most 2^-24 of them.
    constexpr double kUp = 1 + 0x1p-22;
    of_way.fill(static_cast<float>((double{kOfWay} + bound.relative) * kUp));
    of_sizes.fill(static_cast<float>((double{kOfSizes} + bound.relative) * kUp));
    absolute.fill(static_cast<float>((double{kUnderflow} + bound.absolute) * kUp));
}

void measure_gaps(const GapFrame& frame, const EightNodes& nodes, EightGaps& gaps) {
    in_registers([&]<std::size_t kBytes>() { measure<kBytes>(frame, nodes, gaps); });
}

} // namespace obb
