// What Python reads of the place of a contact, by name.
#pragma once

#include "in_motion/contact_query.hpp"

// Tells each field with its name: attributes of a place, and columns of the answers of sweeps.
template <typename Tell>
void each_place_field(const Tell& tell) {
    using Place = obb::ContactPlace;
    tell("point", &Place::point);
    tell("point_a", &Place::point_a);
    tell("point_b", &Place::point_b);
    tell("normal", &Place::normal);
    tell("normal_a", &Place::normal_a);
    tell("normal_b", &Place::normal_b);
    tell("feature", &Place::feature);
}
