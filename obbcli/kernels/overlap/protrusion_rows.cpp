// The rows of a protrusion query: where the bound is attained, what is near there says more.
#include "overlap/point_triangle.hpp"
#include "overlap/protrusion_query.hpp"
#include "overlap/unit_normal.hpp"
#include "shapes/extremes.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

ProtrusionQuery::Values ProtrusionQuery::values_of(const Row& row) const {
    Values values{};
    if (row.kind == Row::Kind::kTriangle) {
        distances_from(row.corners, corners_, values);
        return values;
    }
    for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] = row.kind == Row::Kind::kEscape
                        ? EscapeRow{row.up, row.high}.reach(corners_[k])
                        : CrossingRow{row.up, row.low, row.high}.reach(corners_[k]);
    }
    return values;
}

void ProtrusionQuery::add(const Row& row) {
    drop_idle(kRows - 1);
    std::uint32_t id = 0;
    if (free_rows_.empty()) {
        id = static_cast<std::uint32_t>(rows_.size());
        rows_.push_back(row);
    } else {
        id = free_rows_.back();
        free_rows_.pop_back();
        rows_[id] = row;
    }
    rows_[id].holders = 1;
    held_.push_back({id, 1, values_of(row)}); // not idle before it was tried
}

void ProtrusionQuery::hold(std::uint32_t id) { ++rows_[id].holders; }

void ProtrusionQuery::drop(std::uint32_t id) {
    if (--rows_[id].holders == 0) {
        free_rows_.push_back(id);
    }
}

void ProtrusionQuery::drop_idle(std::size_t most) {
    while (held_.size() > most) {
        const auto idle =
            std::min_element(held_.begin(), held_.end(),
                             [](const Held& x, const Held& y) { return x.weight < y.weight; });
        drop(idle->id);
        held_.erase(idle);
    }
}

// Looks at the candidate and adds the rows that it suggests; false where none is new.
bool ProtrusionQuery::add_rows() {
    const Vec3 asked = candidate();
    const Vec3 world = frame_.to_world(asked);
    const Vec3 point = frame_.to_frame(world);
    ++points_;
    hints_.clear();
    for (const Held& row : held_) {
        if (rows_[row.id].kind == Row::Kind::kTriangle) {
            hints_.push_back(rows_[row.id].triangle);
        }
    }
    const PointDistance near = nearest_.find(point, slack_, hints_);
    bool is_inside = true;
    if (inside_only_) {
        is_inside = look_inside(world, point, near.low);
        if (is_over_) {
            return false;
        }
    }
    if (cell_.place.is_box()) {
        try_surface(point);
    } else if (is_inside) {
        try_point(world, asked, near, a_.id(cell_.place.ref));
    }
    bool is_new = add_triangle(near);
    const Vec3 normal = unit_normal(b_.triangle(near.triangle));
    if (!inside_only_) {
        return add_way(normal, near.triangle) || is_new;
    }
    // Out is where the point is not, or where it is.
    const Vec3 way = is_inside ? near.foot - point : point - near.foot;
    const double along = dot(way, normal);
    constexpr double kTelling = 0.1;
    const double size = norm(way);
    if (std::fabs(along) > kTelling * size) {
        outward_ = along > 0 ? 1 : -1;
        is_new = add_way(outward_ * normal, near.triangle) || is_new;
    } else {
        is_new = add_way(outward_ * normal, near.triangle) ||
                 add_way(-outward_ * normal, near.triangle) || is_new;
    }
    const Vec3 own = own_normal();
    is_new = add_way(own, near.triangle) || is_new;
    return add_way(-own, near.triangle) || is_new;
}

// Whether the candidate is inside B. Where nothing of B's surface is in the cell, all of it is what
// the candidate is.
bool ProtrusionQuery::look_inside(const Vec3& world, const Vec3& point, double clear) {
    if (cell_.is_inside) {
        return true;
    }
    const Winding winding = windings_.find(world);
    double radius = 0;
    for (const Vec3& corner : corners_) {
        const double its = norm(corner - point);
        radius = its <= radius ? radius : its; // a NaN stays
    }
    if (clear > radius + 2 * kPieceError) {
        cell_.is_inside = winding.is_inside();
        is_over_ = winding.is_outside();
    } else if (winding.is_outside() && cell_.place.is_box()) {
        // The candidate is one of the box, which may be long.
        is_over_ = !boxes_.is_met(grown_box(a_, cell_.place), 2 * kPieceError);
    }
    return winding.is_inside();
}

// The point of the world is one of A's surface, but for rounding on its way and before: so far at
// most is the one that is asked about from one of the surface, which is inside B as it is. A foot
// is off by 12 u of at most 2 sqrt(3).
void ProtrusionQuery::try_point(const Vec3& world, const Vec3& asked, const PointDistance& near,
                                std::uint32_t triangle) {
    constexpr double kFootError = 64 * kUnitRoundoff;
    const double aside = norm(frame_.to_frame(world) - asked) + kFootError;
    if (const double depth = near.low - aside; depth > best_.depth) {
        best_ = {world, depth, triangle, b_.id(near.triangle)};
    }
}

// The candidate of a box is no point of A's surface: one near to it may be deep.
void ProtrusionQuery::try_surface(const Vec3& point) {
    constexpr double kRoughly = 0.25;
    const PointDistance foot = nearest_a_.find_under(cell_.place.ref, point, kRoughly);
    if (!(foot.high < HUGE_VAL)) {
        return; // the box of a damaged tree is no number
    }
    const Vec3 world = frame_.to_world(foot.foot);
    const PointDistance near = nearest_.find(frame_.to_frame(world), slack_, hints_, best_.depth);
    ++points_;
    if (near.low > best_.depth &&
        (!inside_only_ || cell_.is_inside || windings_.find(world).is_inside())) {
        try_point(world, foot.foot, near, a_.id(foot.triangle));
    }
}

bool ProtrusionQuery::add_triangle(const PointDistance& near) {
    for (const Held& held : held_) {
        const Row& row = rows_[held.id];
        if (row.kind == Row::Kind::kTriangle && row.triangle.begin == near.triangle.begin) {
            return false;
        }
    }
    Row row;
    row.triangle = near.triangle;
    row.corners = b_.triangle(near.triangle);
    add(row);
    return near.high < bound_;
}

// Where the surfaces lie along each other, B's way out is across A's.
Vec3 ProtrusionQuery::own_normal() const {
    if (!cell_.place.is_box()) {
        return unit_normal({corners_[0], corners_[1], corners_[2]});
    }
    Vec3 least = corners_[1] - corners_[0];
    for (const std::size_t k : {2U, 4U}) {
        if (const Vec3 edge = corners_[k] - corners_[0]; dot(edge, edge) < dot(least, least)) {
            least = edge;
        }
    }
    return unit_or(least, {0, 0, 0});
}

Vec3 ProtrusionQuery::side_for(const Vec3& up) const {
    Vec3 best{0, 0, 0};
    double least = HUGE_VAL;
    for (const std::size_t k : {1U, 2U, 4U}) {
        const Vec3 edge = corners_[k] - corners_[0];
        if (const double along = std::fabs(dot(unit_or(edge, up), up)); along < least) {
            least = along;
            best = edge;
        }
    }
    return best;
}

// Corners of what is left of the cell when it shrinks towards its middle, no point moving by more
// than `within`.
CellCorners ProtrusionQuery::core(double within) const {
    Vec3 middle{0, 0, 0};
    const std::size_t count = cell_.place.is_box() ? 8 : 3;
    for (std::size_t k = 0; k < count; ++k) {
        middle = middle + (1.0 / static_cast<double>(count)) * corners_[k];
    }
    double size = within;
    for (const Vec3& corner : corners_) {
        size = larger(size, norm(corner - middle));
    }
    CellCorners result = corners_;
    for (Vec3& corner : result) {
        corner = corner + (within / size) * (middle - corner);
    }
    return result;
}

// A way to B's surface along a direction: out of it, or across it where points need not be inside.
//
// The row is that of the cell's core, so that surfaces flush with the cell leave it be. Within
// `lost` of each point of the cell is one of the core; where that is not inside B, the point of the
// cell is no deeper than `lost`, and else distance and height differ by as much at most.
bool ProtrusionQuery::add_way(const Vec3& up, const NodeRef& triangle) {
    constexpr double kSame = 1 - 0x1p-40;
    if (up == Vec3{0, 0, 0}) {
        return false;
    }
    for (const Vec3& tried : tried_) {
        if (dot(tried, up) > kSame) {
            return false;
        }
    }
    tried_.push_back(up);
    const double gap = 0.5 * (bound_ - target());
    const double fine = larger(smaller(0.05 * bound_, gap), 0.5 * floor_);
    const double within = smaller(0.02 * fine, 0.25 * target()); // or more would be given up
    const double lost = within + 2 * kPieceError;
    const CellCorners corners = core(within);
    const RowEffort effort{.thin = 0.25 * fine, .useful = bound_};
    Row row;
    row.triangle = triangle;
    if (inside_only_) {
        const auto found = escapes_.find(corners, up, side_for(up), effort);
        if (!found) {
            return false;
        }
        row.kind = Row::Kind::kEscape;
        row.up = found->up;
        row.high = found->height + 2 * lost;
    } else {
        const auto found = escapes_.find_crossing(corners, up, side_for(up), effort);
        if (!found) {
            return false;
        }
        row.kind = Row::Kind::kCrossing;
        row.up = found->up;
        row.low = found->low - 2 * lost;
        row.high = found->high + 2 * lost;
    }
    give_up(lost);
    add(row);
    return true;
}

} // namespace obb
