#include "in_motion/nearness.hpp"

#include <algorithm>

namespace obb {

namespace {

// The shortest time after which a near pair is looked at again, of the time tolerance and of the
// duration.
constexpr double kFirstReach = 0x1p-3;
constexpr double kShortest = 0x1p-52;
// Of the time from one look at a near pair to the next: how exactly the end of nearness is found.
constexpr int kHalvings = 24;

} // namespace

// Each look is twice as far away as the last one, until the pair is seen to have parted.
Nearness nearness_from(MovingPair& pair, const TimedPair& entry, double near,
                       double time_tolerance) {
    const auto has_parted = [&](double time) {
        const Gap gap = pair.gap_at(entry.refs, time);
        return near > pair.mesh_clearance() ? gap.high > near : gap.low > pair.mesh_clearance();
    };
    const auto is_contact = [&](double time) {
        return (pair.clearance() > 0 &&
                pair.gap_at(entry.refs, time).high <= pair.mesh_clearance()) ||
               pair.surely_intersect_at(entry.refs, time);
    };
    double last = entry.time;
    const double shortest = std::max(kFirstReach * time_tolerance, kShortest * pair.duration());
    for (double reach = shortest; last < pair.duration(); reach *= 2) {
        const double time = std::min(entry.time + reach, pair.duration());
        if (is_contact(time)) {
            return {time, time, true};
        }
        if (has_parted(time)) {
            double end = time;
            for (int k = 0; k < kHalvings; ++k) {
                const double middle = 0.5 * (last + end);
                (has_parted(middle) ? end : last) = middle;
            }
            return {last, end, false};
        }
        last = time;
    }
    return {pair.duration(), pair.duration(), false};
}

} // namespace obb
