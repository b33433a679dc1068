// Three coordinates, each in lanes.
#pragma once

#include "numbers/registers.hpp"
#include "numbers/vec.hpp"

#include <array>
#include <cstddef>

namespace obb {

template <typename Real>
using Lanes3 = std::array<Real, 3>;

template <typename Real>
OBB_INLINE Real inner(const Lanes3<Real>& a, const Lanes3<Real>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <typename Real>
OBB_INLINE Lanes3<Real> outer(const Lanes3<Real>& a, const Lanes3<Real>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <typename Real>
OBB_INLINE Lanes3<Real> sum(const Lanes3<Real>& a, const Lanes3<Real>& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <typename Real>
OBB_INLINE Lanes3<Real> difference(const Lanes3<Real>& a, const Lanes3<Real>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <typename Real>
OBB_INLINE Real absolute_sum(const Lanes3<Real>& a) {
    return magnitude(a[0]) + magnitude(a[1]) + magnitude(a[2]);
}
template <typename Real, std::size_t kCount>
OBB_INLINE Lanes3<Real> lanes_at(const std::array<std::array<double, kCount>, 3>& v) {
    return {Real::at(v[0].data()), Real::at(v[1].data()), Real::at(v[2].data())};
}
template <typename Real>
OBB_INLINE Lanes3<Real> all_alike(const Vec3& v) {
    return {Real(v.x), Real(v.y), Real(v.z)};
}

} // namespace obb
