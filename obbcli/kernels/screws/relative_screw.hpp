// The motion of a body B as seen from a body A where that is, to within a slack, one constant
// screw: a turn about an axis and a slide along it, in a constant ratio.
#pragma once

#include "numbers/vec.hpp"

#include <optional>

namespace obb {

// How two bodies move: each turns about its own pivot, which travels. Lengths and times are in one
// unit each, in which positions, ways and the duration are at most about 1.
struct MotionOfTwo {
    Vec3 spin_a, spin_b;   // angular velocities
    Vec3 between;          // B's pivot less A's at the start
    Vec3 closing_velocity; // of B's pivot less that of A's
    double duration;
    double reach_a, reach_b;   // bound how far any point is from the pivot of its body
    double extent_a, extent_b; // radii that hold the bodies
    double near;               // points as near as this are in contact
};

// In the frame that turns and travels with A, every point of B keeps its distance from the axis
// while its angle grows by `speed` and its height by `speed * pitch` in a unit of time. Heights and
// angles are taken about an axis through the pivot of a body that turns; `shift` is what to add to
// the positions of a body, which are about its own pivot, to have them about the axis.
struct RelativeScrew {
    Vec3 axis, across, third; // right-handed; unit and orthogonal to 4 u
    Vec3 shift_a, shift_b;
    double speed;       // radians in a unit of time
    double sweep;       // radians in all, at least kLeastSweep
    double pitch;       // height for a radian; 0 where it does not matter: a hinge
    double lead;        // height for a turn
    double slack;       // of each body: by how much positions may be off; see relative_screw()
    double angle_error; // rad; by how much speed * time may be off
    double excess;      // the slack of both, less the nearness asked for

    [[nodiscard]] bool is_hinge() const { return pitch == 0; }
};

// Slower turns make the lead long, and steps are good at them.
inline constexpr double kLeastSweep = 0x1p-10;

// The common screw of two bodies; nothing where there is none, or where the slack is so large that
// it would hide what the bodies do.
[[nodiscard]] std::optional<RelativeScrew> relative_screw(const MotionOfTwo& motion);

} // namespace obb
