#include "descent/posed_tree.hpp"

#include "numbers/scale.hpp"

namespace obb {

void PosedTree::set_frame(const Mat3& matrix, Vec3 offset, int exponent) {
    matrix_ = matrix;
    offset_ = offset;
    is_moved_ = !(matrix == Mat3::identity() && offset == Vec3{0, 0, 0});
    scale_ = power_of_two(tree_->scale_exponent - exponent);
    const int half = -exponent / 2;
    vertex_scales_ = {power_of_two(half), power_of_two(-exponent - half)};
}

template <typename Real>
BasicObb<Real> PosedTree::in_frame(BasicObb<Real> box) const {
    const auto turned = [&](Vector3<Real> v) {
        const auto& m = matrix_.rows;
        return Vector3<Real>{m[0].x * v.x + m[0].y * v.y + m[0].z * v.z,
                             m[1].x * v.x + m[1].y * v.y + m[1].z * v.z,
                             m[2].x * v.x + m[2].y * v.y + m[2].z * v.z};
    };
    const auto scaled_by = [&](Vector3<Real> v) {
        return Vector3<Real>{scale_ * v.x, scale_ * v.y, scale_ * v.z};
    };
    box.center = scaled_by(box.center);
    box.half_extents = scaled_by(box.half_extents);
    if (is_moved_) {
        const Vector3<Real> c = turned(box.center);
        box.center = {c.x + offset_.x, c.y + offset_.y, c.z + offset_.z};
        for (Vector3<Real>& axis : box.axes) {
            axis = turned(axis);
        }
    }
    return box;
}

Obb PosedTree::box(const Node& node) const {
    return in_frame(Obb{node.center, axes_of(node.rotation), half_extents_of(node)});
}

Triangle PosedTree::triangle_in_frame(const NodeRef& ref) const {
    Triangle t = tree_->triangle(ref.begin);
    for (Vec3& v : t) {
        v = vertex_scales_[1] * (vertex_scales_[0] * v);
        v = is_moved_ ? matrix_ * v + offset_ : v;
    }
    return t;
}

Triangle PosedTree::triangle(const NodeRef& ref) const {
    const Triangle t = tree_->triangle(ref.begin);
    return is_posed_ ? posed(pose_, t) : t;
}

std::uint32_t PosedTree::id(const NodeRef& ref) const { return tree_->triangle_ids[ref.begin]; }

void PosedTree::place_triangles(std::uint32_t begin, std::uint32_t count,
                                FourTriangles& placed) const {
    FourCorners corners;
    for (std::uint32_t k = 0; k < 4; ++k) {
        corners[k] = tree_->corners_of(begin + (k < count ? k : 0));
    }
    is_posed_ ? pose_triangles(pose_, corners, placed) : gather_triangles(corners, placed);
}

} // namespace obb
