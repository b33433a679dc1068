// Rigid motion at constant velocities: x(t) = K + t V + R(t W) (x(0) - K). Eberly 2008 §5, with the
// pivot that travels (with K fixed, as printed in §1, this is no solution of the paper's equation).
#pragma once

#include "double_double.hpp"
#include "vec.hpp"

namespace obb {

struct Screw {
    Vec3 linear_velocity{0, 0, 0};
    Vec3 angular_velocity{0, 0, 0};
    Vec3 pivot{0, 0, 0};

    friend bool operator==(const Screw&, const Screw&) = default;
};

// The turning part of a motion.
class Spin {
  public:
    Spin() = default;
    explicit Spin(Vec3 angular_velocity);

    [[nodiscard]] bool is_still() const { return velocity_ == Vec3{0, 0, 0}; }
    [[nodiscard]] Vec3 velocity() const { return velocity_; }
    [[nodiscard]] Vec3 axis() const { return axis_; } // unit; zero where still
    [[nodiscard]] double speed() const { return speed_.high; }

    // The rotation matrix at `time`. As a map it is off by at most kMatrixError, however many turns
    // that is: the angle is kept in twice the digits until sine and cosine are taken.
    [[nodiscard]] Mat3 matrix(double time) const;

    // Sine and cosine are within 1 ulp (a test asks the platform's library), so each within 2 u;
    // the entries add three products of numbers up to 1 to that, and the axis is off by 4 u. The
    // sum is below 14 u an entry, 42 u for the matrix.
    static constexpr double kMatrixError = 48 * kUnitRoundoff;

  private:
    Vec3 velocity_{0, 0, 0};
    Vec3 axis_{0, 0, 0};
    DoubleDouble speed_{0, 0};
};

} // namespace obb
