// Small convex polygons in space: the faces, edges and vertices in which shapes meet.
#pragma once

#include "numbers/vec.hpp"

#include <array>
#include <cstddef>

namespace obb {

// One vertex is a point, two are a segment, more are a face in cyclic order. A face of four
// corners clipped by another has at most eight.
class ConvexPolygon {
  public:
    void add(const Vec3& vertex) { vertices_[count_++] = vertex; }
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] const Vec3& operator[](std::size_t k) const { return vertices_[k]; }
    [[nodiscard]] Vec3 middle() const;

    // The part with dot(normal, x) >= offset, which may be empty.
    [[nodiscard]] ConvexPolygon clipped(const Vec3& normal, double offset) const;

  private:
    std::array<Vec3, 12> vertices_{};
    std::size_t count_ = 0;
};

// The middle of what two polygons that meet have in common, within rounding of both: where rounding
// has parted them, it is between their closest points. All coordinates must be below one.
[[nodiscard]] Vec3 middle_of_common(const ConvexPolygon& a, const ConvexPolygon& b);

} // namespace obb
