// Rigid motion at constant velocities: x(t) = K + t V + R(t W) (x(0) - K). Eberly 2008 §5, with the
// pivot that travels (with K fixed, as printed in §1, this is no solution of the paper's equation).
#pragma once

#include "numbers/double_double.hpp"
#include "numbers/vec.hpp"

namespace obb {

struct Screw {
    Vec3 linear_velocity{0, 0, 0};
    Vec3 angular_velocity{0, 0, 0};
    Vec3 pivot{0, 0, 0};

    friend bool operator==(const Screw&, const Screw&) = default;
};

// How far a body has turned.
struct Turn {
    double sine = 0, cosine = 1;
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

    // The rotation by `time`. As a map its matrix is off by at most kMatrixError, however many
    // turns that is: the angle is kept in twice the digits until sine and cosine are taken.
    [[nodiscard]] Turn turn(double time) const;
    [[nodiscard]] Mat3 matrix(const Turn& turn) const;

    // Sine and cosine are within 1 ulp (a test asks the platform's library) and lose another u to
    // what is left of the angle: 2 u each, 3 u for 1 - cos. In c 1 + s [k] + v k k^T that makes
    // 2 + 4 + 5 u with the products, and an axis that is off by 3 u another 15 u.
    static constexpr double kMatrixError = 28 * kUnitRoundoff;

  private:
    Vec3 velocity_{0, 0, 0};
    Vec3 axis_{0, 0, 0};
    DoubleDouble speed_{0, 0};
};

} // namespace obb
