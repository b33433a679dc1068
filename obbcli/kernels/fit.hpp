// Orientation of a box from the spread of what it holds. Eberly 2008 §6.1.2, §6.1.3.
#pragma once

#include "triangle.hpp"
#include "vec.hpp"

#include <array>

namespace obb {

enum class Fit { kTriangles, kPoints, kHull, kMinVolume, kAxisAligned };

// Whether boxes are oriented by sums over their triangles; else by the hull, or not at all.
[[nodiscard]] constexpr bool fits_by_moments(Fit fit) {
    return fit == Fit::kTriangles || fit == Fit::kPoints;
}

// Sums over triangles from which mean and covariance follow; taken about a reference point near
// them, or the differences would cancel.
class Moments {
  public:
    // Adds a triangle given relative to the reference point: by area for Fit::kTriangles, by
    // corners for Fit::kPoints.
    void add(const Triangle& t, Fit fit);

    // Adds the corners with equal weight, whatever the area: for sets of no area at all.
    void add_corners(const Triangle& t);

    [[nodiscard]] bool is_empty() const { return !(weight_ > 0); }

    // Orthonormal rows, the eigenvectors of the covariance matrix; right-handed.
    [[nodiscard]] std::array<Vec3, 3> principal_axes() const;

  private:
    void add_weighted(const Triangle& t, double weight, double corner_share, double sum_share);

    double weight_ = 0;
    Vec3 first_{0, 0, 0};
    std::array<double, 6> second_{}; // xx, xy, xz, yy, yz, zz
};

// Quaternion (w, x, y, z) in float32 of right-handed orthonormal rows.
[[nodiscard]] std::array<float, 4> quaternion_of(const std::array<Vec3, 3>& axes);

} // namespace obb
