// What a contact query does where it has come down to two triangles.
#include "in_motion/contact_query.hpp"

#include "primitives/first_within.hpp"
#include "primitives/pair_query.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

// Without turning, a pair's first contact is exact. Eberly 2008 §4.2.2.
void ContactQuery::meet_in_translation(const Entry& entry) {
    const LinearMotion motion = pair_.linear_motion();
    ++counts_.triangle_tests;
    const Triangle a = pair_.a().posed_triangle(entry.a), b = pair_.b().posed_triangle(entry.b);
    const PairVerdict verdict = test_pair(a, b, motion);
    if (!verdict.intersects) {
        counts_.exact_triangle_tests += verdict.exact ? 1 : 0;
        return;
    }
    ++counts_.exact_triangle_tests;
    const std::optional<PairContact> found = obb::first_contact(a, b, motion);
    const double high = pair_.scaled_time(std::min(found->time_above, options_.duration));
    if (exact_ && exact_->high <= high) {
        return;
    }
    const double low = pair_.scaled_time(found->time_below);
    keep({low, high, Evidence::kIntersecting, entry.a, entry.b, 0, 0});
    if (!options_.each_pair) {
        set_planes(entry, found->touch);
    }
}

// The earliest exact contact so far; with `each_pair` one of many.
void ContactQuery::keep(const Contact& contact) {
    if (options_.each_pair) {
        report(contact);
        return;
    }
    exact_ = contact;
    queue_.erase_after(contact.high); // what cannot touch before is of no interest any more
}

// Without turning, the first time within the clearance is exact too. It is asked for only where a
// step on separating axes no longer gets ahead.
void ContactQuery::meet_within_clearance(const Entry& entry) {
    if (options_.each_pair && entry.time == 0 && meet_at_start(entry)) {
        return;
    }
    ++counts_.triangle_tests;
    const Gap gap = pair_.gap_at(entry.refs(), entry.time);
    const PlacedTriangles placed = pair_.triangles_at(entry.refs(), entry.time);
    const MovingFrame now = pair_.frame(0, entry.time);
    const TriangleStep step = triangle_step(placed.a, placed.b, now, gap.direction);
    const std::optional<double> time = later(entry, step.time);
    if (!time || (exact_ && *time >= exact_->high)) {
        return;
    }
    if (gap.high <=
        options_.limits.clearance) { // no pair is any earlier, and this one is near already
        keep({entry.time, entry.time, Evidence::kWithinTolerance, entry.a, entry.b, gap.high, 0});
    } else if (*time - entry.time > time_tolerance_) {
        push({*time, entry.end, entry.a, entry.b, entry.window});
    } else {
        solve_within_clearance(entry);
    }
}

void ContactQuery::solve_within_clearance(const Entry& entry) {
    ++counts_.exact_triangle_tests;
    const std::optional<Approach> found =
        first_within(pair_.a().posed_triangle(entry.a), pair_.b().posed_triangle(entry.b),
                     pair_.linear_motion(), options_.limits.clearance);
    if (!found) {
        return;
    }
    const double high = pair_.scaled_time(std::min(found->time_above, options_.duration));
    if (exact_ && exact_->high <= high) {
        return;
    }
    const double low = pair_.scaled_time(found->time_below);
    // A graze for an instant may be over at the next double.
    const double bound = pair_.gap_at(entry.refs(), high).high;
    const double distance = found->is_within ? std::min(options_.limits.clearance, bound) : bound;
    keep({low, high, Evidence::kWithinTolerance, entry.a, entry.b, distance, 0});
    if (!options_.each_pair) {
        set_planes(entry, found->touch);
    }
}

void ContactQuery::meet_triangles(const Entry& entry) {
    if (options_.each_pair && entry.time == 0 && meet_at_start(entry)) {
        return;
    }
    pair_.set_time(entry.time);
    ++counts_.triangle_tests;
    const SpinningTriangle a(pair_.a().triangle(entry.a), pair_.a().spin());
    const SpinningTriangle b(pair_.b().triangle(entry.b), pair_.b().spin());
    const MovingFrame now = pair_.frame(0, entry.time);
    TriangleStep step;
    if (pair_.clearance() == 0) {
        step = triangle_step(a, b, now, Vec3{0, 0, 0});
    }
    // The features' axes alone cannot prove two vertices further apart than they themselves show.
    if (step.time == 0) {
        step = triangle_step(a, b, now, pair_.gap_at(entry.refs(), entry.time).direction);
    }
    const std::optional<double> time = later(entry, step.time);
    if (!time) {
        return;
    }
    // Whether it is near enough to end the search does not depend on how it was come by.
    const bool is_near = !(*time - entry.time > time_tolerance_) || step.gap <= distance_tolerance_;
    if (is_near && prove_contact(entry)) {
        return;
    }
    const std::optional<double> meeting = in_window(entry, *time);
    if (!meeting) {
        return;
    }
    if (*meeting > entry.time) {
        Entry next = entry;
        next.time = *meeting;
        push(next);
    } else if (step.gap > 4 * pair_.triangle_error(a, b) + pair_.clearance()) {
        give_up(entry.time);
    } else if (options_.each_pair) {
        settle(stalled_.settle_alone(pair_, {entry.refs(), entry.time}), entry.time);
    } else {
        stalled_.add(pair_, {entry.refs(), entry.time}, counts_.pops);
    }
}

// Whether the pair meets at t = 0, decided exactly.
bool ContactQuery::meet_at_start(const Entry& entry) {
    const PairVerdict verdict = test_pair(pair_.a().posed_triangle(entry.a),
                                          pair_.b().posed_triangle(entry.b), LinearMotion{});
    counts_.exact_triangle_tests += verdict.exact ? 1 : 0;
    if (verdict.intersects) {
        report({0, 0, Evidence::kIntersecting, entry.a, entry.b, 0, 0});
    }
    return verdict.intersects;
}

// Looks for a proven contact a little later: at shrinking fractions of the tolerance, since a graze
// is over soon. True where the pair needs no more attention.
bool ContactQuery::prove_contact(const Entry& entry) {
    if ((distance_tolerance_ >= 0 || pair_.clearance() > 0) && is_near_enough(entry)) {
        return true;
    }
    for (const double share : {0.5, 0x1p-3, 0x1p-6, 0x1p-12}) {
        const double time = std::min(entry.time + share * time_tolerance_, pair_.duration());
        if (proof_ && proof_->time <= time) {
            continue;
        }
        if (!pair_.surely_intersect_at(entry.refs(), time)) {
            continue;
        }
        if (options_.each_pair) {
            report({entry.time, time, Evidence::kIntersecting, entry.a, entry.b, 0, 0});
            return true;
        }
        proof_ = Entry{time, time, entry.a, entry.b};
    }
    return false;
}

// Whether points of the pair are as near as asked, which ends the search: by the time at which they
// are in contact, or until which they are as near.
bool ContactQuery::is_near_enough(const Entry& entry) {
    const double tolerance = pair_.mesh_length(distance_tolerance_);
    const double enough = std::max({tolerance, options_.limits.clearance, 0.0});
    const double distance = pair_.gap_at(entry.refs(), entry.time).high;
    if (!(distance <= enough)) {
        return false;
    }
    Contact contact{entry.time, entry.time, Evidence::kWithinTolerance, entry.a, entry.b,
                    distance,   0};
    if (distance > options_.limits.clearance) {
        contact.high =
            nearness_from(pair_, {entry.refs(), entry.time}, enough, time_tolerance_).last;
        contact.distance = std::max(distance, pair_.gap_at(entry.refs(), contact.high).high);
    }
    report(contact);
    return true;
}

} // namespace obb
