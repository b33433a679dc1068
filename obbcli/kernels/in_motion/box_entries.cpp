#include "in_motion/box_entries.hpp"

#include <limits>

namespace obb {

namespace {

// The latest entry and the earliest exit so far.
struct alignas(kAlignment<Four>) Stay {
    Four entry, exit;

    // Projections meet while |distance + t speed| <= radius.
    [[gnu::always_inline]] void cut(Four distance, Four speed, Four radius) {
        const Four pace = absolute(speed);
        const Four way = flipped(distance, speed);
        const Four in = (-way - radius) / pace, out = (radius - way) / pace;
        entry = select(in > entry, in, entry);
        exit = select(out < exit, out, exit);
    }
};

} // namespace

OBB_WIDE BoxEntries box_entries(const BasicObb<Four>& boxes, const ClosingFrame& frame) {
    const BasicObb<Four> a = shuffled<0, 0, 1, 1>(boxes), b = shuffled<2, 3, 2, 3>(boxes);
    const Four like = a.center.x;
    const auto all = [&](const Vec3& v) {
        return Vector3<Four>{every(v.x, like), every(v.y, like), every(v.z, like)};
    };
    const Vector3<Four> d = b.center - a.center + all(frame.between), v = all(frame.velocity);
    const Vector3<Four> ha = a.half_extents, hb = b.half_extents;
    const Four sizes = absolute_sum(d) + (ha.x + ha.y + ha.z) + (hb.x + hb.y + hb.z) +
                       frame.span * norm_1(frame.velocity);
    const Four e = frame.relative * sizes + frame.absolute;
    Stay stay{every(0.0, like), every(frame.span, like)};
    Four c[3][3], r[3][3], t[3], w[3];
    for (std::size_t i = 0; i < 3; ++i) {
        t[i] = dot(a.axes[i], d);
        w[i] = dot(a.axes[i], v);
        for (std::size_t j = 0; j < 3; ++j) {
            c[i][j] = dot(a.axes[i], b.axes[j]);
            r[i][j] = absolute(c[i][j]);
        }
        stay.cut(t[i], w[i], ha[i] + (hb.x * r[i][0] + hb.y * r[i][1] + hb.z * r[i][2]) + e);
    }
    for (std::size_t j = 0; j < 3; ++j) {
        stay.cut(dot(b.axes[j], d), dot(b.axes[j], v),
                 hb[j] + (ha.x * r[0][j] + ha.y * r[1][j] + ha.z * r[2][j]) + e);
    }
    if (!is_all(stay.entry > stay.exit)) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
            for (std::size_t j = 0; j < 3; ++j) {
                const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
                const Four radius = ha[i1] * r[i2][j] + ha[i2] * r[i1][j] +
                                    (hb[j1] * r[i][j2] + hb[j2] * r[i][j1]) + e;
                stay.cut(t[i2] * c[i1][j] - t[i1] * c[i2][j], w[i2] * c[i1][j] - w[i1] * c[i2][j],
                         radius);
            }
        }
    }
    const Four entry = (1 - 0x1p-48) * stay.entry, exit = (1 + 0x1p-48) * stay.exit;
    return {{entry[0], entry[1], entry[2], entry[3]}, {exit[0], exit[1], exit[2], exit[3]}};
}

} // namespace obb
