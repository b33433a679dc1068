#include "in_motion/steady_query.hpp"

#include <algorithm>

namespace obb {

namespace {

[[nodiscard]] bool is_at_rest(const Screw& screw) {
    constexpr Vec3 kZero{0, 0, 0};
    return screw.linear_velocity == kZero && screw.angular_velocity == kZero;
}

} // namespace

bool moves_nothing(const Screw& a, const Screw& b, double duration) {
    if (duration == 0 || (is_at_rest(a) && is_at_rest(b))) {
        return true;
    }
    if (is_at_rest(a) || is_at_rest(b)) {
        return false;
    }
    return a == b;
}

SteadyQuery::SteadyQuery(const SteadyBody& a, const SteadyBody& b,
                         const ContactQueryOptions& options)
    : a_(a), b_(b), options_(options),
      at_start_(*a.tree, a.pose, *b.tree, b.pose, {.boxes = options.limits.boxes}) {}

bool SteadyQuery::advance(std::uint64_t max_pops) {
    if (!moving_) {
        const std::uint64_t before = at_start_.counts().pops;
        if (!at_start_.advance(max_pops)) {
            return false;
        }
        const bool is_over = moves_nothing(a_.screw, b_.screw, options_.duration) &&
                             !(options_.limits.clearance > 0);
        if (at_start_.is_contact() || is_over) {
            return true;
        }
        max_pops -= std::min(max_pops, at_start_.counts().pops - before);
        moving_.emplace(*a_.tree, a_.pose, a_.screw, *b_.tree, b_.pose, b_.screw, options_);
    }
    return moving_->advance(max_pops);
}

bool SteadyQuery::is_contact() const {
    return at_start_.is_contact() || (moving_ && moving_->contact());
}

WalkCounts SteadyQuery::counts() const {
    WalkCounts counts = at_start_.counts();
    if (moving_) {
        counts += moving_->counts();
    }
    return counts;
}

} // namespace obb
