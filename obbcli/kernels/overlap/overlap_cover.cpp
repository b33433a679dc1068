#include "overlap/overlap_cover.hpp"

#include "overlap/common_box.hpp"
#include "shapes/extremes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obb {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Triangles are within kPlaceError of the posed ones in a frame where no coordinate exceeds 1;
// coordinates along axes and directions about 1 long, and corners of clipped polygons, are off by
// some ten units of roundoff more. What is proven of a box holds this far beyond.
constexpr double kPad = 256 * kUnitRoundoff;

// The largest product of a direction with any corner.
[[nodiscard]] double end_along(const auto& patches, const Vec3& direction) {
    double end = -kInfinity;
    for (const auto& patch : patches) {
        for (std::size_t i = 0; i < patch.count; ++i) {
            end = larger(end, dot(direction, patch.corners[i]));
        }
    }
    return end;
}

} // namespace

OverlapCover::OverlapCover(const SolidSurface& a, const SolidSurface& b, double size)
    : axes_(CellBox{}.axes),
      probes_{Probe{&a, BoxSearch(a), WindingSearch(a)}, Probe{&b, BoxSearch(b), WindingSearch(b)}},
      size_(std::max(size, 64 * kPad)) {
    if (const std::optional<CellBox> box = common_box(a, b)) {
        axes_ = box->axes;
        stack_.push_back({box->low, box->high, 0});
    }
}

bool OverlapCover::look_at_one() {
    if (stack_.empty()) {
        return false;
    }
    Cell cell = stack_.back();
    stack_.pop_back();
    if (is_outside(cell)) {
        return true;
    }
    const bool is_inside_both = cell.inside == 3;
    if (!is_inside_both) {
        for (std::size_t body = 0; body < 2; ++body) {
            if ((cell.inside >> body & 1U) == 0 && probes_[body].are_all &&
                cut_down(cell, probes_[body])) {
                return true;
            }
        }
        if (cell.inside == 0 && are_parted(cell)) {
            return true;
        }
    }
    const Vec3 width = cell.high - cell.low;
    const std::size_t axis =
        width.x >= width.y && width.x >= width.z ? 0 : (width.y >= width.z ? 1 : 2);
    if (is_inside_both || width[axis] <= size_) {
        kept_.push_back(cell);
    } else {
        split(cell, axis);
    }
    return true;
}

// Whether no triangle of a solid meets the cell, which lies outside of it. Elsewhere its triangles
// there are at hand.
bool OverlapCover::is_outside(Cell& cell) {
    const Obb box = box_of(cell).obb();
    for (std::size_t body = 0; body < 2; ++body) {
        if ((cell.inside >> body & 1U) != 0) {
            continue;
        }
        Probe& probe = probes_[body];
        find_patches(cell, probe);
        if (!probe.are_all || !probe.patches.empty()) {
            continue;
        }
        const Vec3& half = box.half_extents;
        const double room = smallest(half.x, half.y, half.z);
        const Place place = place_of(probe, 0.5 * (cell.low + cell.high), room);
        if (place == Place::kOutside) {
            return true;
        }
        cell.inside |= static_cast<std::uint8_t>(place == Place::kInside ? 1U << body : 0U);
    }
    return false;
}

void OverlapCover::find_patches(const Cell& cell, Probe& probe) {
    constexpr std::size_t kMost = 24;
    probe.found.clear();
    probe.patches.clear();
    probe.are_all = probe.boxes.find(box_of(cell).obb(), kPad, kMost, probe.found);
    if (!probe.are_all) {
        return;
    }
    for (const NodeRef& ref : probe.found) {
        const Patch patch = clipped(probe.surface->triangle(ref), cell);
        if (patch.count > 0) {
            probe.patches.push_back(patch);
        }
    }
}

// Sutherland and Hodgman 1974, by the sides of the cell, padded.
OverlapCover::Patch OverlapCover::clipped(const Triangle& triangle, const Cell& cell) const {
    const CellBox box = box_of(cell);
    Patch patch;
    patch.count = 3;
    for (std::size_t i = 0; i < 3; ++i) {
        patch.corners[i] = box.local(triangle[i]);
    }
    patch.normal = cross(patch.corners[1] - patch.corners[0], patch.corners[2] - patch.corners[0]);
    for (std::size_t side = 0; side < 6 && patch.count > 0; ++side) {
        const std::size_t k = side / 2;
        const auto height = [&](const Vec3& p) {
            return side % 2 == 0 ? p[k] - (cell.low[k] - kPad) : (cell.high[k] + kPad) - p[k];
        };
        Patch cut;
        cut.normal = patch.normal;
        bool has_room = true;
        const auto push = [&](const Vec3& p) {
            has_room = has_room && cut.count < Patch::kMost;
            if (has_room) {
                cut.corners[cut.count++] = p;
            }
        };
        for (std::size_t i = 0, j = patch.count - 1; i < patch.count; j = i++) {
            const Vec3 p = patch.corners[j], q = patch.corners[i];
            const double from = height(p), to = height(q);
            if ((from >= 0) != (to >= 0)) {
                push(p + (from / (from - to)) * (q - p));
            }
            if (to >= 0) {
                push(q);
            }
        }
        if (!has_room) {
            return patch; // with more of the triangle than is in the cell
        }
        patch = cut;
    }
    return patch;
}

// Where a point is that may move by `room` without passing through the surface.
OverlapCover::Place OverlapCover::place_of(Probe& probe, const Vec3& local, double room) {
    const OverlapFrame& frame = probe.surface->frame();
    const Vec3 point = CellBox{axes_, {}, {}}.at(local);
    const Vec3 world = frame.to_world(point);
    if (!(norm(frame.to_frame(world) - point) + kPad <= 0.5 * room)) {
        return Place::kUnknown;
    }
    const Winding winding = probe.windings.find(world);
    return winding.is_outside()  ? Place::kOutside
           : winding.is_inside() ? Place::kInside
                                 : Place::kUnknown;
}

// Cuts off what lies beyond all triangles of a body along an axis, and outside; true where nothing
// is left.
bool OverlapCover::cut_down(Cell& cell, Probe& probe) {
    for (std::size_t k = 0; k < 3; ++k) {
        for (const bool is_upper : {false, true}) {
            Vec3 direction{0, 0, 0};
            direction[k] = is_upper ? 1 : -1;
            const double side = is_upper ? cell.high[k] : -cell.low[k];
            const double bottom = std::max(end_along(probe.patches, direction) + kPad,
                                           is_upper ? cell.low[k] : -cell.high[k]);
            const double room = side - bottom;
            if (!(room > 16 * kPad)) {
                continue;
            }
            Vec3 middle = 0.5 * (cell.low + cell.high);
            middle[k] = (is_upper ? 1 : -1) * (bottom + 0.5 * room);
            const Vec3 width = cell.high - cell.low;
            const double least = std::min({room, width[(k + 1) % 3], width[(k + 2) % 3]});
            if (place_of(probe, middle, 0.5 * least) == Place::kOutside) {
                (is_upper ? cell.high[k] : cell.low[k]) = (is_upper ? 1 : -1) * bottom;
                if (!(cell.low[k] < cell.high[k])) {
                    return true;
                }
            }
        }
    }
    return false;
}

// Whether along the normal of a triangle there all of A comes before all of B, or the other way.
bool OverlapCover::are_parted(const Cell& cell) {
    constexpr std::size_t kTries = 6;
    for (const Probe& probe : probes_) {
        if (!probe.are_all) {
            return false;
        }
    }
    for (const Probe& probe : probes_) {
        for (std::size_t i = 0; i < std::min(kTries, probe.patches.size()); ++i) {
            const Vec3 normal = unit_or(probe.patches[i].normal, {0, 0, 0});
            if (normal == Vec3{0, 0, 0}) {
                continue;
            }
            if (are_parted_along(cell, normal) || are_parted_along(cell, -normal)) {
                return true;
            }
        }
    }
    return false;
}

bool OverlapCover::are_parted_along(const Cell& cell, const Vec3& direction) {
    const double end_a = end_along(probes_[0].patches, direction) + kPad;
    const double start_b = -(end_along(probes_[1].patches, -direction) + kPad);
    return end_a < start_b && ends_at(cell, probes_[0], direction, end_a) &&
           ends_at(cell, probes_[1], -direction, -start_b);
}

// Whether a solid reaches no further than `end` along a direction, beyond which it has no triangle.
bool OverlapCover::ends_at(const Cell& cell, Probe& probe, const Vec3& direction, double end) {
    const Vec3 corner{direction.x > 0 ? cell.high.x : cell.low.x,
                      direction.y > 0 ? cell.high.y : cell.low.y,
                      direction.z > 0 ? cell.high.z : cell.low.z};
    const Vec3 middle = 0.5 * (cell.low + cell.high);
    const double top = dot(direction, corner), rise = top - dot(direction, middle);
    if (!(top > end)) {
        return true; // nothing of the cell is beyond
    }
    if (!(rise > 0)) {
        return false;
    }
    // On the way from the corner to the middle, half as far as it is beyond.
    const double share = std::min(0.5 * (top - end) / rise, 0.5);
    const Vec3 point = corner + share * (middle - corner);
    const Vec3 half = 0.5 * (cell.high - cell.low);
    const double room =
        std::min({0.5 * (top - end), share * half.x, share * half.y, share * half.z});
    return place_of(probe, point, room) == Place::kOutside;
}

void OverlapCover::split(const Cell& cell, std::size_t axis) {
    const double middle = 0.5 * (cell.low[axis] + cell.high[axis]);
    Cell lower = cell, upper = cell;
    lower.high[axis] = middle;
    upper.low[axis] = middle;
    stack_.push_back(upper);
    stack_.push_back(lower);
}

} // namespace obb
