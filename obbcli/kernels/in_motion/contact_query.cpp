#include "in_motion/contact_query.hpp"

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace obb {

namespace {

// Thousands of pairs that come within the clearance at one time are not all asked: after so many
// pops the earliest so far ends the search, as soon as the bracket is as narrow as asked.
constexpr std::uint64_t kCrowdPops = 4096;
// Beyond this an angle in twice the digits of a double says nothing any more.
constexpr double kMostRadians = 0x1p50;
// Box tests before images on a screw are asked for, whatever the bodies: as quick as to make some.
constexpr std::uint64_t kLeastBoxTests = 1024;

} // namespace

ContactQuery::ContactQuery(const TreeView& a, const Pose& pose_a, const Screw& screw_a,
                           const TreeView& b, const Pose& pose_b, const Screw& screw_b,
                           const ContactQueryOptions& options)
    : pair_(a, pose_a, screw_a, b, pose_b, screw_b, options.duration, options.limits.clearance),
      options_(options), time_tolerance_(pair_.scaled_time(options.time_tolerance)),
      distance_tolerance_(pair_.scaled_length(options.limits.distance_tolerance)),
      screw_due_(options.box_tests_before_screw.value_or(
          std::max(kLeastBoxTests, std::uint64_t{a.triangle_count()} + b.triangle_count()))),
      stalled_(time_tolerance_) {
    if (pair_.turning() > kMostRadians) {
        give_up(0);
        return;
    }
    if (is_ray_cast()) {
        cast_.emplace(pair_, RayCastOptions{options.any_contact, options.each_pair});
        return;
    }
    push({0, pair_.duration(), a.root(), b.root()});
}

// Which of two ways a question goes. A ray cast, where neither body turns: three to four times as
// fast for a first contact, two to six for the first of a list, and up to a thousand times for any
// contact at all, which is where it gets to first. Advancement, where
// - something turns;
// - a clearance is kept: pairs of triangles that come near have to be advanced anyway, and the ends
//   of brackets are those of their steps;
// - boxes stand for triangles: what is answered then is when their faces no longer part them;
// - positions are out of the range of the cast.
bool ContactQuery::is_ray_cast() const {
    return RayCast::suits(pair_) && !(pair_.clearance() > 0) && !has_limits();
}

bool ContactQuery::advance_cast(std::uint64_t max_pops, double until) {
    const bool is_over = cast_->advance(pair_, max_pops, until);
    counts_ = cast_->counts();
    lower_bound_ = cast_->lower_bound();
    if (is_over && !is_finished_) {
        finish(cast_->contact());
    }
    return is_over;
}

// The time up to which a step proves a pair apart, rounded down. Nothing where the entry is done
// with: the pair is apart until the duration, or until the end of its window, where the pair that
// the window was opened for answers for the rest. A step proves a half-open interval, so that
// reaching the duration exactly is not enough.
std::optional<double> ContactQuery::later(const Entry& entry, double step) {
    const double sum = entry.time + step;
    const double below = sum * (1 - 0x1p-52);
    if (below > pair_.duration()) {
        return std::nullopt;
    }
    if (below >= entry.end && entry.end < pair_.duration()) {
        windows_.need(entry.window);
        return std::nullopt;
    }
    return std::max(entry.time, below);
}

// Of entries with equal times the deepest pair comes first, so that triangles are reached early.
// The rest of a leaf comes after the triangles that it has pushed.
void ContactQuery::push(const Entry& entry) {
    queue_.push(entry, entry.time, entry.next > 0 ? 0 : entry.a.depth + entry.b.depth);
}

bool ContactQuery::advance(std::uint64_t max_pops, double until) {
    const double last = pair_.scaled_time(until);
    if (cast_) {
        return advance_cast(max_pops, last);
    }
    SliceClock clock;
    while (max_pops > 0 && !clock.is_over()) {
        if (ties_.is_looking()) {
            const TiePlanes::Verdict verdict = ties_.look_on(pair_, clock);
            if (verdict == TiePlanes::Verdict::kLooking) {
                break;
            }
            take_tie(verdict);
            continue;
        }
        if (is_asking_screw() && !make_images(clock)) {
            break;
        }
        if (has_ended() || is_ready() || lower_bound_ > last) {
            break;
        }
        if (is_screw_due()) {
            ask_screw();
            continue;
        }
        --max_pops;
        ++counts_.pops;
        if (screw_ != nullptr && screw_->next_time() < queue_.next_time()) {
            advance_images();
        } else {
            visit(queue_.pop());
        }
    }
    return has_ended();
}

// Whether what is known already answers the question.
bool ContactQuery::has_ended() {
    if (is_finished_ || ties_.is_looking()) {
        return is_finished_;
    }
    const double next = next_time();
    const double stalled = stalled_.is_empty() ? next : stalled_.first_time();
    lower_bound_ = std::min({next, stalled, pair_.duration()});
    if (exact_ && (next >= exact_->high || options_.any_contact)) {
        finish(exact_);
    } else if (exact_ && pair_.clearance() > 0 && counts_.pops > exact_pops_ + kCrowdPops &&
               lower_bound_ >= exact_->high - time_tolerance_) {
        exact_->low = std::min(lower_bound_, exact_->low);
        finish(exact_);
    } else if (proof_ && (options_.any_contact || lower_bound_ >= proof_->time - time_tolerance_)) {
        finish(Contact{std::min(lower_bound_, proof_->time), proof_->time, Evidence::kIntersecting,
                       proof_->a, proof_->b, 0, 0});
    } else if (stalled_.is_due(next, counts_.pops)) {
        settle(stalled_.settle(pair_, next, counts_.pops), stalled);
    } else if (std::isinf(next)) {
        finish(std::nullopt);
    }
    return is_finished_;
}

// No pair that waits is in contact before this; infinite where none waits.
double ContactQuery::next_time() const {
    const double next = queue_.next_time();
    return screw_ == nullptr ? next : std::min(next, screw_->next_time());
}

std::uint64_t ContactQuery::key_of(const NodeRef& a, const NodeRef& b) {
    return std::uint64_t{a.begin} << 32U | b.begin;
}

// A contact ends the search, or with `each_pair` waits to be taken.
void ContactQuery::report(Contact contact) {
    if (!options_.each_pair) {
        finish(contact);
        return;
    }
    name_triangles(contact);
    found_.add(contact, known_key(contact.a, contact.b));
}

// Triangles may be known by their places in the tree or by their rows of the mesh.
std::uint64_t ContactQuery::known_key(const NodeRef& a, const NodeRef& b) const {
    if (has_limits()) {
        return key_of(a, b);
    }
    return std::uint64_t{pair_.a().id(a)} << 32U | pair_.b().id(b);
}

// Takes the verdict on pairs that stalled at a time. A contact that was proven within the bracket
// of undecided pairs ends that bracket.
void ContactQuery::settle(const StalledPairs::Verdict& verdict, double time) {
    if (!verdict.is_final) {
        return;
    }
    if (!verdict.contact) {
        give_up(time);
    } else if (proof_ && proof_->time < verdict.contact->high) {
        report({verdict.contact->low, proof_->time, Evidence::kIntersecting, proof_->a, proof_->b,
                0, 0});
    } else {
        report(*verdict.contact);
    }
}

// Boxes that meet say nothing of any one triangle.
void ContactQuery::name_triangles(Contact& contact) const {
    if (contact.evidence != Evidence::kBoxes) {
        contact.triangle_a = pair_.a().id(contact.a);
        contact.triangle_b = pair_.b().id(contact.b);
    }
}

// Whether a contact waits that no other can come before: of equal times the list decides.
bool ContactQuery::is_ready() const { return found_.next_low() < next_time(); }

std::optional<Contact> ContactQuery::take() {
    if (cast_) {
        const std::optional<Contact> next = cast_->take();
        return next ? std::optional(in_seconds(*next)) : std::nullopt;
    }
    if (!is_ready()) {
        return std::nullopt;
    }
    return in_seconds(found_.pop());
}

Contact ContactQuery::in_seconds(Contact contact) const {
    contact.low = pair_.seconds(contact.low);
    contact.high = pair_.seconds(contact.high);
    return contact;
}

void ContactQuery::finish(std::optional<Contact> contact) {
    lower_bound_ = contact ? contact->low : pair_.duration();
    if (contact) {
        contact_ = in_seconds(*contact);
        name_triangles(*contact_);
    }
    is_finished_ = true;
    queue_.clear();
    if (screw_ != nullptr) {
        screw_->clear();
    }
}

// Ends the search where a pair is apart but turns so fast that its step is lost to rounding.
void ContactQuery::give_up(double time) {
    finish(std::nullopt);
    lower_bound_ = std::min(time, lower_bound_);
    has_given_up_ = true;
}

double ContactQuery::lower_bound() const { return pair_.seconds(lower_bound_); }

} // namespace obb
