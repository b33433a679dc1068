#include "in_motion/contact_query.hpp"

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace obb {

namespace {

struct LaterLow {
    bool operator()(const Contact& x, const Contact& y) const {
        return std::tuple(x.low, x.triangle_a, x.triangle_b) >
               std::tuple(y.low, y.triangle_a, y.triangle_b);
    }
};

// Rounding of a projection, times the 1-norms of what is projected: the spin's matrix, its product
// with the pose (5 u) and with positions (6 u), and sums over up to nine products (12 u).
constexpr double kRelative = Spin::kMatrixError + 36 * kUnitRoundoff;

// Thousands of pairs that come within the clearance at one time are not all asked: after so many
// pops the earliest so far ends the search, as soon as the bracket is as narrow as asked.
constexpr std::uint64_t kCrowdPops = 4096;
// Beyond this an angle in twice the digits of a double says nothing any more.
constexpr double kMostRadians = 0x1p50;

} // namespace

ContactQuery::ContactQuery(const TreeView& a, const Pose& pose_a, const Screw& screw_a,
                           const TreeView& b, const Pose& pose_b, const Screw& screw_b,
                           const ContactQueryOptions& options)
    : a_(a, pose_a, screw_a), b_(b, pose_b, screw_b), options_(options) {
    set_units();
    is_translation_ = a_.spin().is_still() && b_.spin().is_still();
    if ((a_.spin().speed() + b_.spin().speed()) * duration_ > kMostRadians) {
        give_up(0);
        return;
    }
    is_needed_.push_back(false); // a window that nothing leaves: the whole duration
    push({0, duration_, a.root(), b.root()});
}

// One power of two brings the largest length of the scene into [1/2, 1), another the duration.
void ContactQuery::set_units() {
    const Vec3 between = b_.screw().pivot - a_.screw().pivot;
    const Vec3 velocity = b_.screw().linear_velocity - a_.screw().linear_velocity;
    const double largest = std::max({a_.reach(), b_.reach(), norm_1(between)});
    if (!std::isfinite(largest) || !std::isfinite(norm_1(velocity))) {
        throw std::domain_error("positions or velocities exceed the range of double");
    }
    time_exponent_ = exponent_of(options_.duration);
    length_exponent_ = exponent_of(largest);
    if (norm_1(velocity) > 0) {
        length_exponent_ =
            std::max(length_exponent_, exponent_of(norm_1(velocity)) + time_exponent_);
    }
    if (length_exponent_ > 1020) {
        throw std::domain_error("positions would exceed the range of double (about 1e307)");
    }
    a_.set_units(length_exponent_, time_exponent_);
    b_.set_units(length_exponent_, time_exponent_);
    set_motion();
    pivot_between_ = scaled(between, -length_exponent_);
    closing_velocity_ = scaled(velocity, time_exponent_ - length_exponent_);
    duration_ = std::ldexp(options_.duration, -time_exponent_);
    time_tolerance_ = std::ldexp(options_.time_tolerance, -time_exponent_);
    clearance_ = std::ldexp(options_.limits.clearance, -length_exponent_);
    distance_tolerance_ = std::ldexp(options_.limits.distance_tolerance, -length_exponent_);
    relative_ = kRelative;
    between_error_ =
        8 * kUnitRoundoff * (norm_1(pivot_between_) + duration_ * norm_1(closing_velocity_)) +
        0x1p-380;
}

void ContactQuery::set_motion() {
    const Spin &a = a_.spin(), &b = b_.spin();
    motion_->velocity = halves(a.velocity(), b.velocity());
    motion_->axis = halves(a.axis(), b.axis());
    motion_->speed = halves(a.speed(), b.speed());
    motion_->square = (1 + 0x1p-40) * motion_->speed * motion_->speed;
    motion_->is_still = motion_->speed == every(0.0, motion_->speed);
    motion_->node_scale = halves(a_.node_scale(), b_.node_scale());
    for (std::size_t j = 0; j < 3; ++j) {
        motion_->columns[j] = halves(a_.rotation().column(j), b_.rotation().column(j));
    }
    motion_->offset = halves(a_.offset(), b_.offset());
    const double skew = std::max(a_.skew(), b_.skew());
    motion_->skew = every(skew, motion_->speed);
}

void ContactQuery::set_time(double time) {
    if (time == time_) {
        return;
    }
    time_ = time;
    a_.set_time(time);
    b_.set_time(time);
    set_turns(*motion_, a_.turn(), b_.turn());
}

MovingFrame ContactQuery::frame(double absolute, double time) const {
    return {pivot_between_ + time * closing_velocity_,
            closing_velocity_,
            &a_.spin(),
            &b_.spin(),
            duration_ - time,
            relative_,
            between_error_ + clearance_ + absolute};
}

bool ContactQuery::is_open(const TreeView& tree, const NodeRef& ref,
                           std::uint32_t max_depth) const {
    return !ref.is_triangle() && ref.depth < max_depth &&
           !(options_.limits.boxes.boxes_for_leaves && TreeView::is_leaf(tree.node(ref)));
}

// The largest half extent, in the query's units; nothing for triangles.
double ContactQuery::size_of(const MovingTree& body, const NodeRef& ref) {
    return ref.is_triangle() ? 0
                             : body.node_scale() * norm_inf(half_extents_of(body.tree().node(ref)));
}

// The time up to which a step proves a pair apart, rounded down; nothing where others see to the
// rest. A step proves a half-open interval, so reaching the duration exactly is not enough.
std::optional<double> ContactQuery::later(const Entry& entry, double step) {
    const double sum = entry.time + step;
    const double below = sum * (1 - 0x1p-52);
    if (below > duration_) {
        return std::nullopt;
    }
    if (below >= entry.end && entry.end < duration_) {
        is_needed_[entry.window] = true;
        return std::nullopt;
    }
    return std::max(entry.time, below);
}

// Of equal times the deepest comes first, so that triangles are reached early; of a leaf, what it
// still has after what it had.
void ContactQuery::push(const Entry& entry) {
    queue_.push(entry, entry.time, entry.next > 0 ? 0 : entry.a.depth + entry.b.depth);
}

bool ContactQuery::advance(std::uint64_t max_pops, double until) {
    const double last = std::ldexp(until, -time_exponent_);
    SliceClock clock;
    while (max_pops > 0 && !clock.is_over()) {
        if (wait_) {
            if (!end_wait(clock)) {
                break;
            }
            continue;
        }
        if (has_ended() || is_ready() || lower_bound_ > last) {
            break;
        }
        --max_pops;
        const Entry entry = queue_.pop();
        ++counts_.pops;
        visit(entry);
    }
    return has_ended();
}

// Whether what is known already answers the question.
bool ContactQuery::has_ended() {
    if (is_finished_ || wait_) {
        return is_finished_;
    }
    const double next = queue_.next_time();
    const double stalled = stalled_.empty() ? next : stalled_.front().time;
    lower_bound_ = std::min({next, stalled, duration_});
    if (exact_ && (next >= exact_->high || options_.any_contact)) {
        finish(exact_);
    } else if (exact_ && clearance_ > 0 && counts_.pops > exact_pops_ + kCrowdPops &&
               lower_bound_ >= exact_->high - time_tolerance_) {
        exact_->low = std::min(lower_bound_, exact_->low);
        finish(exact_);
    } else if (proof_ && (options_.any_contact || lower_bound_ >= proof_->time - time_tolerance_)) {
        finish(Contact{std::min(lower_bound_, proof_->time), proof_->time, Evidence::kIntersecting,
                       proof_->a, proof_->b, 0, 0});
    } else if (!stalled_.empty() && (next > stall_end_ || counts_.pops > stall_pops_)) {
        settle_stalled(next);
    } else if (queue_.is_empty()) {
        finish(std::nullopt);
    }
    return is_finished_;
}

std::uint64_t ContactQuery::key_of(const NodeRef& a, const NodeRef& b) {
    return std::uint64_t{a.begin} << 32U | b.begin;
}

// A contact ends the question, or is one of many.
void ContactQuery::report(Contact contact) {
    if (!options_.each_pair) {
        finish(contact);
        return;
    }
    known_.insert(key_of(contact.a, contact.b));
    name_triangles(contact);
    found_.push_back(contact);
    std::push_heap(found_.begin(), found_.end(), LaterLow{});
}

// Boxes that meet say nothing of any one triangle.
void ContactQuery::name_triangles(Contact& contact) const {
    if (contact.evidence != Evidence::kBoxes) {
        contact.triangle_a = a_.id(contact.a);
        contact.triangle_b = b_.id(contact.b);
    }
}

// Others may still come at the same time.
bool ContactQuery::is_ready() const {
    return !found_.empty() && found_.front().low < queue_.next_time();
}

std::optional<Contact> ContactQuery::take() {
    if (!is_ready()) {
        return std::nullopt;
    }
    std::pop_heap(found_.begin(), found_.end(), LaterLow{});
    const Contact contact = found_.back();
    found_.pop_back();
    return in_seconds(contact);
}

Contact ContactQuery::in_seconds(Contact contact) const {
    contact.low = std::ldexp(contact.low, time_exponent_);
    contact.high = std::ldexp(contact.high, time_exponent_);
    return contact;
}

void ContactQuery::finish(std::optional<Contact> contact) {
    lower_bound_ = contact ? contact->low : duration_;
    if (contact) {
        contact_ = in_seconds(*contact);
        name_triangles(*contact_);
    }
    is_finished_ = true;
    queue_.clear();
}

// A pair that is apart, but turns too fast for a step that a double can tell from none.
void ContactQuery::give_up(double time) {
    finish(std::nullopt);
    lower_bound_ = std::min(time, lower_bound_);
    has_given_up_ = true;
}

double ContactQuery::lower_bound() const { return std::ldexp(lower_bound_, time_exponent_); }

} // namespace obb
