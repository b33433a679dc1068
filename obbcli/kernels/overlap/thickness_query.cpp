#include "overlap/thickness_query.hpp"

#include "overlap/common_box.hpp"
#include "work/slice.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

// 2 * radius * 2^exponent, not above or not below the exact number where digits underflow.
[[nodiscard]] double diameter(double radius, int exponent, bool is_high) {
    const double result = std::ldexp(radius, exponent + 1);
    const bool is_exact = std::ldexp(result, -exponent - 1) == radius;
    return is_exact ? result : std::nextafter(result, is_high ? HUGE_VAL : 0.0);
}

} // namespace

ThicknessQuery::ThicknessQuery(const TreeView& a, const Pose& pose_a, const TreeView& b,
                               const Pose& pose_b, const ThicknessOptions& options)
    : frame_(overlap_frame(a, pose_a, b, pose_b)),
      surfaces_{SolidSurface(a, pose_a, frame_), SolidSurface(b, pose_b, frame_)},
      probes_{SolidProbe(surfaces_[0]), SolidProbe(surfaces_[1])},
      slack_(std::clamp(options.tolerance / 20, 0x1p-40, 0.1)), tolerance_(options.tolerance),
      floor_(std::ldexp(options.floor, -frame_.exponent - 1)), max_cells_(options.max_cells) {
    if (options.deeper_than) {
        wanted_ = std::ldexp(*options.deeper_than, -frame_.exponent - 1);
        limit_ = std::ldexp(*options.deeper_than + options.floor, -frame_.exponent - 1);
        tolerance_ = 0.02; // of what is looked for on the way
    }
    const std::optional<CellBox> box = common_box(surfaces_[0], surfaces_[1]);
    if (box) {
        // A ball in both solids fits between the planes of the box.
        const Vec3 width = box->width();
        const double bound = 0.5 * std::min({width.x, width.y, width.z}) + kCellPad;
        begin(options.within.empty() ? std::vector<CellBox>{*box} : options.within, bound);
    }
}

void ThicknessQuery::begin(const std::vector<CellBox>& boxes, double bound) {
    frames_.push_back(boxes.front().axes);
    for (const CellBox& box : boxes) {
        queue_.push({box.low, box.high, bound, 0, 0, 0, false, 0, {}}, -bound, order_++);
    }
}

// Until when a box is of interest, in terms of the radius of the balls in it.
double ThicknessQuery::target() const {
    if (limit_) {
        return *limit_;
    }
    return std::max(best_.radius * (1 + tolerance_), best_.radius + floor_);
}

bool ThicknessQuery::is_answered() const {
    if (wanted_ && best_.radius > *wanted_) {
        return true;
    }
    return queue_.is_empty() || -queue_.next_time() <= target();
}

bool ThicknessQuery::advance(std::uint64_t max_cells) {
    SliceClock clock;
    for (; !is_answered() && cells_ < max_cells_; --max_cells) {
        if (max_cells == 0 || clock.is_over()) {
            return false;
        }
        visit(queue_.pop());
    }
    return true;
}

double ThicknessQuery::low() const { return diameter(best_.radius, frame_.exponent, false); }

double ThicknessQuery::high() const {
    double radius = std::max(best_.radius, given_up_);
    if (!queue_.is_empty()) {
        radius = std::max(radius, -queue_.next_time());
    }
    return diameter(radius, frame_.exponent, true);
}

std::optional<bool> ThicknessQuery::is_deeper() const {
    if (!wanted_) {
        return std::nullopt;
    }
    if (best_.radius > *wanted_) {
        return true;
    }
    // With a floor below rounding what was given up may exceed the limit: then nothing is proven.
    return is_answered() && given_up_ <= *limit_ ? std::optional<bool>(false) : std::nullopt;
}

std::uint64_t ThicknessQuery::rays() const {
    std::uint64_t sum = 0;
    for (const SolidProbe& probe : probes_) {
        sum += probe.windings.rays() + probe.escapes.rays();
    }
    return sum;
}

void ThicknessQuery::visit(const Cell& cell) {
    ++cells_;
    held_.clear();
    for (std::size_t k = 0; k < cell.row_count; ++k) {
        hold(cell.rows[k]);
    }
    look_at(cell);
    for (const Held& row : held_) {
        rows_.drop(row.id);
    }
}

void ThicknessQuery::look_at(const Cell& cell) {
    constexpr int kRounds = 5;
    constexpr double kProgress = 0.98;
    constexpr double kGain = 0.1; // of the gap: rounds that close less are left to smaller cells
    box_ = {frames_[cell.frame], cell.low, cell.high};
    box_frame_ = cell.frame;
    bound_ = cell.bound;
    inside_ = cell.inside;
    is_fitted_ = cell.is_fitted;
    tried_.clear();
    place_corners();
    if (is_given_up() || is_outside()) {
        return;
    }
    for (int round = 0; round < kRounds && add_rows(); ++round) {
        const double before = bound_;
        if (is_given_up()) {
            return;
        }
        if (round > 0 && before - bound_ < kGain * (before - target())) {
            break;
        }
        if (round == 0) {
            const Shrunk shrunk = shrink();
            if (shrunk == Shrunk::kToNothing ||
                (shrunk == Shrunk::kSmaller && (is_given_up() || is_outside()))) {
                return;
            }
        }
    }
    const bool is_stalled = bound_ > kProgress * cell.bound;
    stalls_ = static_cast<std::uint8_t>(is_stalled && cell.stalls <= 4 ? cell.stalls + 1 : 0);
    turn();
    split();
}

void ThicknessQuery::place_corners() {
    corners_ = box_.corners();
    for (Held& row : held_) {
        rows_[row.id].values(corners_, row.triangle, row.values);
    }
}

// Whether the rows at hand prove that the cell is of no interest.
bool ThicknessQuery::is_given_up() {
    if (!held_.empty()) {
        game_.clear();
        for (const Held& row : held_) {
            game_.add_row(row.values);
        }
        game_.solve();
        for (std::size_t k = 0; k < held_.size(); ++k) {
            held_[k].weight = game_.weight(k);
        }
        bound_ = std::min(bound_, game_.bound() + kCornerError * game_.reach());
    }
    if (!(bound_ <= target())) {
        return false;
    }
    given_up_ = std::max(given_up_, bound_);
    return true;
}

// Whether all of the cell is so near to points outside a solid that none of it is of interest. A
// cell that no triangle of a body meets is inside it or outside as one of its points is. So is the
// core of a cell, and with the core outside, a point of the cell is at most sqrt(3) times as deep
// as the core is within the cell: surfaces that are flush with the cell do no harm.
bool ThicknessQuery::is_outside() {
    const double within = 0.5 * target();
    Obb core = box_.obb();
    for (std::size_t j = 0; j < 3; ++j) {
        core.half_extents[j] = std::max(core.half_extents[j] - within, 0.0);
    }
    for (std::size_t body = 0; body < 2; ++body) {
        SolidProbe& probe = probes_[body];
        if ((inside_ >> body & 1U) != 0 || probe.boxes.is_met(core, kCellPad)) {
            continue;
        }
        const Vec3 world = frame_.to_world(core.center);
        const Vec3 back = frame_.to_frame(world) - core.center;
        bool is_within = true;
        for (std::size_t j = 0; j < 3; ++j) {
            is_within = is_within &&
                        std::fabs(dot(core.axes[j], back)) <= core.half_extents[j] + 0.5 * kCellPad;
        }
        if (!is_within) {
            continue;
        }
        const Winding winding = probe.windings.find(world);
        if (winding.is_outside()) {
            given_up_ = std::max(given_up_, kDiagonal * (within + kCellPad));
            return true;
        }
        inside_ |= static_cast<std::uint8_t>(winding.is_inside() ? 1U << body : 0U);
    }
    return false;
}

// Halves the cell; each half keeps the rows that weigh most.
void ThicknessQuery::split() {
    constexpr double kTelling = 0.3; // of the gap to be closed; bends below that explain little
    constexpr std::uint8_t kPatience = 4;
    const Vec3 width = box_.width();
    Vec3 bend = bends();
    if (stalls_ >= kPatience) {
        bend = width;
    } else if (!(norm_inf(bend) > kTelling * (bound_ - target()))) {
        bend = rises();
    }
    std::size_t axis = 0;
    for (std::size_t j = 1; j < 3; ++j) {
        axis = bend[j] > bend[axis] ? j : axis;
    }
    const double middle = 0.5 * (box_.low[axis] + box_.high[axis]);
    if (!(middle > box_.low[axis] && middle < box_.high[axis] && width[axis] > 4 * kCellPad)) {
        given_up_ = std::max(given_up_, bound_); // points this close are one
        return;
    }
    drop_idle(kInherited);
    Cell half{box_.low, box_.high, bound_, box_frame_, inside_, 0, is_fitted_, stalls_, {}};
    for (const Held& row : held_) {
        half.rows[half.row_count++] = row.id;
    }
    for (const bool is_upper : {false, true}) {
        half.low[axis] = is_upper ? middle : box_.low[axis];
        half.high[axis] = is_upper ? box_.high[axis] : middle;
        for (const Held& row : held_) {
            rows_.hold(row.id);
        }
        queue_.push(half, -bound_, order_++);
    }
}

void ThicknessQuery::drop_idle(std::size_t most) {
    while (held_.size() > most) {
        const auto idle =
            std::min_element(held_.begin(), held_.end(),
                             [](const Held& x, const Held& y) { return x.weight < y.weight; });
        rows_.drop(idle->id);
        held_.erase(idle);
    }
}

} // namespace obb
