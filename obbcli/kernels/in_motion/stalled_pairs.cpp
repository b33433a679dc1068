#include "in_motion/intersection_proof.hpp"
#include "in_motion/nearness.hpp"

#include <algorithm>
#include <limits>

namespace obb {

namespace {

// A stalled pair is looked at so many tolerances later for contact, at once and at most.
constexpr double kFirstReach = 0x1p-3;
constexpr double kStallReach = 0x1p12;
// Of the bodies' size: what rounding must at least tell apart for a stall to mean a contact.
constexpr double kSameDistance = 0x1p-16;
// Of so many stalled pairs each is looked at for contact.
constexpr std::size_t kMostStalled = 64;
// Pops in which others may prove contact while pairs are stalled, and in which they may get past
// the time at which those are no longer near.
constexpr std::uint64_t kStallPops = 2000;
constexpr std::uint64_t kNearPops = 0x10'0000;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Of the stalled pairs, the one that is nearest at both ends of the bracket.
Contact as_near(MovingPair& pair, std::span<const TimedPair> stalled, double low, double high) {
    Contact contact{low, high, Evidence::kWithinTolerance, {}, {}, kInfinity, 0};
    for (const TimedPair& entry : stalled.first(std::min(stalled.size(), kMostStalled))) {
        const double distance =
            std::max(pair.gap_at(entry.refs, low).high, pair.gap_at(entry.refs, high).high);
        if (distance < contact.distance) {
            contact.distance = distance;
            contact.a = entry.refs.a;
            contact.b = entry.refs.b;
        }
    }
    return contact;
}

bool surely_meets_patch(MovingPair& pair, std::span<const TimedPair> patch, bool shares_a,
                        double time) {
    std::vector<Triangle> others;
    Triangle shared{};
    double error = 0;
    for (const TimedPair& entry : patch) {
        const PlacedTriangles placed = pair.triangles_at(entry.refs, time);
        error = std::max(error, placed.error);
        others.push_back(shares_a ? placed.moved_b : placed.a.points);
        shared = shares_a ? placed.a.points : placed.moved_b;
    }
    return surely_intersects_patch(shared, others, error);
}

// A contact that stalled pairs which share a triangle are proven to have together, so long after
// the first: which of them has it is not known.
std::optional<Contact> of_patches(MovingPair& pair, std::span<const TimedPair> stalled,
                                  double reach) {
    const double low = stalled.front().time, time = std::min(low + reach, pair.duration());
    for (const bool shares_a : {true, false}) {
        const auto shared = [&](const TimedPair& entry) {
            return shares_a ? entry.refs.a : entry.refs.b;
        };
        for (std::size_t k = 0; k < stalled.size(); ++k) {
            std::vector<TimedPair> patch;
            for (std::size_t j = k; j < stalled.size(); ++j) {
                if (shared(stalled[j]).begin == shared(stalled[k]).begin) {
                    patch.push_back(stalled[j]);
                }
            }
            if (patch.size() > 1 && surely_meets_patch(pair, patch, shares_a, time)) {
                return as_near(pair, patch, low, time);
            }
        }
    }
    return std::nullopt;
}

} // namespace

// Once it is known until when the stalled pairs are near, another one is seen to have parted by
// then, or else the time is later.
void StalledPairs::add(MovingPair& pair, const TimedPair& entry, std::uint64_t pops) {
    if (!known_) {
        if (pairs_.empty()) {
            most_pops_ = pops + kStallPops;
            end_ = entry.time + time_tolerance_;
        }
        pairs_.push_back(entry);
    } else if (!(pair.gap_at(entry.refs, known_->high).low > pair.mesh_clearance())) {
        const Nearness near = nearness_from(pair, entry, pair.mesh_clearance(), time_tolerance_);
        known_->high = std::max(known_->high, near.end);
        end_ = known_->high;
        is_proven_ = near.is_contact;
    }
}

// A contact that one of the stalled pairs is soon proven to have.
std::optional<Contact> StalledPairs::soon_after(MovingPair& pair,
                                                std::span<const TimedPair> stalled) const {
    const double low = stalled.front().time;
    for (double reach = kFirstReach; reach <= kStallReach; reach *= 2) {
        for (const TimedPair& entry : stalled) {
            const double time = std::min(entry.time + reach * time_tolerance_, pair.duration());
            if (pair.clearance() > 0 &&
                pair.gap_at(entry.refs, time).high <= pair.mesh_clearance()) {
                return Contact{low,
                               time,
                               Evidence::kWithinTolerance,
                               entry.refs.a,
                               entry.refs.b,
                               pair.mesh_clearance(),
                               0};
            }
            if (pair.surely_intersect_at(entry.refs, time)) {
                return Contact{low, time, Evidence::kIntersecting, entry.refs.a, entry.refs.b,
                               0,   0};
            }
        }
        if (const auto contact = of_patches(pair, stalled, reach * time_tolerance_)) {
            return contact;
        }
    }
    return std::nullopt;
}

// If the stalled pairs are ever in contact, then first by the time at which one of them is proven
// to be, or else while one of them is near. Nothing where rounding is larger than the bodies: a
// pivot far away, say.
std::optional<Contact> StalledPairs::undecided(MovingPair& pair,
                                               std::span<const TimedPair> stalled) {
    const TimedPair& first = stalled.front();
    const double extents = pair.a().extent() + pair.b().extent(); // of points: none
    const double beyond = pair.gap_at(first.refs, first.time).high - pair.mesh_clearance();
    if (extents > 0 && beyond > kSameDistance * extents) {
        return std::nullopt;
    }
    double proven = kInfinity, high = first.time;
    for (std::size_t k = 0; k < stalled.size(); ++k) {
        const TimedPair& entry = stalled[k];
        const bool is_looked_at = k < kMostStalled; // of the others, whether they part later
        if (!is_looked_at && pair.gap_at(entry.refs, high).low > pair.mesh_clearance()) {
            continue;
        }
        const Nearness near = nearness_from(pair, entry, pair.mesh_clearance(), time_tolerance_);
        (near.is_contact ? proven : high) =
            near.is_contact ? std::min(proven, near.end) : std::max(high, near.end);
    }
    is_proven_ = proven < kInfinity;
    return as_near(pair, stalled, first.time, is_proven_ ? proven : high);
}

StalledPairs::Verdict StalledPairs::settle_alone(MovingPair& pair, const TimedPair& entry) {
    const std::span<const TimedPair> alone{&entry, 1};
    const std::optional<Contact> soon = soon_after(pair, alone);
    return {true, soon ? soon : undecided(pair, alone)};
}

// Contact soon after the first stalled pair, if that is proven; else all pairs are seen past the
// time until which the stalled ones are near, so that the bracket holds what any of them may do.
StalledPairs::Verdict StalledPairs::settle(MovingPair& pair, double next, std::uint64_t pops) {
    const std::span<const TimedPair> stalled{pairs_};
    if (!known_) {
        known_ = soon_after(pair, stalled.first(std::min(stalled.size(), kMostStalled)));
        is_proven_ = known_.has_value();
        known_ = known_ ? known_ : undecided(pair, stalled);
        if (!known_) {
            return {true, std::nullopt};
        }
        most_pops_ = pops + kNearPops;
        end_ = known_->high;
    }
    if (is_proven_) {
        return {true, known_};
    }
    const bool is_out_of_patience = pops > most_pops_;
    if (!is_out_of_patience && next <= known_->high && known_->high < pair.duration()) {
        return {};
    }
    const double high = is_out_of_patience ? pair.duration() : known_->high;
    return {true, as_near(pair, stalled, known_->low, high)};
}

} // namespace obb
