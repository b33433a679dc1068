// The boxes of a thickness query: what is cut off, in which frame, and along which axis they are
// halved.
#include "overlap/thickness_query.hpp"

#include "overlap/point_triangle.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

// An axis of the cell that is not along a direction.
Vec3 ThicknessQuery::side_for(const Vec3& up) const {
    std::size_t least = 0;
    for (std::size_t j = 1; j < 3; ++j) {
        least = std::fabs(dot(box_.axes[j], up)) < std::fabs(dot(box_.axes[least], up)) ? j : least;
    }
    return box_.axes[least];
}

// The box, in the axes given, of what escape rows leave of the cell: points where one is below the
// target lie no deeper than that. None where nothing is left.
//
// Each end is the bound of a game of its own: with the coordinate for a row and what rows exceed
// the target by for demands. Along axes of another frame a product is off by 4 u from the local
// coordinate, as those are orthonormal to a few u.
std::optional<CellBox> ThicknessQuery::cut_box(const std::array<Vec3, 3>& axes, bool is_same) {
    CellBox result{axes, box_.low, box_.high};
    const double least = target();
    demands_.clear();
    for (const Held& held : held_) {
        if (rows_[held.id].is_escape) {
            MatrixGame::Values excess = held.values;
            bool is_cutting = false;
            for (double& value : excess) {
                value -= least;
                is_cutting = is_cutting || value < 0;
            }
            if (is_cutting) {
                demands_.push_back(excess);
            }
        }
    }
    if (demands_.empty() && is_same) {
        return result;
    }
    for (std::size_t j = 0; j < 3; ++j) {
        for (const double sign : {-1.0, 1.0}) {
            MatrixGame::Values places;
            for (std::size_t k = 0; k < places.size(); ++k) {
                places[k] = sign * (is_same ? CellBox::end_of(box_.low, box_.high, k)[j]
                                            : dot(axes[j], corners_[k]));
            }
            ends_.clear();
            ends_.add_row(places);
            for (const MatrixGame::Values& excess : demands_) {
                ends_.add_demand(excess);
            }
            ends_.solve();
            // Values of demands are off by a few u of their own besides.
            const double end = ends_.bound() + kCellPad * ends_.reach();
            double& place = sign < 0 ? result.low[j] : result.high[j];
            const double found = sign * end;
            if (!is_same || (sign < 0 ? found > place : found < place)) {
                place = found;
            }
        }
        if (!(result.low[j] <= result.high[j])) {
            return std::nullopt;
        }
    }
    return result;
}

// Cuts the cell down to what is of interest. Where much is cut, directions are worth another try.
ThicknessQuery::Shrunk ThicknessQuery::shrink() {
    constexpr double kWorthwhile = 0.9; // of the volume
    const double least = target();
    const std::optional<CellBox> rest = cut_box(box_.axes, true);
    if (rest && rest->low == box_.low && rest->high == box_.high) {
        return Shrunk::kNot;
    }
    given_up_ = std::max(given_up_, std::min(bound_, least));
    if (!rest) {
        return Shrunk::kToNothing;
    }
    if (rest->volume() < kWorthwhile * box_.volume()) {
        tried_.clear();
    }
    box_ = *rest;
    place_corners();
    return Shrunk::kSmaller;
}

// Puts the cell into the frame of its heaviest row where what is left of the cell is a thin slice
// along that, or, once in a line of cells, where no progress is made: surfaces that stand askew to
// the cell shade each other.
void ThicknessQuery::turn() {
    constexpr double kAligned = 0.9995, kLight = 0x1p-6, kThinner = 0.6, kWorth = 3;
    const Held* first = nullptr;
    for (const Held& held : held_) {
        const Vec3 along = abs(box_.local(rows_[held.id].normal));
        if (held.weight > kLight && norm_inf(along) < kAligned &&
            (first == nullptr || held.weight > first->weight)) {
            first = &held;
        }
    }
    if (first == nullptr) {
        return;
    }
    const Vec3 up = rows_[first->id].normal;
    Vec3 side = side_for(up);
    double weight = kLight;
    for (const Held& held : held_) {
        const BoundRow& row = rows_[held.id];
        if (held.weight > weight && std::fabs(dot(row.normal, up)) < 0.9) {
            weight = held.weight;
            side = row.normal;
        }
    }
    const Vec3 second = unit_or(side - dot(side, up) * up, {0, 0, 0});
    const std::array<Vec3, 3> axes{up, second, cross(up, second)};
    const double least = target();
    const double most = !is_fitted_ && stalls_ > 0 ? kWorth : kThinner;
    const std::optional<CellBox> turned = cut_box(axes, false);
    if (turned && turned->volume() < most * box_.volume()) {
        given_up_ = std::max(given_up_, std::min(bound_, least));
        box_ = *turned;
        box_frame_ = static_cast<std::uint32_t>(frames_.size());
        frames_.push_back(axes);
        is_fitted_ = true;
        place_corners();
    }
}

// How much the rows in use, by their weights, lose along each axis of the cell: a triangle row by
// its second difference, an escape row by the slope of the triangle that is highest.
Vec3 ThicknessQuery::bends() const {
    Vec3 sum{0, 0, 0};
    const Vec3 middle = box_.middle(), half = 0.5 * box_.width();
    for (const Held& held : held_) {
        const BoundRow& row = rows_[held.id];
        if (held.weight < 0x1p-6) {
            continue;
        }
        if (row.is_escape) {
            const Vec3 slope = box_.local(row.slope);
            for (std::size_t j = 0; j < 3; ++j) {
                sum[j] += held.weight * half[j] * std::fabs(slope[j]);
            }
            continue;
        }
        std::array<Vec3, 7> points;
        points.fill(box_.at(middle));
        for (std::size_t j = 0; j < 3; ++j) {
            points[2 * j + 1] = points[0] - half[j] * box_.axes[j];
            points[2 * j + 2] = points[0] + half[j] * box_.axes[j];
        }
        std::array<double, 7> values;
        distances_from(held.triangle, points, values);
        for (std::size_t j = 0; j < 3; ++j) {
            sum[j] += held.weight *
                      std::max(0.0, 0.5 * (values[2 * j + 1] + values[2 * j + 2]) - values[0]);
        }
    }
    return sum;
}

// How far the cell reaches along each axis, counted by how much the rows in use see of it: along a
// pin nothing changes.
Vec3 ThicknessQuery::rises() const {
    constexpr double kUnseen = 0.05;
    Vec3 sum{kUnseen, kUnseen, kUnseen};
    for (const Held& held : held_) {
        sum = sum + held.weight * abs(box_.local(rows_[held.id].normal));
    }
    const Vec3 width = box_.width();
    return {width.x * sum.x, width.y * sum.y, width.z * sum.z};
}

} // namespace obb
