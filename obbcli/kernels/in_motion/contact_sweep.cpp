#include "in_motion/contact_sweep.hpp"

#include <algorithm>

namespace obb {

namespace {

// As `Query` takes them, so that a limit of pops ends either at the same place.
constexpr std::uint64_t kPopsASlice = 16'384;

constexpr std::uint8_t kBoxFeature = 10;

[[nodiscard]] std::uint64_t less(std::uint64_t left, std::uint64_t used) {
    return left - std::min(left, std::max<std::uint64_t>(used, 1));
}

[[nodiscard]] bool is_at_rest(const Screw& screw) {
    constexpr Vec3 kZero{0, 0, 0};
    return screw.linear_velocity == kZero && screw.angular_velocity == kZero;
}

// Without negative zeros.
[[nodiscard]] Vec3 plain(Vec3 v) { return {v.x + 0.0, v.y + 0.0, v.z + 0.0}; }

} // namespace

SweepStart::SweepStart(const TreeView& a, const TreeView& b, const Placement& placement,
                       const SweepOptions& options)
    : query_(a, placement.a, b, placement.b,
             {false, options.boxes_for_leaves, options.max_depth_a, options.max_depth_b}),
      left_(options.max_pops) {}

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
                   const SweepQuestion& question, const SweepOptions& options,
                   const SweepStart* start)
    : a_(&a), b_(&b), placement_(&placement), question_(&question), options_(&options),
      start_(start) {
    if (start_ == nullptr) {
        start_ = &own_start_.emplace(a, b, placement, options);
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
    const ContactQueryCounts& more = moving_->counts();
    answer_.counts.box_tests += more.box_tests;
    answer_.counts.triangle_tests += more.triangle_tests;
    answer_.counts.exact_triangle_tests += more.exact_triangle_tests;
    answer_.counts.pops += more.pops;
    if (!is_finished || moving_->has_given_up()) {
        leave_open(moving_->lower_bound());
    } else if (moving_->contact()) {
        tell(*moving_, *moving_->contact());
    }
    return true;
}

// Whether neither body moves against the other.
bool SweepRow::moves_nothing() const {
    const Screw &a = question_->a, &b = question_->b;
    if (question_->duration == 0 || (is_at_rest(a) && is_at_rest(b))) {
        return true;
    }
    if (is_at_rest(a) || is_at_rest(b)) {
        return false;
    }
    return a == b;
}

// Whether the question at t = 0 answers it all.
bool SweepRow::settle_at_start() {
    const StaticQuery& at_start = start_->query();
    const StaticQueryCounts& c = at_start.counts();
    answer_.counts = {c.box_tests, c.triangle_tests, c.exact_triangle_tests, c.pops};
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
    return moves_nothing() && !(options_->clearance > 0);
}

ContactQuery SweepRow::moving_query() const {
    ContactQueryOptions options;
    options.duration = question_->duration;
    options.time_tolerance = question_->time_tolerance;
    options.distance_tolerance = options_->distance_tolerance;
    options.clearance = options_->clearance;
    options.boxes_for_leaves = options_->boxes_for_leaves;
    options.max_depth_a = options_->max_depth_a;
    options.max_depth_b = options_->max_depth_b;
    return {*a_, placement_->a, question_->a, *b_, placement_->b, question_->b, options};
}

bool SweepRow::is_late() const {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - began_;
    return taken.count() >= options_->seconds;
}

void SweepRow::leave_open(double low) {
    answer_.status = SweepStatus::kUnresolved;
    answer_.low = low;
}

// As `contact_of` in questions/describe.py.
void SweepRow::tell(ContactQuery& query, const Contact& found) {
    const ContactPlace place = query.place(found);
    const bool by_boxes = found.evidence == Evidence::kBoxes;
    const bool is_at_start = found.high == 0 && (by_boxes || options_->clearance > 0);
    answer_.status = is_at_start ? SweepStatus::kOverlapAtStart : SweepStatus::kContact;
    answer_.low = found.low;
    answer_.evidence = found.evidence;
    answer_.point_a = plain(place.point_a);
    answer_.point_b = plain(place.point_b);
    answer_.point = plain(0.5 * place.point_a + 0.5 * place.point_b);
    answer_.normal = plain(place.normal);
    answer_.normal_a = plain(place.normal_a);
    answer_.normal_b = plain(place.normal_b);
    answer_.error_bound = found.error_bound;
    answer_.approximate = by_boxes ? 1 : 0;
    if (by_boxes) {
        answer_.feature = kBoxFeature;
        return;
    }
    answer_.high = found.high;
    answer_.triangle_a = found.triangle_a;
    answer_.triangle_b = found.triangle_b;
    answer_.distance = found.distance;
    answer_.feature = static_cast<std::uint8_t>(1 + 3 * place.dimension_a + place.dimension_b);
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
    answer_.feature = kBoxFeature;
    answer_.approximate = 1;
    answer_.error_bound = start_->query().error_bound();
}

} // namespace obb
