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

Obb PosedTree::box(const Node& node) const {
    Obb box{scale_ * node.center, axes_of(node.rotation), scale_ * half_extents_of(node)};
    if (is_moved_) {
        box.center = matrix_ * box.center + offset_;
        for (Vec3& axis : box.axes) {
            axis = matrix_ * axis;
        }
    }
    return box;
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
