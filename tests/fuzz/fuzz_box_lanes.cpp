// Boxes in float lanes: who is said to be apart is so, by the axes in more digits, at any scale and
// proportions, just apart and just not. NaN and infinity separate nothing.
#include "bytes.hpp"
#include "descent/box_lanes.hpp"
#include "descent/query_frame.hpp"

#include <array>
#include <limits>

namespace {

using fuzz::require;
using Real = long double;
using Real3 = std::array<Real, 3>;

Real inner(const Real3& a, const Real3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Real3 crossed(const Real3& a, const Real3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real size_of(const Real3& a) { return std::fabs(a[0]) + std::fabs(a[1]) + std::fabs(a[2]); }

struct Box {
    Real3 center, half_extents;
    std::array<Real3, 3> axes;
};

Box placed(const obb::PosedTree& body, const obb::Node& node) {
    const auto turned = [&](const obb::Vec3& v, Real scale, const obb::Vec3& shift) {
        Real3 result;
        for (std::size_t i = 0; i < 3; ++i) {
            const obb::Vec3& row = body.matrix().rows[i];
            result[i] = scale * inner({row.x, row.y, row.z}, {v.x, v.y, v.z}) + shift[i];
        }
        return result;
    };
    Box box;
    box.center = turned(node.center, body.node_scale(), body.offset());
    const auto axes = obb::axes_of(node.rotation);
    for (std::size_t k = 0; k < 3; ++k) {
        box.axes[k] = turned(axes[k], 1, {0, 0, 0});
        box.half_extents[k] = Real{body.node_scale()} * node.half_extents[k];
    }
    return box;
}

struct Gap {
    Real value = -std::numeric_limits<Real>::infinity(); // along the axis, which is no unit vector
    Real3 axis{};
    bool is_positive_side = false;
};

// The largest over the fifteen axes.
Gap largest_gap(const Box& a, const Box& b) {
    const Real3 d{b.center[0] - a.center[0], b.center[1] - a.center[1], b.center[2] - a.center[2]};
    Gap largest;
    const auto look = [&](const Real3& axis) {
        Real radius = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            radius += a.half_extents[k] * std::fabs(inner(axis, a.axes[k])) +
                      b.half_extents[k] * std::fabs(inner(axis, b.axes[k]));
        }
        const Real distance = inner(axis, d);
        if (std::fabs(distance) - radius > largest.value) {
            largest = {std::fabs(distance) - radius, axis, distance >= 0};
        }
    };
    for (std::size_t i = 0; i < 3; ++i) {
        look(a.axes[i]);
        look(b.axes[i]);
        for (std::size_t j = 0; j < 3; ++j) {
            look(crossed(a.axes[i], b.axes[j]));
        }
    }
    return largest;
}

// Extents of ratios up to 10^6, zero among them; a quaternion of any length that a tree may hold.
obb::Node node_of(fuzz::Bytes& bytes) {
    obb::Node node = obb::kNoBox;
    const auto center = bytes.moderate_point();
    node.center = 1.0 / 64 * center;
    const auto fraction = [&] {
        return static_cast<float>(1 + bytes.take<std::uint16_t>()) / 65536;
    };
    for (float& extent : node.half_extents) {
        const int exponent = bytes.take<std::uint8_t>() % 22;
        extent = exponent == 21 ? 0 : std::ldexp(fraction(), -exponent);
    }
    float square = 0;
    std::array<float, 4> q{};
    for (float& part : q) {
        const int exponent = bytes.take<std::uint8_t>() % 28;
        const float size = exponent == 27 ? 0 : std::ldexp(fraction(), -exponent);
        part = bytes.take<std::uint8_t>() % 2 == 0 ? size : -size;
        square += part * part;
    }
    if (square > 0.26F) {
        node.rotation = q;
    } else {
        node.rotation[1] = q[1];
    }
    return node;
}

obb::Pose pose_of(fuzz::Bytes& bytes, int exponent) {
    obb::Pose pose = bytes.pose();
    pose.translation =
        std::ldexp(1.0, std::max(std::min(exponent, 900), -1000)) / 64 * pose.translation;
    return pose;
}

// Moves B so that its gap along the axis where it is largest is a share of the sizes.
void move_to(obb::Node& node, const obb::PosedTree& body, const Box& a, Real share) {
    for (int turn = 0; turn < 3; ++turn) {
        const Box b = placed(body, node);
        const Gap gap = largest_gap(a, b);
        const Real square = inner(gap.axis, gap.axis);
        const Real sizes = size_of(a.half_extents) + size_of(b.half_extents);
        if (!(square > 1e-12L) || !(body.node_scale() > 0) || !(sizes > 0)) {
            return;
        }
        const Real way = (share * sizes * std::sqrt(square) - gap.value) / square *
                         (gap.is_positive_side ? 1 : -1) / body.node_scale();
        for (std::size_t k = 0; k < 3; ++k) {
            const obb::Vec3 column = body.matrix().column(k);
            node.center[k] +=
                static_cast<double>(way * inner(gap.axis, {column.x, column.y, column.z}));
        }
    }
}

void check(const obb::EightFrame& frame, const obb::EightNodes& nodes, const obb::PosedTree& a,
           const obb::PosedTree& b) {
    obb::EightVerdicts verdicts;
    obb::judge_boxes(frame, nodes, verdicts);
    require((verdicts.apart & (verdicts.open | verdicts.open_by_faces)) == 0, "apart is decided");
    for (std::size_t lane = 0; lane < 8; ++lane) {
        const std::size_t first = lane & 4U;
        const Box box_a = placed(a, *nodes[first + obb::kOfA[lane % 4]]);
        const Box box_b = placed(b, *nodes[first + 2 + obb::kOfB[lane % 4]]);
        const Real gap = largest_gap(box_a, box_b).value;
        require((verdicts.apart >> lane & 1U) == 0 || gap > 0, "who is said to be apart is so");
        require(((verdicts.apart | verdicts.open) >> lane & 1U) != 0 || gap < 0,
                "where nothing is open every axis sees the boxes overlap");
    }
}

void check_spoilt(const obb::EightFrame& frame, std::array<obb::Node, 8> boxes, std::uint32_t which,
                  float with) {
    obb::Node& node = boxes[which % 8];
    const std::uint32_t number = which / 8 % 10;
    if (number < 3) {
        node.center[number] = with;
    } else if (number < 6) {
        node.half_extents[number - 3] = std::fabs(with); // less than nothing has no radius
    } else {
        node.rotation[number - 6] = with;
    }
    obb::EightNodes nodes;
    for (std::size_t k = 0; k < 8; ++k) {
        nodes[k] = &boxes[k];
    }
    obb::EightVerdicts verdicts;
    obb::judge_boxes(frame, nodes, verdicts);
    for (std::size_t lane = 0; lane < 8; ++lane) {
        const std::size_t first = lane & 4U;
        const bool is_spoilt = which % 8 == first + obb::kOfA[lane % 4] ||
                               which % 8 == first + 2 + obb::kOfB[lane % 4];
        require(!is_spoilt || (verdicts.apart >> lane & 1U) == 0, "NaN and infinity part nothing");
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Bytes bytes(data, size);
    const auto options = bytes.take<std::uint8_t>();
    const auto small = [&] { return options & 1 ? bytes.take<std::int16_t>() % 1020 : 0; };
    const std::array<int, 2> exponents{small(), options & 2 ? small() : 0};
    std::array<obb::Node, 8> boxes;
    for (obb::Node& node : boxes) {
        node = node_of(bytes);
    }
    const obb::TreeView tree_a{{}, {}, {}, {}, exponents[0]};
    const obb::TreeView tree_b{{}, {}, {}, {}, options & 2 ? exponents[1] : exponents[0]};
    const obb::Pose pose_a = options & 4 ? pose_of(bytes, exponents[0]) : obb::Pose{};
    const obb::Pose pose_b = options & 8 ? pose_a : pose_of(bytes, exponents[0]);
    obb::PosedTree a(tree_a, pose_a), b(tree_b, pose_b);
    const obb::QueryFrame common = obb::set_common_frame(a, b);
    for (std::size_t k : {2U, 3U, 6U, 7U}) {
        const Real share = std::ldexp(Real{1} * bytes.take<std::int8_t>(),
                                      -(16 + bytes.take<std::uint8_t>() % 16));
        if (share != 0) {
            move_to(boxes[k], b, placed(a, boxes[k - 2]), share);
        }
    }
    obb::EightNodes nodes;
    for (std::size_t k = 0; k < 8; ++k) {
        nodes[k] = &boxes[k];
    }
    obb::EightFrame frame;
    frame.set(a, b, common.bound);
    check(frame, nodes, a, b);
    constexpr std::array<float, 3> kBad{std::numeric_limits<float>::quiet_NaN(),
                                        std::numeric_limits<float>::infinity(),
                                        -std::numeric_limits<float>::infinity()};
    const auto which = bytes.take<std::uint16_t>();
    check_spoilt(frame, boxes, which, kBad[bytes.below(3)]);
    // What the proof in box_lanes.cpp leaves to spare is spared.
    frame.relative.fill(static_cast<float>(102 * 0x1p-24 + common.bound.relative));
    check(frame, nodes, a, b);
    return 0;
}
