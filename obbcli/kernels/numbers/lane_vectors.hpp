// Three coordinates, each in lanes.
#pragma once

#include "numbers/registers.hpp"

#include <array>

namespace obb {

template <typename Real>
using Lanes3 = std::array<Real, 3>;

template <typename Real>
OBB_INLINE Real inner(const Lanes3<Real>& a, const Lanes3<Real>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

} // namespace obb
