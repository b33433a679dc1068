// How often does a closed posed surface wind around a point? Exactly, for one point at a time.
#pragma once

#include "overlap/solid_surface.hpp"

#include <cstdint>
#include <vector>

namespace obb {

struct Winding {
    std::int64_t number = 0;    // of no meaning on the surface
    bool is_on_surface = false; // the point lies on a triangle

    [[nodiscard]] bool is_inside() const { return !is_on_surface && number != 0; }
    [[nodiscard]] bool is_outside() const { return !is_on_surface && number == 0; }
};

class WindingSearch {
  public:
    // The surface must outlive it.
    explicit WindingSearch(const SolidSurface& surface) : surface_(&surface) {}

    // Of a point of the world, taken as the doubles are: for the posed vertices, rounded to double,
    // as ContainmentQuery counts. Edges must be run through as often in either direction.
    [[nodiscard]] Winding find(const Vec3& world);

    [[nodiscard]] const OverlapFrame& frame() const { return surface_->frame(); }
    [[nodiscard]] std::uint64_t rays() const { return rays_; }

  private:
    const SolidSurface* surface_;
    std::vector<NodeRef> stack_;
    std::uint64_t rays_ = 0;
};

} // namespace obb
