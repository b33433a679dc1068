#include "in_motion/ray_cast.hpp"

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

// Pops without an earlier contact after which the front runner is solved ahead of its time: where
// many pairs touch at one time, its planes tell.
constexpr std::uint64_t kPatience = 32;
// Pops after which a question counts as a long one: then the earliest boxes go first.
constexpr std::uint64_t kLong = 8192;
// How far from the middle of its coordinates a pair may be, of its size.
constexpr double kFarthest = 0x1p90;

} // namespace

bool RayCast::suits(const MovingPair& pair) {
    const double place = std::max(norm_1(pair.a().screw().pivot), norm_1(pair.b().screw().pivot));
    return pair.is_translation() && pair.scaled_length(place) <= kFarthest;
}

RayCast::RayCast(const MovingPair& pair, const RayCastOptions& options)
    : options_(options), duration_(pair.duration()),
      motion_{pair.closing_velocity(), pair.duration()},
      relative_(2 * pair.frame(0, 0).relative + 8 * (pair.a().skew() + pair.b().skew())),
      frontier_(options.each_pair), patience_(kPatience), waits_(kPatience) {
    const int exponent = -pair.length_exponent(), half = exponent / 2;
    vertex_scales_ = {power_of_two(half), power_of_two(exponent - half)};
    const TreeView &a = pair.a().tree(), &b = pair.b().tree();
    frontier_.push({0, duration_, a.root(), b.root()});
}

double RayCast::next_time() const {
    double first = frontier_.next_time();
    for (std::size_t k = 0; k < waiting_count_; ++k) {
        first = std::min(first, waiting_[k].entry.time);
    }
    return candidates_.empty() ? first : std::min(first, candidates_.front().low);
}

bool RayCast::advance(MovingPair& pair, std::uint64_t max_pops, double until) {
    pair.set_time(0); // boxes stand where they are at first, and their distance changes
    SliceClock clock;
    while (max_pops > 0 && !clock.is_over()) {
        if (ties_.is_looking()) {
            const TiePlanes::Verdict verdict = ties_.look_on(pair, clock);
            if (verdict == TiePlanes::Verdict::kLooking) {
                break;
            }
            take_tie(pair, verdict);
            continue;
        }
        drop_late();
        if (is_opening_due()) {
            open_waiting();
        }
        if (has_ended() || (options_.each_pair && is_ready()) || lower_bound_ > until) {
            break;
        }
        --max_pops;
        ++counts_.pops;
        if (is_candidate_due()) {
            solve(pair);
        } else {
            visit(pair, frontier_.pop());
        }
        if (counts_.pops > kLong) {
            frontier_.become_queue();
        }
    }
    return has_ended();
}

// Of what cannot touch before the earliest contact known nothing is to be seen.
void RayCast::drop_late() {
    while (!frontier_.is_empty() && !frontier_.is_next_before(latest_)) {
        static_cast<void>(frontier_.pop());
    }
}

bool RayCast::has_ended() {
    if (is_finished_ || ties_.is_looking()) {
        return is_finished_;
    }
    const double next = next_time();
    lower_bound_ = std::min({next, duration_, exact_ ? exact_->low : duration_});
    is_finished_ = exact_ ? options_.any_contact || next >= exact_->high : std::isinf(next);
    return is_finished_;
}

std::optional<Contact> RayCast::take() {
    return is_ready() ? std::optional(found_.pop()) : std::nullopt;
}

void RayCast::visit(MovingPair& pair, const Entry& entry) {
    if (!(entry.time < latest_)) {
        return;
    }
    if (std::uint64_t{entry.a.triangle_count()} * entry.b.triangle_count() <= kCrowd) {
        meet(pair, entry);
        return;
    }
    if (!ties_.may_tie(entry.refs(), counts_.pops)) {
        part(pair, entry);
        return;
    }
    looked_at_ = entry;
    take_tie(pair, ties_.look(pair, entry.refs(), counts_.pops));
}

// Goes on with the pair that was looked at, as the planes of the earliest contact say. Where these
// are not quite ahead of all, what is ahead of them comes next.
void RayCast::take_tie(MovingPair& pair, TiePlanes::Verdict verdict) {
    if (verdict == TiePlanes::Verdict::kAllIsLater) {
        frontier_.clear();
        candidates_.clear();
        waiting_count_ = 0;
        return;
    }
    if (verdict != TiePlanes::Verdict::kUnknown) {
        return;
    }
    part(pair, *looked_at_);
    const auto ahead = ties_.take_ahead().triangles;
    const NodeRef a = pair.a().tree().root(), b = pair.b().tree().root();
    if (ahead[0]) {
        frontier_.push({lower_bound_, duration_, *ahead[0], b});
    }
    if (ahead[1]) {
        frontier_.push({lower_bound_, duration_, a, *ahead[1]});
    }
}

} // namespace obb
