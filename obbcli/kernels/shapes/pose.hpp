// Where a body stands: x = Q p + s, with Q taken literally.
#pragma once

#include "numbers/vec.hpp"
#include "shapes/triangle.hpp"

namespace obb {

struct Pose {
    Mat3 rotation = Mat3::identity();
    Vec3 translation{0, 0, 0};

    [[nodiscard]] bool is_identity() const { return *this == Pose{}; }
    friend bool operator==(const Pose&, const Pose&) = default;
};

// fl(fl(fl(Q0 p0 + Q1 p1) + Q2 p2) + s): the rounded result *is* the input of every question, so
// static verdicts are exact for it. An identity rounds nothing.
[[nodiscard]] inline Vec3 posed(const Pose& pose, Vec3 p) {
    return pose.rotation * p + pose.translation;
}
[[nodiscard]] inline Triangle posed(const Pose& pose, const Triangle& t) {
    return {posed(pose, t[0]), posed(pose, t[1]), posed(pose, t[2])};
}

} // namespace obb
