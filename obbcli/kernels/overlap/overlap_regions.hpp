// The parts of the space that two closed solids share.
#pragma once

#include "overlap/overlap_cover.hpp"
#include "overlap/overlap_frame.hpp"
#include "overlap/solid_surface.hpp"
#include "overlap/thickness_query.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace obb {

// A part: what two solids share within some boxes that touch no others.
struct OverlapRegion {
    Vec3 low, high;     // a box of the world that holds it
    DeepPoint deepest;  // the centre of a ball in it
    double thin, thick; // proven: its largest ball's diameter is between these
};

struct RegionOptions {
    double resolution = 0;             // of the boxes, mesh units
    double tolerance = 0.01;           // asked of thicknesses, relative
    double floor = 0;                  // a bracket of this width will do, mesh units
    std::uint64_t max_cells = 200'000; // of the cover, and of each region's thickness a tenth
};

// First a cover of boxes no longer than the resolution; boxes that touch are one component. What
// lies in different components is proven apart. That what lies in one is connected is not: parts
// that are about as near to each other as the resolution may be told as one. Then the thickness of
// each: a component without a point that is proven to lie in both solids is no region, but counted.
class OverlapRegions {
  public:
    // The trees must outlive it and be closed. Throws std::domain_error where posed coordinates
    // would leave the range of double.
    OverlapRegions(const TreeView& a, const Pose& pose_a, const TreeView& b, const Pose& pose_b,
                   const RegionOptions& options);
    OverlapRegions(const OverlapRegions&) = delete; // it points into itself
    OverlapRegions& operator=(const OverlapRegions&) = delete;

    // Looks at no more than so many boxes; true when nothing is left to do. Where slices end makes
    // no difference.
    bool advance(std::uint64_t max_cells);

    // Thickest first. While there is work to do, those found so far.
    [[nodiscard]] const std::vector<OverlapRegion>& regions() const { return regions_; }
    // Components without a proven point.
    [[nodiscard]] std::size_t unproven() const { return unproven_; }
    // False where the limit was met: the boxes are then larger than asked, and all they hold is
    // still told.
    [[nodiscard]] bool is_complete() const { return is_complete_; }
    [[nodiscard]] std::uint64_t cells() const;

  private:
    struct Component {
        std::vector<CellBox> cells;
        CellBox box; // that holds all of them
    };

    void connect();
    [[nodiscard]] std::vector<std::uint32_t> components_of(const std::vector<CellBox>& cells) const;
    void add_boxes(std::span<CellBox> cells, std::vector<CellBox>& boxes) const;
    void begin_thickness();
    void end_thickness();

    TreeView a_, b_;
    Pose pose_a_, pose_b_;
    RegionOptions options_;
    OverlapFrame frame_;
    SolidSurface surface_a_, surface_b_;
    OverlapCover cover_;
    std::uint64_t cover_cells_ = 0, thickness_cells_ = 0;
    bool is_connected_ = false;
    std::vector<Component> components_;
    std::size_t next_ = 0; // component
    std::unique_ptr<ThicknessQuery> thickness_;
    std::vector<OverlapRegion> regions_;
    std::size_t unproven_ = 0;
    bool is_complete_ = true;
};

} // namespace obb
