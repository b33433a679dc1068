// When can two images first meet, in closed form and whatever the number of turns?
#pragma once

#include "screws/image_tree.hpp"

namespace obb {

// Angles that the screw has turned by, from `sigma`, rad: no contact of what two nodes or images
// hold is at an earlier one that is no less than `sigma` itself. Infinite where they never meet
// between there and the end of the sweep.
[[nodiscard]] double first_meeting(const RelativeScrew& screw, const ImageNode& a,
                                   const ImageNode& b, double sigma);
[[nodiscard]] double first_meeting(const RelativeScrew& screw, const Image& a, const Image& b,
                                   double sigma);

} // namespace obb
