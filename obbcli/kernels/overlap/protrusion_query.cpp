#include "overlap/protrusion_query.hpp"

#include "descent/box_tests.hpp"
#include "overlap/point_triangle.hpp"
#include "shapes/extremes.hpp"
#include "work/slice.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

// length * 2^exponent, not above or not below the exact number where digits underflow.
[[nodiscard]] double in_mesh_units(double length, int exponent, bool is_high) {
    const double result = std::ldexp(length, exponent);
    const bool is_exact = std::ldexp(result, -exponent) == length;
    return is_exact ? result : std::nextafter(result, is_high ? HUGE_VAL : 0.0);
}

// No coordinate exceeds 1: no two points are further apart.
constexpr double kFarthest = 4;

} // namespace

ProtrusionQuery::ProtrusionQuery(const TreeView& a, const Pose& pose_a, const TreeView& b,
                                 const Pose& pose_b, const ProtrusionOptions& options)
    : frame_(overlap_frame(a, pose_a, b, pose_b)), a_(a, pose_a, frame_), b_(b, pose_b, frame_),
      nearest_a_(a_), nearest_(b_), boxes_(b_), windings_(b_), escapes_(b_),
      inside_only_(options.inside_only), slack_(std::clamp(options.tolerance / 20, 0x1p-40, 0.1)),
      tolerance_(options.tolerance), floor_(std::ldexp(options.floor, -frame_.exponent)),
      max_cells_(options.max_cells) {
    if (options.deeper_than) {
        wanted_ = std::ldexp(*options.deeper_than, -frame_.exponent);
        limit_ = std::ldexp(*options.deeper_than + options.floor, -frame_.exponent);
        slack_ = 0x1p-10;
    }
    if (!b.root().is_triangle()) {
        root_b_ = b_.box(b.node(b.root()));
    }
    bound_ = kFarthest;
    push({a.root()});
}

// Until when a cell is of interest.
double ProtrusionQuery::target() const {
    if (limit_) {
        return *limit_;
    }
    return larger(best_.depth * (1 + tolerance_), best_.depth + floor_);
}

bool ProtrusionQuery::is_answered() const {
    if (wanted_ && best_.depth > *wanted_) {
        return true;
    }
    return queue_.is_empty() || -queue_.next_time() <= target();
}

bool ProtrusionQuery::advance(std::uint64_t max_cells) {
    SliceClock clock;
    for (; !is_answered() && cells_ < max_cells_; --max_cells) {
        if (max_cells == 0 || clock.is_over()) {
            return false;
        }
        visit(queue_.pop());
    }
    return true;
}

double ProtrusionQuery::low() const { return in_mesh_units(best_.depth, frame_.exponent, false); }

double ProtrusionQuery::high() const {
    double depth = larger(best_.depth, given_up_);
    if (!queue_.is_empty()) {
        depth = larger(depth, -queue_.next_time());
    }
    return in_mesh_units(depth, frame_.exponent, true);
}

std::optional<bool> ProtrusionQuery::is_deeper() const {
    if (!wanted_) {
        return std::nullopt;
    }
    if (best_.depth > *wanted_) {
        return true;
    }
    // With a floor below rounding what was given up may exceed the limit: then nothing is proven.
    return is_answered() && given_up_ <= *limit_ ? std::optional<bool>(false) : std::nullopt;
}

void ProtrusionQuery::visit(const Cell& cell) {
    ++cells_;
    cell_ = cell;
    bound_ = cell.bound;
    corners_ = corners_of(a_, cell.place);
    held_.clear();
    tried_.clear();
    is_over_ = false;
    for (std::size_t k = 0; k < cell.row_count; ++k) {
        held_.push_back({cell.rows[k], 1, values_of(rows_[cell.rows[k]])});
    }
    look_at();
    for (const Held& row : held_) {
        drop(row.id);
    }
}

void ProtrusionQuery::look_at() {
    constexpr int kRounds = 4;
    if (is_given_up()) {
        return;
    }
    for (int round = 0; round < kRounds && add_rows(); ++round) {
        if (is_given_up()) {
            return;
        }
    }
    if (!is_over_) {
        split();
    }
}

void ProtrusionQuery::give_up(double bound) { given_up_ = larger(given_up_, bound); }

// Whether the rows at hand prove that the cell is of no interest. No point inside B is above where
// an escape row ends: that is a demand as well.
bool ProtrusionQuery::is_given_up() {
    if (!held_.empty()) {
        game_.clear();
        for (const Held& row : held_) {
            game_.add_row(row.values);
        }
        for (const Held& row : held_) {
            if (rows_[row.id].kind == Row::Kind::kEscape) {
                game_.add_demand(row.values);
            }
        }
        game_.solve();
        for (std::size_t k = 0; k < held_.size(); ++k) {
            held_[k].weight = game_.weight(k);
        }
        bound_ = smaller(bound_, game_.bound() + kPieceError * game_.reach());
    }
    if (!(bound_ <= target())) {
        return false;
    }
    give_up(bound_);
    return true;
}

// Where the bound is about attained.
Vec3 ProtrusionQuery::candidate() const {
    Vec3 p{0, 0, 0};
    for (std::size_t k = 0; k < corners_.size(); ++k) {
        const double weight =
            held_.empty() ? 1.0 / static_cast<double>(corners_.size()) : game_.corner_weights()[k];
        p = p + weight * corners_[k];
    }
    return p;
}

void ProtrusionQuery::split() {
    parts_.clear();
    split_cell(a_, cell_.place, parts_);
    if (parts_.empty()) {
        give_up(bound_); // points this close are one
        return;
    }
    drop_idle(kInherited);
    for (const SurfaceCell& part : parts_) {
        push(part);
    }
}

// Queues a cell with the rows at hand, unless these are enough.
void ProtrusionQuery::push(const SurfaceCell& place) {
    if (inside_only_ && is_far(place)) {
        return;
    }
    Cell cell{place, bound_, 0, cell_.is_inside, {}};
    corners_ = corners_of(a_, place);
    for (const Held& row : held_) {
        const Values values = values_of(rows_[row.id]);
        const double most = *std::max_element(values.begin(), values.end());
        cell.bound = smaller(cell.bound, most + 2 * kPieceError);
        cell.rows[cell.row_count++] = row.id;
    }
    if (cell.bound <= target()) {
        give_up(cell.bound);
        return;
    }
    for (const Held& row : held_) {
        hold(row.id);
    }
    queue_.push(cell, -cell.bound, order_++);
}

// Whether the cell is outside the box around all of B.
bool ProtrusionQuery::is_far(const SurfaceCell& place) const {
    if (!root_b_) {
        return false;
    }
    const RoundingBound bound{64 * kUnitRoundoff + 8 * (a_.skew() + b_.skew()),
                              a_.blur() + b_.blur()};
    return place.is_box() ? are_separated(grown_box(a_, place), *root_b_, bound)
                          : are_separated(*root_b_, a_.triangle(place.ref), bound);
}

} // namespace obb
