#include "overlap/solid_surface.hpp"

#include "numbers/scale.hpp"
#include "shapes/extremes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace obb {

// Blur. With S the sum of the largest coordinate of the mesh, of the translation and of the origin,
// in the frame's unit: a vertex is posed with 4 roundings a coordinate, of sums below 4 S; the
// tree's proof is for { |axes . (p - center)| <= half extents }, which differs by a few u from the
// box; centre and axes are placed with 6 roundings a coordinate; and whoever projects on an axis
// has 16 roundings. That is below 128 u S a coordinate, sqrt(3) times as much along an axis, and
// 2^-43 is 1024 u. Subnormal products and sums are off by 2^-1074 mesh units each besides, and what
// is 2^-900 of the frame's unit vanishes.
//
// Skew. Of the rotated axes R b_i and R b_j the product differs from that of b_i and b_j by at most
// |b_i|_1 |b_j|_1 <= 3 times the skew of R; the axes b are orthonormal to 16 u, and rounded again.
SolidSurface::SolidSurface(const TreeView& tree, const Pose& pose, const OverlapFrame& frame)
    : body_(tree, pose), frame_(frame),
      kept_(std::bit_floor(std::clamp<std::uint32_t>(tree.triangle_count(), 1, kMostKept))) {
    const Vec3 shift = scaled(pose.translation, -frame.exponent);
    body_.set_frame(pose.rotation, shift - frame.origin, frame.exponent);
    const double sizes = 2 * body_.node_scale() + norm_inf(shift) + norm_inf(frame.origin);
    blur_ = 0x1p-43 * sizes + power_of_two(std::max(-900, -1068 - frame.exponent));
    skew_ = 4 * skew_of(pose.rotation) + 64 * kUnitRoundoff;
}

SolidSurface::PlacedBox SolidSurface::place(const Node& node) const {
    PlacedBox placed{body_.box(node), {blur_, blur_, blur_}};
    for (std::size_t i = 0; i < 3; ++i) {
        placed.reach = placed.reach + placed.box.half_extents[i] * abs(placed.box.axes[i]);
    }
    return placed;
}

Triangle SolidSurface::triangle(const NodeRef& ref) const {
    Triangle t = body_.triangle(ref);
    for (Vec3& corner : t) {
        corner = frame_.to_frame(corner);
    }
    return t;
}

void SolidSurface::place_triangles(std::uint32_t begin, std::uint32_t count,
                                   FourTriangles& placed) const {
    body_.place_triangles(begin, count, placed);
    const int exponent = -frame_.exponent;
    const double first = power_of_two(exponent / 2);
    const double second = power_of_two(exponent - exponent / 2);
    for (auto& corner : placed) {
        for (std::size_t k = 0; k < 3; ++k) {
            for (double& value : corner[k]) {
                value = second * (first * value) - frame_.origin[k];
            }
        }
    }
}

} // namespace obb
