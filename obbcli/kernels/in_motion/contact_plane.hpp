// The plane between two bodies that touch after a translation. A part of A on A's side of the plane
// and a part of B on B's side, each where it is at t = 0, touch no earlier than the bodies do.
#pragma once

#include "numbers/vec.hpp"
#include "primitives/pair_query.hpp"

#include <cstdint>
#include <optional>

namespace obb {

// Its normal is exact: the product of two differences of points, or one difference.
class ContactPlane {
  public:
    // Along the axis that separated two triangles until they touched; nothing where that has
    // degenerate triangles.
    [[nodiscard]] static std::optional<ContactPlane>
    of_axis(const Triangle& a, const Triangle& b, const LinearMotion& motion, const Touch& touch);
    // Across the motion, through two vertices that meet; nothing where other features do.
    [[nodiscard]] static std::optional<ContactPlane>
    of_motion(const Triangle& a, const Triangle& b, const LinearMotion& motion, const Touch& touch);

    // Whether a vertex of A, or of B, is on its own side or in the plane: exactly.
    [[nodiscard]] bool holds_a(const Vec3& point) const { return sign(a_, point) <= 0; }
    [[nodiscard]] bool holds_b(const Vec3& point) const { return sign(b_, point) >= 0; }

    // About the normal, from A to B, of length 1; zeros where doubles cannot tell.
    [[nodiscard]] Vec3 normal() const;

  private:
    struct Difference {
        Vec3 from, to;
        [[nodiscard]] Vec3 rounded() const { return to - from; }
    };

    ContactPlane(const Difference& u, const std::optional<Difference>& v, const Vec3& a,
                 const Vec3& b);
    [[nodiscard]] static std::optional<ContactPlane> facing(ContactPlane plane,
                                                            const LinearMotion& motion);
    [[nodiscard]] int sign(const Vec3& from, const Vec3& to) const;
    [[nodiscard]] int exact_sign(const Difference& w) const;

    Difference u_;
    std::optional<Difference> v_;
    Vec3 a_, b_;        // in the plane, as far as it has come
    Vec3 n_{0, 0, 0};   // rounded
    double sizes_ = 0;  // bounds what rounding may have lost of it
    int direction_ = 1; // of the normal, so that it points from A to B
};

} // namespace obb
