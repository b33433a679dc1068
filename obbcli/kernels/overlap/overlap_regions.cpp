#include "overlap/overlap_regions.hpp"

#include "work/slice.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace obb {

namespace {

[[nodiscard]] bool touch(const CellBox& a, const CellBox& b) {
    bool is_touching = true;
    for (std::size_t k = 0; k < 3; ++k) {
        is_touching = is_touching && a.low[k] <= b.high[k] && b.low[k] <= a.high[k];
    }
    return is_touching;
}

[[nodiscard]] std::size_t longest_axis(const CellBox& box) {
    const Vec3 width = box.width();
    return width.x >= width.y && width.x >= width.z ? 0 : (width.y >= width.z ? 1 : 2);
}

void include(CellBox& box, const CellBox& more) {
    for (std::size_t k = 0; k < 3; ++k) {
        box.low[k] = std::min(box.low[k], more.low[k]);
        box.high[k] = std::max(box.high[k], more.high[k]);
    }
}

// Sets of cells, each known by one of them.
class Sets {
  public:
    explicit Sets(std::size_t count) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), 0U);
    }
    [[nodiscard]] std::uint32_t of(std::uint32_t cell) {
        while (parents_[cell] != cell) {
            parents_[cell] = parents_[parents_[cell]];
            cell = parents_[cell];
        }
        return cell;
    }
    void join(std::uint32_t a, std::uint32_t b) { parents_[of(a)] = of(b); }

  private:
    std::vector<std::uint32_t> parents_;
};

} // namespace

OverlapRegions::OverlapRegions(const TreeView& a, const Pose& pose_a, const TreeView& b,
                               const Pose& pose_b, const RegionOptions& options)
    : a_(a), b_(b), pose_a_(pose_a), pose_b_(pose_b), options_(options),
      frame_(overlap_frame(a, pose_a, b, pose_b)), surface_a_(a, pose_a, frame_),
      surface_b_(b, pose_b, frame_),
      cover_(surface_a_, surface_b_, std::ldexp(options.resolution, -frame_.exponent)) {}

std::uint64_t OverlapRegions::cells() const {
    return cover_cells_ + thickness_cells_ + (thickness_ ? thickness_->cells() : 0);
}

bool OverlapRegions::advance(std::uint64_t max_cells) {
    SliceClock clock;
    while (!is_connected_) {
        if (max_cells == 0 || clock.is_over()) {
            return false;
        }
        const bool is_at_limit = cover_cells_ >= options_.max_cells;
        if (is_at_limit || !cover_.look_at_one()) {
            is_complete_ = cover_.waiting().empty();
            connect();
            break;
        }
        ++cover_cells_;
        --max_cells;
    }
    while (next_ < components_.size()) {
        if (max_cells == 0 || clock.is_over()) {
            return false;
        }
        if (!thickness_) {
            begin_thickness();
        }
        const std::uint64_t before = thickness_->cells();
        const bool is_done = thickness_->advance(std::min<std::uint64_t>(max_cells, 256));
        max_cells -= std::min(max_cells, std::max<std::uint64_t>(thickness_->cells() - before, 1));
        if (is_done) {
            end_thickness();
        }
    }
    std::sort(regions_.begin(), regions_.end(), [](const OverlapRegion& p, const OverlapRegion& q) {
        return p.thin != q.thin ? p.thin > q.thin : p.low[0] < q.low[0];
    });
    return true;
}

// Cells that touch are of one component: those that are next to each other along the longest axis
// are compared.
std::vector<std::uint32_t> OverlapRegions::components_of(const std::vector<CellBox>& cells) const {
    Sets sets(cells.size());
    CellBox all = cells.front();
    for (const CellBox& cell : cells) {
        include(all, cell);
    }
    const std::size_t axis = longest_axis(all);
    std::vector<std::uint32_t> order(cells.size()), open;
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t p, std::uint32_t q) {
        return cells[p].low[axis] < cells[q].low[axis];
    });
    for (const std::uint32_t next : order) {
        std::erase_if(open, [&](std::uint32_t other) {
            return cells[other].high[axis] < cells[next].low[axis];
        });
        for (const std::uint32_t other : open) {
            if (touch(cells[other], cells[next])) {
                sets.join(other, next);
            }
        }
        open.push_back(next);
    }
    for (std::uint32_t k = 0; k < order.size(); ++k) {
        order[k] = sets.of(k);
    }
    return order;
}

void OverlapRegions::connect() {
    is_connected_ = true;
    std::vector<CellBox> cells;
    for (const auto* some : {&cover_.kept(), &cover_.waiting()}) {
        for (const OverlapCover::Cell& cell : *some) {
            cells.push_back({cover_.axes(), cell.low, cell.high});
        }
    }
    if (cells.empty()) {
        return;
    }
    const std::vector<std::uint32_t> sets = components_of(cells);
    std::vector<std::size_t> places(cells.size(), cells.size());
    for (std::size_t k = 0; k < cells.size(); ++k) {
        std::size_t& place = places[sets[k]];
        if (place == cells.size()) {
            place = components_.size();
            components_.push_back({{}, cells[k]});
        }
        components_[place].cells.push_back(cells[k]);
        include(components_[place].box, cells[k]);
    }
}

// Boxes that hold some cells of a component and touch no other component, as few as come by halving
// them; where others are near, the cells themselves.
void OverlapRegions::add_boxes(std::span<CellBox> cells, std::vector<CellBox>& boxes) const {
    constexpr std::size_t kFew = 4;
    CellBox all = cells.front();
    for (const CellBox& cell : cells) {
        include(all, cell);
    }
    bool is_alone = true;
    for (std::size_t k = 0; k < components_.size() && is_alone; ++k) {
        is_alone = k == next_ || !touch(components_[k].box, all);
    }
    if (is_alone) {
        boxes.push_back(all);
        return;
    }
    if (cells.size() <= kFew) {
        boxes.insert(boxes.end(), cells.begin(), cells.end());
        return;
    }
    const std::size_t axis = longest_axis(all);
    const std::size_t half = cells.size() / 2;
    std::nth_element(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(half), cells.end(),
                     [&](const CellBox& p, const CellBox& q) { return p.low[axis] < q.low[axis]; });
    add_boxes(cells.first(half), boxes);
    add_boxes(cells.subspan(half), boxes);
}

void OverlapRegions::begin_thickness() {
    ThicknessOptions options{.tolerance = options_.tolerance,
                             .deeper_than = {},
                             .floor = options_.floor,
                             .max_cells = options_.max_cells / 10,
                             .within = {}};
    add_boxes(components_[next_].cells, options.within);
    thickness_ = std::make_unique<ThicknessQuery>(a_, pose_a_, b_, pose_b_, options);
}

void OverlapRegions::end_thickness() {
    const DeepPoint deepest = thickness_->deepest();
    if (deepest.radius > 0) {
        OverlapRegion region{{}, {}, deepest, thickness_->low(), thickness_->high()};
        bool is_first = true;
        for (const Vec3& corner : components_[next_].box.corners(kCellPad)) {
            const Vec3 world = frame_.to_world(corner);
            for (std::size_t k = 0; k < 3; ++k) {
                // A rounding of the move to the world, of which a coordinate may be the size.
                const double more =
                    4 * kUnitRoundoff * std::fabs(world[k]) + std::ldexp(kCellPad, frame_.exponent);
                region.low[k] =
                    is_first ? world[k] - more : std::min(region.low[k], world[k] - more);
                region.high[k] =
                    is_first ? world[k] + more : std::max(region.high[k], world[k] + more);
            }
            is_first = false;
        }
        regions_.push_back(region);
    } else {
        ++unproven_;
    }
    thickness_cells_ += thickness_->cells();
    thickness_.reset();
    ++next_;
}

} // namespace obb
