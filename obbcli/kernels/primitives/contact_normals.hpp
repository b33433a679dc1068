// Normals of boxes and triangles where they are touched.
#pragma once

#include "primitives/touch.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

namespace obb {

// Unit outward normal of the face that `feature` lies in; of several faces the one that points
// along `towards` best. A triangle's normal is turned towards `towards`. Where there is no such
// face, of a triangle without area or a box that touches with no feature, it is `towards`.
[[nodiscard]] Vec3 face_normal(const Triangle& triangle, const Feature& feature,
                               const Vec3& towards);
[[nodiscard]] Vec3 face_normal(const Obb& box, const Feature& feature, const Vec3& towards);

// The normal of the ellipsoid with the box's axes and half extents through `point`, relative to
// the box at that time: a smooth field of normals over the box (Eberly 2008 §7.2). A triangle has
// its face normal only.
[[nodiscard]] Vec3 smooth_normal(const Triangle& triangle, const Vec3& point, const Vec3& normal);
[[nodiscard]] Vec3 smooth_normal(const Obb& box, const Vec3& point, const Vec3& normal);

} // namespace obb
