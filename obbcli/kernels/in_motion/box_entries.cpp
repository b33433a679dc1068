#include "in_motion/box_entries.hpp"

#include "numbers/lane_moves.hpp"
#include "numbers/lane_vectors.hpp"

namespace obb {

namespace {

// The latest entry and the earliest exit so far.
template <typename Real>
struct Stay {
    Real entry, exit;

    // Projections meet while |distance + t speed| <= radius.
    OBB_INLINE void cut(const Real& distance, const Real& speed, const Real& radius) {
        const Real pace = magnitude(speed);
        const Real way = flipped(distance, speed);
        const Real in = (Real{} - way - radius) / pace, out = (radius - way) / pace;
        entry = upper(in, entry);
        exit = lower(out, exit);
    }
};

// Lanes of pairs, from those of boxes: of A's first box with B's both, then of its second with B's
// second and first.
template <typename Real>
OBB_INLINE Lanes3<Real> of_a(const PairLanes3& v) {
    const Lanes3<Real> all = lanes_at<Real>(v);
    return {shuffled<0, 0>(all[0]), shuffled<0, 0>(all[1]), shuffled<0, 0>(all[2])};
}
template <typename Real>
OBB_INLINE Lanes3<Real> of_b(const PairLanes3& v) {
    const Lanes3<Real> all = lanes_at<Real>(v);
    return {mingled<1, 3>(all[0], exchanged(all[0])), mingled<1, 3>(all[1], exchanged(all[1])),
            mingled<1, 3>(all[2], exchanged(all[2]))};
}

template <std::size_t kBytes>
OBB_INLINE void enter(const PlacedBoxes& boxes, const ClosingFrame& frame, BoxEntries& entries) {
    using Real = Doubles<kBytes>;
    const Lanes3<Real> v = all_alike<Real>(frame.velocity);
    const Lanes3<Real> d = sum(difference(of_b<Real>(boxes.center), of_a<Real>(boxes.center)),
                               all_alike<Real>(frame.between));
    const Lanes3<Real> ha = of_a<Real>(boxes.half_extents), hb = of_b<Real>(boxes.half_extents);
    const Real sizes = absolute_sum(d) + (ha[0] + ha[1] + ha[2]) + (hb[0] + hb[1] + hb[2]) +
                       Real(frame.span * norm_1(frame.velocity));
    const Real e = Real(frame.relative) * sizes + Real(frame.absolute);
    Stay<Real> stay{Real{}, Real(frame.span)};
    std::array<Lanes3<Real>, 3> b;
    for (std::size_t j = 0; j < 3; ++j) {
        b[j] = of_b<Real>(boxes.axes[j]);
    }
    // c[i][j] = A_i . B_j, t[i] = A_i . D, w[i] = A_i . V; as in are_separated().
    Real c[3][3], r[3][3], t[3], w[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const Lanes3<Real> a = of_a<Real>(boxes.axes[i]);
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
    if (bits_of<Real>(stay.entry > stay.exit) != 0xfU) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
            for (std::size_t j = 0; j < 3; ++j) {
                const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
                const Real radius = ha[i1] * r[i2][j] + ha[i2] * r[i1][j] +
                                    (hb[j1] * r[i][j2] + hb[j2] * r[i][j1]) + e;
                stay.cut(t[i2] * c[i1][j] - t[i1] * c[i2][j], w[i2] * c[i1][j] - w[i1] * c[i2][j],
                         radius);
            }
        }
    }
    const Real entry = Real(1 - 0x1p-48) * stay.entry, exit = Real(1 + 0x1p-48) * stay.exit;
    entries = {{entry[0], entry[1], entry[3], entry[2]}, {exit[0], exit[1], exit[3], exit[2]}};
}

} // namespace

BoxEntries box_entries(const PlacedBoxes& boxes, const ClosingFrame& frame) {
    BoxEntries entries{};
    in_registers([&]<std::size_t kBytes>() { enter<kBytes>(boxes, frame, entries); });
    return entries;
}

} // namespace obb
