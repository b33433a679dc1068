// The rows of a thickness query: where the bound is attained, what is near there says more.
#include "overlap/thickness_query.hpp"
#include "overlap/unit_normal.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

// How a plane rises across a direction, in which it may stand on end.
[[nodiscard]] Vec3 slope_of(const Vec3& normal, const Vec3& up) {
    constexpr double kSteepest = 8;
    const double rise = dot(normal, up);
    const Vec3 across = rise * up - normal;
    return (1 / std::max(std::fabs(rise), norm(across) / kSteepest + 0x1p-100)) * across;
}

} // namespace

// Takes over the hold on a row that the caller has.
void ThicknessQuery::hold(std::uint32_t id) {
    const BoundRow& row = rows_[id];
    Held held{id, 0, {}, {}};
    if (!row.is_escape) {
        held.triangle = surfaces_[row.body].triangle(row.triangle);
    }
    held_.push_back(held);
}

void ThicknessQuery::add(const BoundRow& row) {
    if (held_.size() >= kRows) {
        drop_idle(kRows - 1);
    }
    hold(rows_.add(row));
    held_.back().weight = 1; // not idle before it was tried
    row.values(corners_, held_.back().triangle, held_.back().values);
}

// Where the bound is about attained.
Vec3 ThicknessQuery::candidate() const {
    if (held_.empty()) {
        return box_.at(box_.middle());
    }
    Vec3 p{0, 0, 0};
    for (std::size_t k = 0; k < corners_.size(); ++k) {
        p = p + game_.corner_weights()[k] * corners_[k];
    }
    return p;
}

// Looks at the candidate and adds the rows that it suggests; false where none is new.
bool ThicknessQuery::add_rows() {
    constexpr double kHeavy = 0.1;
    const Vec3 world = frame_.to_world(candidate());
    point_ = frame_.to_frame(world);
    ++points_;
    lowest_ = HUGE_VAL;
    std::array<PointDistance, 2> near;
    for (std::size_t body = 0; body < 2; ++body) {
        hints_.clear();
        for (const Held& held : held_) {
            if (rows_[held.id].body == body) {
                hints_.push_back(rows_[held.id].triangle);
            }
        }
        near[body] = probes_[body].nearest.find(point_, slack_, hints_);
    }
    try_point(world, near);
    bool is_new = false;
    ways_.clear();
    for (std::size_t body = 0; body < 2; ++body) {
        // From within, a surface further away than the bound has no say.
        if ((inside_ >> body & 1U) == 0 || near[body].low < bound_) {
            is_new = add_triangle(body, near[body]) || is_new;
            ways_.push_back({body, probes_[body].outward *
                                       unit_normal(surfaces_[body].triangle(near[body].triangle))});
        }
    }
    // Where one surface lies along the other, what bounds the one tells where to look for the
    // other.
    for (const Held& held : held_) {
        if (held.weight >= kHeavy) {
            const BoundRow& row = rows_[held.id];
            const double out = row.is_escape ? 1 : probes_[row.body].outward;
            ways_.push_back({row.body, out * row.normal});
            ways_.push_back({1U - row.body, -out * row.normal});
        }
    }
    const double least = target();
    for (const Way& way : ways_) {
        if (lowest_ <= least) {
            break; // enough for this point
        }
        is_new = add_escape(way.body, way.up, near[way.body].triangle) || is_new;
        if (!probes_[way.body].is_oriented || cells_ % kDoubtful == 0) {
            is_new = add_escape(way.body, -way.up, near[way.body].triangle) || is_new;
        }
    }
    return is_new;
}

void ThicknessQuery::try_point(const Vec3& world, const std::array<PointDistance, 2>& near) {
    const double radius = std::min(near[0].low, near[1].low);
    if (radius > best_.radius && probes_[0].windings.find(world).is_inside() &&
        probes_[1].windings.find(world).is_inside()) {
        best_ = {world, radius, surfaces_[0].id(near[0].triangle),
                 surfaces_[1].id(near[1].triangle)};
    }
}

bool ThicknessQuery::add_triangle(std::size_t body, const PointDistance& near) {
    for (const Held& held : held_) {
        const BoundRow& row = rows_[held.id];
        if (!row.is_escape && row.body == body && row.triangle.begin == near.triangle.begin) {
            return false;
        }
    }
    BoundRow row;
    row.triangle = near.triangle;
    row.body = static_cast<std::uint8_t>(body);
    row.normal = unit_normal(surfaces_[body].triangle(near.triangle));
    add(row);
    return near.high < bound_;
}

// An escape row along a direction of length 1; true where it lowers the bound at the candidate.
bool ThicknessQuery::add_escape(std::size_t body, const Vec3& up, const NodeRef& triangle) {
    constexpr double kSame = 1 - 0x1p-40;
    for (const Way& tried : tried_) {
        if (tried.body == body && dot(tried.up, up) > kSame) {
            return false;
        }
    }
    tried_.push_back({body, up});
    SolidProbe& probe = probes_[body];
    const double gap = 0.5 * (bound_ - target());
    const double fine = std::max(std::min(tolerance_ * target(), gap), 0.5 * floor_);
    // The row is that of the cell's core, which holds a point within sqrt(3) times `within` of each
    // point of the cell: surfaces that are flush with the cell leave it be. Whoever is no deeper
    // than that is of no interest; else the point of the core is in the solid as well, and both
    // depth and height differ by that much at most.
    const double within = 0.02 * fine;
    const double lost = kDiagonal * (within + kCellPad);
    const CellBox::Corners corners = box_.corners(-within);
    double top = -HUGE_VAL;
    for (const Vec3& corner : corners) {
        top = std::max(top, dot(up, corner));
    }
    const RowEffort effort{.thin = 0.1 * fine,
                           .useful = std::max(bound_ + dot(up, point_) - top, 0.0)};
    const auto found = probe.escapes.find(corners, up, side_for(up), effort);
    if (!found) {
        return false;
    }
    probe.outward = dot(unit_normal(surfaces_[body].triangle(triangle)), up) < 0 ? -1 : 1;
    probe.is_oriented = true;
    bool is_lower = true; // than the same row of a larger cell
    BoundRow row;
    row.normal = found->up;
    row.height = found->height + 2 * lost;
    for (std::size_t k = 0; k < held_.size(); ++k) {
        const BoundRow& other = rows_[held_[k].id];
        if (other.is_escape && other.body == body && dot(other.normal, found->up) > kSame) {
            // The slope is of use even where the height is that of the larger cell. That height
            // holds along its own direction only, of which this one may differ by 1e-6.
            is_lower = row.height < other.height;
            if (!is_lower) {
                row.normal = other.normal;
                row.height = other.height;
            }
            rows_.drop(held_[k].id);
            held_.erase(held_.begin() + static_cast<std::ptrdiff_t>(k));
            break;
        }
    }
    row.triangle = triangle;
    row.body = static_cast<std::uint8_t>(body);
    row.is_escape = true;
    row.slope =
        slope_of(unit_normal(surfaces_[body].triangle(probe.escapes.under(*found))), found->up);
    given_up_ = std::max(given_up_, lost);
    add(row);
    const double value = row.height - dot(row.normal, point_);
    lowest_ = std::min(lowest_, value);
    return is_lower && value < bound_;
}

} // namespace obb
