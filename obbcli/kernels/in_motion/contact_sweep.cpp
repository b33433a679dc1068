#include "in_motion/contact_sweep.hpp"

#include "in_motion/steady_query.hpp"

#include <algorithm>

namespace obb {

namespace {

// Pops of one slice. A single question takes slices of this size too, so that a limit of pops ends
// the row and the question after the same pop.
constexpr std::uint64_t kPopsASlice = 16'384;

[[nodiscard]] std::uint64_t less(std::uint64_t left, std::uint64_t used) {
    return left - std::min(left, std::max<std::uint64_t>(used, 1));
}

} // namespace

SweepStart::SweepStart(const TreeView& a, const TreeView& b, const Placement& placement,
                       const Limits& limits)
    : query_(a, placement.a, b, placement.b, {.boxes = limits.boxes}), left_(limits.max_pops) {}

bool SweepStart::advance() {
    const std::uint64_t before = query_.counts().pops;
    is_answered_ = query_.advance(std::min(left_, kPopsASlice));
    spent_ = query_.counts().pops - before;
    if (is_answered_) {
        return true;
    }
    left_ = less(left_, spent_);
    return left_ == 0;
}

SweepRow::SweepRow(const TreeView& a, const TreeView& b, const Placement& placement,
                   const SweepQuestion& question, const Limits& limits, const SweepStart* start)
    : a_(&a), b_(&b), placement_(&placement), question_(&question), limits_(&limits),
      start_(start) {
    if (start_ == nullptr) {
        start_ = &own_start_.emplace(a, b, placement, limits);
    }
}

bool SweepRow::advance() {
    if (!moving_) {
        if (own_start_ && !own_start_->advance() && !is_late()) {
            return false;
        }
        if (settle_at_start()) {
            return true;
        }
        left_ = start_->left();
        spent_ = start_->spent();
        moving_.emplace(moving_query());
    }
    const std::uint64_t before = moving_->counts().pops;
    const bool is_finished = moving_->advance(std::min(left_, kPopsASlice) - spent_);
    const std::uint64_t used = moving_->counts().pops - before;
    left_ = less(left_, spent_ + used);
    spent_ = 0;
    if (!is_finished && left_ > 0 && !is_late()) {
        return false;
    }
    answer_.counts += moving_->counts();
    if (!is_finished || moving_->has_given_up()) {
        leave_open(moving_->lower_bound());
    } else if (moving_->contact()) {
        tell(*moving_, *moving_->contact());
    }
    return true;
}

// Whether the question at t = 0 answers it all.
bool SweepRow::settle_at_start() {
    const StaticQuery& at_start = start_->query();
    answer_.counts = at_start.counts();
    if (!start_->is_answered()) {
        leave_open(0);
        return true;
    }
    if (at_start.is_by_boxes()) {
        tell_boxes_at_start();
        return true;
    }
    if (at_start.is_contact()) {
        answer_.status = SweepStatus::kTrianglesAtStart;
        answer_.triangle_a = at_start.pairs()[0].a;
        answer_.triangle_b = at_start.pairs()[0].b;
        return true;
    }
    const SweepQuestion& q = *question_;
    return moves_nothing(q.a, q.b, q.duration) && !(limits_->clearance > 0);
}

ContactQuery SweepRow::moving_query() const {
    const ContactQueryOptions options{.duration = question_->duration,
                                      .time_tolerance = question_->time_tolerance,
                                      .limits = *limits_};
    return {*a_, placement_->a, question_->a, *b_, placement_->b, question_->b, options};
}

bool SweepRow::is_late() const {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - began_;
    return taken.count() >= limits_->seconds;
}

void SweepRow::leave_open(double low) {
    answer_.status = SweepStatus::kUnresolved;
    answer_.low = low;
}

// A row says of a contact what the single question says of it: the tests hold both to the same
// bits.
void SweepRow::tell(ContactQuery& query, const Contact& found) {
    const bool by_boxes = found.evidence == Evidence::kBoxes;
    const bool is_at_start = found.high == 0 && (by_boxes || limits_->clearance > 0);
    answer_.status = is_at_start ? SweepStatus::kOverlapAtStart : SweepStatus::kContact;
    answer_.low = found.low;
    answer_.evidence = found.evidence;
    answer_.place = query.place(found);
    answer_.error_bound = found.error_bound;
    answer_.approximate = by_boxes;
    if (by_boxes) {
        return;
    }
    answer_.high = found.high;
    answer_.triangle_a = found.triangle_a;
    answer_.triangle_b = found.triangle_b;
    answer_.distance = found.distance;
}

// The moving question knows where some of the boxes meet; what it costs to ask is not counted.
void SweepRow::tell_boxes_at_start() {
    ContactQuery query = moving_query();
    while (query.counts().pops < kPopsASlice && !query.advance(kPopsASlice - query.counts().pops)) {
    }
    const std::optional<Contact>& found = query.contact();
    if (found && found->evidence == Evidence::kBoxes && !(found->low > 0)) {
        tell(query, *found);
        return;
    }
    answer_.status = SweepStatus::kOverlapAtStart;
    answer_.low = 0;
    answer_.evidence = Evidence::kBoxes;
    answer_.place.feature = kBoxFeature;
    answer_.approximate = true;
    answer_.error_bound = start_->query().error_bound();
}

} // namespace obb
