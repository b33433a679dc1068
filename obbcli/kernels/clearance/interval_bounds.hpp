// Lower bounds on the distance of two boxes or triangles over a whole interval of time.
#pragma once

#include "clearance/relative_motion.hpp"
#include "in_motion/moving_pair.hpp"
#include "nearest/closest_points.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

namespace obb {

// Both bodies around one time c, as seen from each of them; all in the pair's scaled units. Bounds
// hold from c - half to c + half, given that neither body turns by much in it (see kLongestTurn).
struct IntervalFrame {
    IntervalFrame(const MovingPair& pair, double middle, double half, double slack);

    RelativeMotion from_a, from_b;
    double half;
    bool is_a_slower;       // boxes are seen from the slower body
    double relative;        // rounding of a projection, times the sizes in play
    double absolute;        // of positions, beyond that
    double box_error, skew; // of boxes: what they may miss, and how far axes are from orthonormal
};

// |Wx| + |Wy| times half the interval is at most this, so that each derivative's term is below the
// one before: the rounding of all terms together is less than four times that of the projection.
inline constexpr double kLongestTurn = 0.25;

struct BoxBound {
    double low;    // of the distance, anywhere in the interval; 0 where nothing is proven
    double gap;    // at its middle
    double travel; // about how far the boxes move against each other in half of it
};

// Each box is about its own body's pivot.
[[nodiscard]] BoxBound bound_boxes(const IntervalFrame& frame, const Obb& a, const Obb& b);

// `near` is what measure() says of the triangles at the middle.
[[nodiscard]] double bound_triangles(const IntervalFrame& frame, const PlacedTriangles& placed,
                                     const TriangleDistance& near);

} // namespace obb
