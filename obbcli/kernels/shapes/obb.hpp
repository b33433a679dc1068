// An oriented box taken literally: { center + sum_i y_i axes[i] : |y_i| <= half_extents[i] }.
#pragma once

#include "numbers/pack.hpp"
#include "numbers/vec.hpp"

#include <array>

namespace obb {

template <typename Real>
struct BasicObb {
    Vector3<Real> center;
    std::array<Vector3<Real>, 3> axes;
    Vector3<Real> half_extents;
};

using Obb = BasicObb<double>;

} // namespace obb
