// What is found of a contact of moving trees: when, of what, and where.
#pragma once

#include "primitives/touch.hpp"
#include "tree/tree.hpp"

#include <cstdint>
#include <limits>

namespace obb {

enum class Evidence : std::uint8_t { kNone, kIntersecting, kWithinTolerance, kBoxes };

// A proven bracket of the first contact: none before `low`, and contact at `high` as `evidence`
// says. Where `distance` exceeds the clearance, contact is not proven: the triangles are in contact
// by `high`, or they pass each other and have parted by then. Times in s.
struct Contact {
    double low = 0;
    double high = 0;
    Evidence evidence = Evidence::kNone;
    NodeRef a{}, b{};
    double distance = 0;    // proven bound on the distance at `high`, mesh units; 0 if intersecting
    double error_bound = 0; // of boxes that met: how far apart the surfaces can be, mesh units
    std::uint32_t triangle_a = 0, triangle_b = 0; // rows of the mesh files; 0 where boxes met
};

// What is to be said of the place of a contact, world coordinates at its time. NaN where nothing
// is.
struct ContactPlace {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    static constexpr Vec3 kNowhere{kNone, kNone, kNone};

    Vec3 point_a = kNowhere, point_b = kNowhere;
    Vec3 normal = kNowhere;                        // unit, from A to B
    Vec3 normal_a = kNowhere, normal_b = kNowhere; // unit face normals, outward of the contact
    FeatureCode feature = kNoFeature;
    Vec3 point = kNowhere; // midway between point_a and point_b
};

} // namespace obb
