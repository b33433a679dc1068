// What a contact query says of pairs that doubles, or the distance asked for, let nobody tell from
// contact: brackets that are as wide as what is not known.
#include "in_motion/contact_query.hpp"
#include "in_motion/intersection_proof.hpp"

#include "nearest/closest_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obb {

namespace {

// A stalled pair is looked at so many tolerances later for contact, at once and at most.
constexpr double kFirstReach = 0x1p-3;
constexpr double kStallReach = 0x1p12;
// The shortest time, of the query's duration, after which a near pair is looked at again.
constexpr double kShortest = 0x1p-52;
// Of the time from one look at a near pair to the next: how exactly the end of nearness is found.
constexpr int kHalvings = 12;
// Of the bodies' size: what rounding must at least tell apart for a stall to mean a contact.
constexpr double kSameDistance = 0x1p-16;
// Of so many stalled pairs each is looked at for contact.
constexpr std::size_t kMostStalled = 64;
// Pops in which others may prove contact while pairs are stalled, and in which they may get past
// the time at which those are no longer near.
constexpr std::uint64_t kStallPops = 2000;
constexpr std::uint64_t kNearPops = 0x10'0000;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace

// The triangles' coordinates are off by their error, each, so that the distance is by twice that.
ContactQuery::Gap ContactQuery::gap_at(const Entry& entry, double time) {
    set_time(time);
    const SpinningTriangle a(a_.triangle(entry.a), a_.spin());
    const SpinningTriangle b(b_.triangle(entry.b), b_.spin());
    const Vec3 between = pivot_between_ + time * closing_velocity_;
    Triangle moved = b.points;
    for (Vec3& p : moved) {
        p = p + between;
    }
    const TriangleDistance closest = measure(a.points, moved);
    const bool is_apart = closest.low > 0;
    const double low = is_apart ? std::ldexp(closest.low, closest.exponent) : 0.0;
    const double high = is_apart ? std::ldexp(closest.high, closest.exponent) : 0.0;
    const double error = 2 * triangle_error(a, b);
    return {std::ldexp(low - error, length_exponent_), std::ldexp(high + error, length_exponent_),
            is_apart ? closest.point_b - closest.point_a : Vec3{0, 0, 0}};
}

// A pair is near while points of it are within `near`, mesh units, for certain; or, where that is
// no more than the clearance, while it is not proven to be beyond the clearance. Looks are further
// and further away: of the stretch in between nothing is said but that it is one of nearness.
ContactQuery::Nearness ContactQuery::nearness_from(const Entry& entry, double near) {
    const auto has_parted = [&](double time) {
        const Gap gap = gap_at(entry, time);
        return near > options_.limits.clearance ? gap.high > near : gap.low > options_.limits.clearance;
    };
    const auto is_contact = [&](double time) {
        return (clearance_ > 0 && gap_at(entry, time).high <= options_.limits.clearance) ||
               surely_intersect_at(entry, time);
    };
    double last = entry.time;
    const double shortest = std::max(kFirstReach * time_tolerance_, kShortest * duration_);
    for (double reach = shortest; last < duration_; reach *= 2) {
        const double time = std::min(entry.time + reach, duration_);
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
    return {duration_, duration_, false};
}

// Whether points of the pair are as near as asked, which ends the search: by the time at which they
// are in contact, or until which they are as near.
bool ContactQuery::is_near_enough(const Entry& entry) {
    const double tolerance = std::ldexp(distance_tolerance_, length_exponent_);
    const double enough = std::max({tolerance, options_.limits.clearance, 0.0});
    const double distance = gap_at(entry, entry.time).high;
    if (!(distance <= enough)) {
        return false;
    }
    Contact contact{entry.time, entry.time, Evidence::kWithinTolerance,
                    entry.a,    entry.b,    distance,
                    0};
    if (distance > options_.limits.clearance) {
        contact.high = nearness_from(entry, enough).last;
        contact.distance = std::max(distance, gap_at(entry, contact.high).high);
    }
    report(contact);
    return true;
}

// Once it is known until when the stalled pairs are near, another one is seen to have parted by
// then, or else the time is later.
void ContactQuery::stall(const Entry& entry) {
    if (!near_) {
        if (stalled_.empty()) {
            stall_pops_ = counts_.pops + kStallPops;
            stall_end_ = entry.time + time_tolerance_;
        }
        stalled_.push_back(entry);
    } else if (!(gap_at(entry, near_->high).low > options_.limits.clearance)) {
        const Nearness near = nearness_from(entry, options_.limits.clearance);
        near_->high = std::max(near_->high, near.end);
        stall_end_ = near_->high;
        is_near_proven_ = near.is_contact;
    }
}

// A contact that one of the stalled pairs is soon proven to have.
std::optional<Contact> ContactQuery::soon_after(std::span<const Entry> stalled) {
    const double low = stalled.front().time;
    for (double reach = kFirstReach; reach <= kStallReach; reach *= 2) {
        for (const Entry& entry : stalled) {
            const double time = std::min(entry.time + reach * time_tolerance_, duration_);
            if (clearance_ > 0 && gap_at(entry, time).high <= options_.limits.clearance) {
                return Contact{low,     time,    Evidence::kWithinTolerance,
                               entry.a, entry.b, options_.limits.clearance,
                               0};
            }
            if (surely_intersect_at(entry, time)) {
                return Contact{low, time, Evidence::kIntersecting, entry.a, entry.b, 0, 0};
            }
        }
        if (const auto contact = of_patches(stalled, reach * time_tolerance_)) {
            return contact;
        }
    }
    return std::nullopt;
}

// A contact that stalled pairs which share a triangle are proven to have together, so long after
// the first: which of them has it is not known.
std::optional<Contact> ContactQuery::of_patches(std::span<const Entry> stalled, double reach) {
    const double low = stalled.front().time, time = std::min(low + reach, duration_);
    for (const bool shares_a : {true, false}) {
        const auto shared = [&](const Entry& entry) { return shares_a ? entry.a : entry.b; };
        for (std::size_t k = 0; k < stalled.size(); ++k) {
            std::vector<Entry> patch;
            for (std::size_t j = k; j < stalled.size(); ++j) {
                if (shared(stalled[j]).begin == shared(stalled[k]).begin) {
                    patch.push_back(stalled[j]);
                }
            }
            if (patch.size() > 1 && surely_meets_patch(patch, shares_a, time)) {
                return as_near(patch, low, time);
            }
        }
    }
    return std::nullopt;
}

bool ContactQuery::surely_meets_patch(std::span<const Entry> patch, bool shares_a, double time) {
    set_time(time);
    const Vec3 between = pivot_between_ + time * closing_velocity_;
    std::vector<Triangle> others;
    Triangle shared{};
    double error = 0;
    for (const Entry& entry : patch) {
        const SpinningTriangle a(a_.triangle(entry.a), a_.spin());
        SpinningTriangle b(b_.triangle(entry.b), b_.spin());
        for (Vec3& p : b.points) {
            p = p + between;
        }
        error = std::max(error, triangle_error(a, b));
        others.push_back(shares_a ? b.points : a.points);
        shared = shares_a ? a.points : b.points;
    }
    return surely_intersects_patch(shared, others, error);
}

// If the stalled pairs are ever in contact, then first by the time at which one of them is proven
// to be, or else while one of them is near. Nothing where rounding is larger than the bodies: a
// pivot far away, say.
std::optional<Contact> ContactQuery::undecided(std::span<const Entry> stalled) {
    const Entry& first = stalled.front();
    const double extents = a_.extent() + b_.extent(); // of points: none
    const double beyond = gap_at(first, first.time).high - options_.limits.clearance;
    if (extents > 0 && beyond > kSameDistance * extents) {
        return std::nullopt;
    }
    double proven = kInfinity, high = first.time;
    for (const Entry& entry : stalled) {
        if (high > first.time && gap_at(entry, high).low > options_.limits.clearance) {
            continue; // it has parted by then
        }
        const Nearness near = nearness_from(entry, options_.limits.clearance);
        (near.is_contact ? proven : high) =
            near.is_contact ? std::min(proven, near.end) : std::max(high, near.end);
    }
    is_near_proven_ = proven < kInfinity;
    return as_near(stalled, first.time, is_near_proven_ ? proven : high);
}

// Of the stalled pairs, the one that is nearest at both ends of the bracket.
Contact ContactQuery::as_near(std::span<const Entry> stalled, double low, double high) {
    Contact contact{low, high, Evidence::kWithinTolerance, {}, {}, kInfinity, 0};
    for (const Entry& entry : stalled.first(std::min(stalled.size(), kMostStalled))) {
        const double distance = std::max(gap_at(entry, low).high, gap_at(entry, high).high);
        if (distance < contact.distance) {
            contact.distance = distance;
            contact.a = entry.a;
            contact.b = entry.b;
        }
    }
    return contact;
}

// A pair of many, which are told one by one.
void ContactQuery::end_stalled(const Entry& entry) {
    std::optional<Contact> contact = soon_after({&entry, 1});
    contact = contact ? contact : undecided({&entry, 1});
    if (contact) {
        report(*contact);
    } else {
        give_up(entry.time);
    }
}

// Once no pair is left that might be in contact as early, or after a while: contact soon after the
// first stalled pair, if that is proven; else all pairs are seen past the time until which the
// stalled ones are near, so that the bracket holds what any of them may do.
void ContactQuery::settle_stalled(double next) {
    if (!near_) {
        const std::span<const Entry> stalled{stalled_};
        near_ = soon_after(stalled.first(std::min(stalled.size(), kMostStalled)));
        is_near_proven_ = near_.has_value();
        near_ = near_ ? near_ : undecided(stalled);
        if (!near_) {
            give_up(stalled_.front().time);
            return;
        }
        stall_pops_ = counts_.pops + kNearPops;
        stall_end_ = near_->high;
    }
    const bool is_out_of_patience = counts_.pops > stall_pops_;
    if (!is_near_proven_ && !is_out_of_patience && next <= near_->high && near_->high < duration_) {
        return;
    }
    if (near_->evidence == Evidence::kWithinTolerance && !is_near_proven_) {
        near_ = as_near(stalled_, near_->low, is_out_of_patience ? duration_ : near_->high);
    }
    report(*near_);
}

} // namespace obb
