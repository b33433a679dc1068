// Which triangles of a surface meet a box? None is missed; some that only nearly meet it may be
// among them.
#pragma once

#include "overlap/solid_surface.hpp"

#include <cstddef>
#include <vector>

namespace obb {

// Whether a triangle of the frame may meet a box that is padded by `pad` along its axes. The box
// need not have orthonormal axes to more than about 1e-8; what that and rounding lose is added.
[[nodiscard]] bool may_meet(const Obb& box, const Triangle& triangle, double pad);

class BoxSearch {
  public:
    // The surface must outlive it.
    explicit BoxSearch(const SolidSurface& surface) : surface_(&surface) {}

    // Appends the triangles that may meet the box, of the frame's coordinates, grown by `pad`.
    // False, with as many as were found, when there are more than `most`.
    [[nodiscard]] bool find(const Obb& box, double pad, std::size_t most,
                            std::vector<NodeRef>& found);
    // Whether any does.
    [[nodiscard]] bool is_met(const Obb& box, double pad);

  private:
    const SolidSurface* surface_;
    std::vector<NodeRef> stack_;
    std::vector<NodeRef> one_;
};

} // namespace obb
