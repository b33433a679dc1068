// What a contact query does where it has come down to two triangles.
#include "in_motion/contact_query.hpp"
#include "in_motion/intersection_proof.hpp"

#include "primitives/first_within.hpp"
#include "primitives/pair_query.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

LinearMotion ContactQuery::linear_motion() const {
    return {a_.screw().linear_velocity, b_.screw().linear_velocity, options_.duration};
}

// Without turning, a pair's first contact is exact. Eberly 2008 §4.2.2.
void ContactQuery::meet_in_translation(const Entry& entry) {
    const LinearMotion motion = linear_motion();
    ++counts_.triangle_tests;
    const Triangle a = a_.posed_triangle(entry.a), b = b_.posed_triangle(entry.b);
    const PairVerdict verdict = test_pair(a, b, motion);
    if (!verdict.intersects) {
        counts_.exact_triangle_tests += verdict.exact ? 1 : 0;
        return;
    }
    ++counts_.exact_triangle_tests;
    const std::optional<PairContact> found = obb::first_contact(a, b, motion);
    const double high = std::ldexp(std::min(found->time_above, options_.duration), -time_exponent_);
    if (exact_ && exact_->high <= high) {
        return;
    }
    const double low = std::ldexp(found->time_below, -time_exponent_);
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
    const Gap gap = gap_at(entry, entry.time);
    const SpinningTriangle a(a_.triangle(entry.a), a_.spin());
    const SpinningTriangle b(b_.triangle(entry.b), b_.spin());
    const TriangleStep step = time_apart(a, b, frame(0, entry.time), gap.direction);
    const std::optional<double> time = later(entry, step.time);
    if (!time || (exact_ && *time >= exact_->high)) {
        return;
    }
    if (gap.high <= options_.limits.clearance) { // no pair is any earlier, and this one is near already
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
        first_within(a_.posed_triangle(entry.a), b_.posed_triangle(entry.b), linear_motion(),
                     options_.limits.clearance);
    if (!found) {
        return;
    }
    const double high = std::ldexp(std::min(found->time_above, options_.duration), -time_exponent_);
    if (exact_ && exact_->high <= high) {
        return;
    }
    const double low = std::ldexp(found->time_below, -time_exponent_);
    // A graze for an instant may be over at the next double.
    const double bound = gap_at(entry, high).high;
    const double distance = found->is_within ? std::min(options_.limits.clearance, bound) : bound;
    keep({low, high, Evidence::kWithinTolerance, entry.a, entry.b, distance, 0});
    if (!options_.each_pair) {
        set_planes(entry, found->touch);
    }
}

double ContactQuery::triangle_error(const SpinningTriangle& a, const SpinningTriangle& b) const {
    return relative_ * (a.size + b.size) + between_error_;
}

void ContactQuery::meet_triangles(const Entry& entry) {
    if (options_.each_pair && entry.time == 0 && meet_at_start(entry)) {
        return;
    }
    set_time(entry.time);
    ++counts_.triangle_tests;
    const SpinningTriangle a(a_.triangle(entry.a), a_.spin());
    const SpinningTriangle b(b_.triangle(entry.b), b_.spin());
    const MovingFrame now = frame(0, entry.time);
    TriangleStep step;
    if (clearance_ == 0) {
        step = time_apart(a, b, now, Vec3{0, 0, 0});
    }
    // The features' axes alone cannot prove two vertices further apart than they themselves show.
    if (step.time == 0) {
        step = time_apart(a, b, now, gap_at(entry, entry.time).direction);
    }
    const std::optional<double> time = later(entry, step.time);
    if (!time) {
        return;
    }
    const bool is_near = !(*time - entry.time > time_tolerance_) || step.gap <= distance_tolerance_;
    if (is_near && prove_contact(entry)) {
        return;
    }
    if (*time > entry.time) {
        push({*time, entry.end, entry.a, entry.b, entry.window});
    } else if (step.gap > 4 * triangle_error(a, b) + clearance_) {
        give_up(entry.time);
    } else if (options_.each_pair) {
        end_stalled(entry);
    } else {
        stall(entry);
    }
}

// Whether the pair meets at t = 0, decided exactly.
bool ContactQuery::meet_at_start(const Entry& entry) {
    const PairVerdict verdict =
        test_pair(a_.posed_triangle(entry.a), b_.posed_triangle(entry.b), LinearMotion{});
    counts_.exact_triangle_tests += verdict.exact ? 1 : 0;
    if (verdict.intersects) {
        report({0, 0, Evidence::kIntersecting, entry.a, entry.b, 0, 0});
    }
    return verdict.intersects;
}

// Looks for a proven contact a little later: at shrinking fractions of the tolerance, since a graze
// is over soon. True where the pair needs no more attention.
bool ContactQuery::prove_contact(const Entry& entry) {
    if ((distance_tolerance_ >= 0 || clearance_ > 0) && is_near_enough(entry)) {
        return true;
    }
    for (const double share : {0.5, 0x1p-3, 0x1p-6, 0x1p-12}) {
        const double time = std::min(entry.time + share * time_tolerance_, duration_);
        if (proof_ && proof_->time <= time) {
            continue;
        }
        if (!surely_intersect_at(entry, time)) {
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

bool ContactQuery::surely_intersect_at(const Entry& entry, double time) {
    set_time(time);
    const SpinningTriangle a(a_.triangle(entry.a), a_.spin());
    SpinningTriangle b(b_.triangle(entry.b), b_.spin());
    const Vec3 between = pivot_between_ + time * closing_velocity_;
    for (Vec3& p : b.points) {
        p = p + between;
    }
    return surely_intersect(a.points, b.points, triangle_error(a, b));
}

} // namespace obb
