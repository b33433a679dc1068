// Eight boxes of nodes in lanes of floats, for whatever asks about pairs of them.
#pragma once

#include "numbers/lane_moves.hpp"
#include "numbers/lane_vectors.hpp"
#include "numbers/registers.hpp"
#include "tree/node.hpp"

#include <array>
#include <cstddef>
#include <limits>

namespace obb {

// Lanes of A's boxes and of B's, where each four are two of A and two of B, by their pairs.
template <typename Real>
OBB_INLINE Real of_a(const Real& lanes) {
    return shuffled<0, 1, 0, 1>(lanes);
}
template <typename Real>
OBB_INLINE Real of_b(const Real& lanes) {
    return shuffled<2, 3, 3, 2>(lanes);
}

// Eight boxes but for their centres.
template <typename Real>
struct Boxes {
    std::array<Lanes3<Real>, 3> axes;
    Lanes3<Real> half_extents;
};

// The boxes of eight nodes. A frame has the scale of each node's numbers, and the rows that turn
// its axes; node(k) is the k-th, a Node.
template <std::size_t kBytes, typename Frame, typename NodeOf>
OBB_INLINE Boxes<Floats<kBytes>> placed_eight(const Frame& frame, const NodeOf& node) {
    using Real = Floats<kBytes>;
    // Above the extents is the first number of the quaternion.
    const auto h = gathered_fours<kBytes>(
        [&](std::size_t k) __attribute__((always_inline)) { return node(k).half_extents.data(); });
    const auto [w, x, y, z] = gathered_fours<kBytes>(
        [&](std::size_t k) __attribute__((always_inline)) { return node(k).rotation.data(); });
    const Real square = (w * w + x * x) + (y * y + z * z);
    // Of longer and shorter quaternions, which no builder writes, products might leave the range of
    // floats.
    const auto is_known = (square > Real(0x1p-60F)) & (square < Real(0x1p60F));
    const Real s =
        select(is_known, Real(2.0F) / square, Real(std::numeric_limits<float>::quiet_NaN()));
    const Real sx = s * x, sy = s * y, sz = s * z;
    const Real wx = sx * w, wy = sy * w, wz = sz * w;
    const Real xx = sx * x, xy = sx * y, xz = sx * z;
    const Real yy = sy * y, yz = sy * z, zz = sz * z;
    const Real one(1.0F);
    const std::array<Lanes3<Real>, 3> axes{{{one - yy - zz, xy + wz, xz - wy},
                                            {xy - wz, one - xx - zz, yz + wx},
                                            {xz + wy, yz - wx, one - xx - yy}}};
    Boxes<Real> boxes;
    const Real scale = Real::at(frame.node_scale.data());
    for (std::size_t i = 0; i < 3; ++i) {
        const Lanes3<Real> row{Real::at(frame.matrix[i][0].data()),
                               Real::at(frame.matrix[i][1].data()),
                               Real::at(frame.matrix[i][2].data())};
        for (std::size_t k = 0; k < 3; ++k) {
            boxes.axes[k][i] = inner(row, axes[k]);
        }
        boxes.half_extents[i] = scale * h[i];
    }
    return boxes;
}

// From A's centres to B's, by pairs: placed and subtracted in doubles, then rounded. A frame has
// the unit of A's nodes, rows of B's matrix times that of B's, and B's offset.
template <std::size_t kBytes, typename Frame, typename NodeOf>
OBB_INLINE Lanes3<Floats<kBytes>> ways(const Frame& frame, const NodeOf& node) {
    using Wide = Doubles<kBytes>;
    const auto gather = [&](std::size_t first,
                            Lanes3<Wide>& centers) __attribute__((always_inline)) {
        const auto at = [&](std::size_t k) __attribute__((always_inline)) {
            return &node(first + k % 2 + 4 * (k / 2)).center;
        };
        Wide extents; // which stand above the third coordinate
        gather_pairs<kBytes>([&](std::size_t k)
                                 __attribute__((always_inline)) { return &at(k)->x; },
                             centers[0], centers[1]);
        gather_pairs<kBytes>([&](std::size_t k)
                                 __attribute__((always_inline)) { return &at(k)->z; },
                             centers[2], extents);
    };
    Lanes3<Wide> a, b;
    gather(0, a);
    gather(2, b);
    const Wide scale_a = Wide::at(frame.scale_a.data());
    Lanes3<Floats<kBytes>> result;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& row = frame.rows_b[i];
        const Wide of_a = scale_a * a[i];
        const Wide of_b = inner(Lanes3<Wide>{Wide::at(row[0].data()), Wide::at(row[1].data()),
                                             Wide::at(row[2].data())},
                                b) +
                          Wide::at(row[3].data());
        result[i] = rounded_pairs<kBytes>(of_b - of_a, shuffled<1, 0>(of_b) - of_a);
    }
    return result;
}

} // namespace obb
