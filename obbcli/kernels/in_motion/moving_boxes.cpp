#include "in_motion/moving_boxes.hpp"

#include "numbers/lane_moves.hpp"
#include "numbers/lane_vectors.hpp"

namespace obb {

namespace {

template <std::size_t kBytes>
OBB_INLINE void turn(LaneMotion& motion, const Turn& a, const Turn& b) {
    using Real = Doubles<kBytes>;
    const Real sine = alternating<Real>(a.sine, b.sine);
    const Real cosine = alternating<Real>(a.cosine, b.cosine);
    const Lanes3<Real> k = lanes_at<Real>(motion.axis);
    const Real versine = Real(1.0) - cosine;
    const Lanes3<Real> s{sine * k[0], sine * k[1], sine * k[2]};
    const Lanes3<Real> v{versine * k[0], versine * k[1], versine * k[2]};
    const std::array<Lanes3<Real>, 3> spun{
        {{cosine + v[0] * k[0], v[0] * k[1] - s[2], v[0] * k[2] + s[1]},
         {v[0] * k[1] + s[2], cosine + v[1] * k[1], v[1] * k[2] - s[0]},
         {v[0] * k[2] - s[1], v[1] * k[2] + s[0], cosine + v[2] * k[2]}}};
    const Lanes3<Real> offset = lanes_at<Real>(motion.offset);
    for (std::size_t j = 0; j < 3; ++j) {
        const Lanes3<Real> column = lanes_at<Real>(motion.columns[j]);
        for (std::size_t i = 0; i < 3; ++i) {
            inner(spun[i], column).store(motion.matrix[i][j].data());
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        inner(spun[i], offset).store(motion.shift[i].data());
    }
}

// Axes as axes_of_quaternion() computes them.
template <std::size_t kBytes>
OBB_INLINE void place(const LaneMotion& motion, const FourPlaced& nodes, PlacedBoxes& boxes) {
    using Real = Doubles<kBytes>;
    const auto lanes = [&](const auto& number) __attribute__((always_inline)) {
        const PairLanes all{number(*nodes[0]), number(*nodes[1]), number(*nodes[2]),
                            number(*nodes[3])};
        return Real::at(all.data());
    };
    const auto rotation = [&](std::size_t k) __attribute__((always_inline)) {
        return lanes([k](const Node& n) { return double{n.rotation[k]}; });
    };
    const Real scale = Real::at(motion.node_scale.data());
    const Lanes3<Real> center{scale * lanes([](const Node& n) { return n.center.x; }),
                              scale * lanes([](const Node& n) { return n.center.y; }),
                              scale * lanes([](const Node& n) { return n.center.z; })};
    const Real w = rotation(0), x = rotation(1), y = rotation(2), z = rotation(3);
    const Real one(1.0);
    const Real s = Real(2.0) / (w * w + x * x + y * y + z * z);
    const Real wx = s * w * x, wy = s * w * y, wz = s * w * z;
    const Real xx = s * x * x, xy = s * x * y, xz = s * x * z;
    const Real yy = s * y * y, yz = s * y * z, zz = s * z * z;
    const std::array<Lanes3<Real>, 3> axes{{{one - yy - zz, xy + wz, xz - wy},
                                            {xy - wz, one - xx - zz, yz + wx},
                                            {xz + wy, yz - wx, one - xx - yy}}};
    for (std::size_t i = 0; i < 3; ++i) {
        const Lanes3<Real> row = lanes_at<Real>(motion.matrix[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            inner(row, axes[k]).store(boxes.axes[k][i].data());
        }
        (inner(row, center) + Real::at(motion.shift[i].data())).store(boxes.center[i].data());
        (scale * lanes([i](const Node& n) {
             return double{n.half_extents[i]};
         })).store(boxes.half_extents[i].data());
    }
}

} // namespace

void PlacedBoxes::set(std::size_t lane, const Obb& box) {
    for (std::size_t i = 0; i < 3; ++i) {
        center[i][lane] = box.center[i];
        half_extents[i][lane] = box.half_extents[i];
        for (std::size_t k = 0; k < 3; ++k) {
            axes[k][i][lane] = box.axes[k][i];
        }
    }
}

Obb PlacedBoxes::box(std::size_t k) const {
    return {lane(center, k),
            {lane(axes[0], k), lane(axes[1], k), lane(axes[2], k)},
            lane(half_extents, k)};
}

void set_turns(LaneMotion& motion, const Turn& a, const Turn& b) {
    in_registers([&]<std::size_t kBytes>() { turn<kBytes>(motion, a, b); });
}

void place_boxes(const LaneMotion& motion, const FourPlaced& nodes, PlacedBoxes& boxes) {
    in_registers([&]<std::size_t kBytes>() { place<kBytes>(motion, nodes, boxes); });
}

} // namespace obb
