// Where a contact is: points, normals and the features that meet.
#pragma once

#include "in_motion/contact.hpp"
#include "in_motion/moving_pair.hpp"

namespace obb {

// The place of a contact of the pair at its `low`.
[[nodiscard]] ContactPlace place_of(MovingPair& pair, const Contact& contact);

} // namespace obb
