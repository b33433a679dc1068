// How far a point is from a surface: bounds that hold, and the triangle that is nearest.
#pragma once

#include "overlap/solid_surface.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace obb {

// Bounds on the distance of a point from a surface, in the frame's unit, for the point of the world
// as for the one of the frame, which to_frame() rounds. `high` is that of a point of the triangle,
// which `foot` is to rounding.
struct PointDistance {
    double low = 0;
    double high = std::numeric_limits<double>::infinity();
    NodeRef triangle{};
    Vec3 foot{0, 0, 0};
};

class NearestSearch {
  public:
    // The surface must outlive it.
    explicit NearestSearch(const SolidSurface& surface) : surface_(&surface) {}

    // Until `low` is at least (1 - slack) times `high`, up to rounding, or until `high` is below
    // `enough`: then `low` may be 0. Triangles to look at first make it faster: `hints`, found by
    // earlier searches of this surface.
    [[nodiscard]] PointDistance find(const Vec3& point, double slack,
                                     std::span<const NodeRef> hints, double enough = 0);
    // The same of the part of the surface under a node.
    [[nodiscard]] PointDistance find_under(const NodeRef& node, const Vec3& point, double slack);

    [[nodiscard]] std::uint64_t triangle_tests() const { return triangle_tests_; }

  private:
    struct Open {
        NodeRef ref;
        double low;
    };
    void begin(const Vec3& point, double slack);
    void descend(const NodeRef& from, double enough);
    void open_up(const NodeRef& ref);
    void measure_range(std::uint32_t begin, std::uint32_t end, std::uint32_t slot);
    void push(const NodeRef& ref);

    const SolidSurface* surface_;
    Vec3 point_{0, 0, 0};
    double slack_ = 0;
    double limit_ = 0; // what is at least this far away needs no closer look
    double low_ = 0;   // of all that was passed over and measured
    PointDistance best_;
    std::vector<Open> stack_;
    std::uint64_t triangle_tests_ = 0;
};

} // namespace obb
