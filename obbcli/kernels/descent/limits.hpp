// How far a question about two trees is pursued, and what it cost.
#pragma once

#include <cstdint>
#include <limits>

namespace obb {

// Where boxes stand for the triangles they hold.
struct BoxLimits {
    // A leaf of several triangles stands for them as its box does (the paper's coarse leaves).
    bool boxes_for_leaves = false;
    // Nodes this deep stand for what they hold; the root's depth is 0.
    std::uint32_t max_depth_a = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t max_depth_b = std::numeric_limits<std::uint32_t>::max();

    friend bool operator==(const BoxLimits&, const BoxLimits&) = default;
};

// How accurate a certified answer has to be and how long it may take, but for the width of a
// bracket in time, which depends on the motion. A query takes of it what concerns it; the last two
// bind those who advance a query.
struct Limits {
    BoxLimits boxes;
    // Points this close may end a search, mesh units; negative: only proof does.
    double distance_tolerance = -1;
    // Surfaces this close or closer are in contact, mesh units.
    double clearance = 0;
    // Pops and seconds after which a question is left unresolved.
    std::uint64_t max_pops = std::numeric_limits<std::uint64_t>::max();
    double seconds = std::numeric_limits<double>::infinity();
};

// What a query cost so far. Python reads the counts in this order.
struct WalkCounts {
    std::uint64_t box_tests = 0;
    std::uint64_t triangle_tests = 0;
    std::uint64_t exact_triangle_tests = 0; // those that took more digits than double has
    std::uint64_t pops = 0;
    std::uint64_t image_tests = 0; // of triangles in coordinates that a screw leaves alone

    WalkCounts& operator+=(const WalkCounts& more) {
        box_tests += more.box_tests;
        triangle_tests += more.triangle_tests;
        exact_triangle_tests += more.exact_triangle_tests;
        pops += more.pops;
        image_tests += more.image_tests;
        return *this;
    }
};

} // namespace obb
