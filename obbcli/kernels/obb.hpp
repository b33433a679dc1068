// An oriented box taken literally: { center + sum_i y_i axes[i] : |y_i| <= half_extents[i] }.
#pragma once

#include "pack.hpp"
#include "vec.hpp"

#include <array>

namespace obb {

template <typename Real>
struct BasicObb {
    Vector3<Real> center;
    std::array<Vector3<Real>, 3> axes;
    Vector3<Real> half_extents;
};

using Obb = BasicObb<double>;

[[nodiscard]] inline BasicObb<Pack> broadcast(const Obb& box) {
    const auto twice = [](Vec3 v) { return packed(v, v); };
    return {twice(box.center),
            {twice(box.axes[0]), twice(box.axes[1]), twice(box.axes[2])},
            twice(box.half_extents)};
}

[[nodiscard]] inline Obb lane(const BasicObb<Pack>& boxes, std::size_t k) {
    const auto one = [k](const Vector3<Pack>& v) { return Vec3{v.x[k], v.y[k], v.z[k]}; };
    return {one(boxes.center),
            {one(boxes.axes[0]), one(boxes.axes[1]), one(boxes.axes[2])},
            one(boxes.half_extents)};
}

} // namespace obb
