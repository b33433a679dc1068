// The paper's questions about one pair of shapes under constant velocities, Eberly 2008 §2 to 4:
// do they meet in [0, duration], and when, where and how first?
#pragma once

#include "primitives/touch.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

#include <optional>

namespace obb {

struct PairVerdict {
    bool intersects;
    bool exact; // rounding could not decide, big integers did
};

struct PairContact {
    double time;       // first time of contact, nearest double
    double time_below; // the last double that is not later than the first time
    double time_above; // the first double that is not earlier
    double last_time;  // last time of contact in [0, duration]
    bool ends;         // whether contact ends before the duration
    Touch touch;
    Vec3 point;              // common to both shapes at the first time, within rounding
    Vec3 normal_a, normal_b; // unit, out of the faces that meet
    Vec3 smooth_normal_a, smooth_normal_b;
};

// Verdicts and times are those of the literal shapes in exact arithmetic; touching counts, and so
// do contacts at 0 and at the duration. Boxes need axes orthonormal to kAxisDefect.
[[nodiscard]] PairVerdict test_pair(const Triangle& a, const Triangle& b, const LinearMotion& m);
[[nodiscard]] PairVerdict test_pair(const Obb& a, const Obb& b, const LinearMotion& m);
[[nodiscard]] PairVerdict test_pair(const Obb& a, const Triangle& b, const LinearMotion& m);
[[nodiscard]] PairVerdict test_pair(const Triangle& a, const Obb& b, const LinearMotion& m);

[[nodiscard]] std::optional<PairContact> first_contact(const Triangle& a, const Triangle& b,
                                                       const LinearMotion& m);
[[nodiscard]] std::optional<PairContact> first_contact(const Obb& a, const Obb& b,
                                                       const LinearMotion& m);
[[nodiscard]] std::optional<PairContact> first_contact(const Obb& a, const Triangle& b,
                                                       const LinearMotion& m);
[[nodiscard]] std::optional<PairContact> first_contact(const Triangle& a, const Obb& b,
                                                       const LinearMotion& m);

} // namespace obb
