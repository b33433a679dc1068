// A box that travels, and when two of them are near each other.
#pragma once

#include "numbers/vec.hpp"

#include <cstdint>
#include <optional>

namespace obb {

// A box that holds a body throughout [start, end]: at `start` it is [low, high], and it travels.
// A body with several is in the one or the other of them at any time. Where anything is not finite,
// nothing is known of the body then.
struct SweptBox {
    double start, end; // s
    Vec3 low, high;    // mesh units
    Vec3 velocity;     // mesh units a second
    std::uint32_t body;
};

// The same, or a box that may be anywhere where something is not finite.
[[nodiscard]] SweptBox usable(SweptBox box);

// The first time in [from, to] at which two boxes may be within reach; nothing where there is none.
[[nodiscard]] std::optional<double> time_near(const SweptBox& a, const SweptBox& b, double from,
                                              double to, double reach);

} // namespace obb
