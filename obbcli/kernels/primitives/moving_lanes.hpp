// When triangles under constant velocities first and last touch, in doubles, four pairs at once:
// what sat_triangle_triangle.hpp and MovingSat say of each of them.
#pragma once

#include "primitives/sat.hpp"
#include "shapes/triangle.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace obb {

// B's velocity less A's, and until when.
struct ClosingMotion {
    Vec3 velocity;
    double duration;
};

// Four pairs of triangles. Magnitudes of coordinates, velocities and the duration are at most
// kLargestFiltered.
struct FourPairs {
    std::array<const Triangle*, 4> a, b;
};

// Bounds on the first and last time of contact in [0, duration], pair by pair, if there is any: a
// pair with entry_low > exit_high is apart throughout, one with entry_high <= exit_low surely
// touches, no later than entry_high. Narrowed by one group of axes after the other.
struct FourTimes {
    using Row = std::array<double, 4>;
    Row entry_low, entry_high, exit_low, exit_high;

    [[nodiscard]] static FourTimes of(const ClosingMotion& motion) {
        const double end = motion.duration;
        return {{}, {}, {end, end, end, end}, {end, end, end, end}};
    }
    [[nodiscard]] AxisTimes lane(std::size_t k) const {
        return {entry_low[k], entry_high[k], exit_low[k], exit_high[k]};
    }
    void set(std::size_t k, const AxisTimes& times) {
        entry_low[k] = times.entry_low;
        entry_high[k] = times.entry_high;
        exit_low[k] = times.exit_low;
        exit_high[k] = times.exit_high;
    }
};

// By the normals of both triangles, and by the products of their edges.
void narrow_by_faces(const FourPairs& pairs, const ClosingMotion& motion, FourTimes& times);
void narrow_by_edges(const FourPairs& pairs, const ClosingMotion& motion, FourTimes& times);

} // namespace obb
