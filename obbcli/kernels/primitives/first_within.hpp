// When two triangles under constant velocities first come within a distance of each other, decided
// in exact integers.
#pragma once

#include "primitives/touch.hpp"
#include "shapes/triangle.hpp"

#include <optional>

namespace obb {

// The first time at which two triangles are no further apart than a clearance.
struct Approach {
    double time_below; // the first time is no earlier than this
    double time_above; // and no later; the two are one or two doubles apart, or one
    bool is_within;    // whether the triangles are within the clearance at time_above: exactly
    // Where the gap between a face and a vertex, or between two edges, closed to the clearance: the
    // axis along which it did, and the features as far as `points` names their vertices. The axis
    // has no kind where other features were the nearest.
    Touch touch;
};

// Nothing where the triangles stay further apart for the whole closed duration. Exact for all
// finite doubles. The clearance is more than 0, and the triangles have no point in common at 0.
[[nodiscard]] std::optional<Approach> first_within(const Triangle& a, const Triangle& b,
                                                   const LinearMotion& motion, double clearance);

} // namespace obb
