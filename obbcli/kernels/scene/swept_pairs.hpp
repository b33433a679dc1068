// Which of many moving bodies may come near each other, and not before when: boxes that travel at
// constant velocities, in a tree over space and time.
#pragma once

#include "scene/swept_box.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace obb {

// What is known of pairs beforehand.
struct SweptBodies {
    std::span<const std::uint32_t> groups;    // of each body
    std::span<const std::uint8_t> is_static;  // of each body: such are not asked about each other
    std::span<const std::uint8_t> is_ignored; // of group times group
    std::size_t group_count;
};

struct NearPair {
    std::uint32_t a, b; // a < b
    double time;        // not nearer than the reach before this; s

    friend bool operator==(const NearPair&, const NearPair&) = default;
};

// Pairs of bodies whose boxes come within `reach` of each other, each once, by time and then by
// number. Boxes must be wider than their bodies by more than 2^-45 of all coordinates, lengths of
// ways, and the reach: the rounding here is not counted. Throws std::invalid_argument where numbers
// of bodies or groups are out of range.
[[nodiscard]] std::vector<NearPair> swept_pairs(std::span<const SweptBox> boxes,
                                                const SweptBodies& bodies, double reach);

} // namespace obb
