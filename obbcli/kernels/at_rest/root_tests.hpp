// Are two posed trees apart by their root boxes alone? Asked before a query is set up, for most
// pairs of bodies in a scene are far from each other. Eberly 2008 §2.2.1 Table 1.
#pragma once

#include "shapes/pose.hpp"
#include "tree/tree.hpp"

#include <array>
#include <cstdint>
#include <limits>

namespace obb {

// The box around a whole body where its pose puts it: world coordinates, mesh units.
struct RootBox {
    Vec3 center{0, 0, 0};
    std::array<Vec3, 3> axes{}; // of the tree's box, turned; of length 1 but for the pose's skew
    Vec3 half_extents{0, 0, 0};
    double radius = 0; // of a sphere around the box
    // Bounds every number that the corners are summed from. Infinite where these tests do not
    // apply: a body of one triangle, scales near the ends of the range of double, poses far from
    // rigid, boxes of a damaged tree that are no numbers.
    double size = std::numeric_limits<double>::infinity();
    double error = std::numeric_limits<double>::infinity(); // by which a projection may be longer
};

[[nodiscard]] RootBox root_box(const TreeView& tree, const Pose& pose);

enum class RootVerdict : std::uint8_t {
    kUnknown, // these tests do not apply
    kApart,   // the posed vertices' hulls are proven apart
    kMayMeet, // no axis of the boxes parts them
};

// Whether spheres, or the fifteen axes of two boxes, part the bodies.
[[nodiscard]] RootVerdict compare_roots(const RootBox& a, const RootBox& b);

} // namespace obb
