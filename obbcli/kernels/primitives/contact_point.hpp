// A common point of two shapes at their first contact.
#pragma once

#include "primitives/touch.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

namespace obb {

// A common point at `time`, within rounding of both shapes. Where features meet it lies in the
// middle of what they have in common (Eberly 2008 §2.3.2, 3.3.2 and 4.3.2 choose coordinates one
// by one, which leaves the other shape); where the shapes overlap it is some point of the overlap.
template <typename A, typename B>
[[nodiscard]] Vec3 contact_point(const A& a, const B& b, const LinearMotion& motion, double time,
                                 const Touch& touch);

} // namespace obb
