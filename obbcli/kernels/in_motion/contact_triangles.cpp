// What a contact query does where it has come down to two triangles.
#include "in_motion/contact_query.hpp"

#include "nearest/closest_points.hpp"
#include "primitives/pair_query.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

// A stalled pair is looked at so many tolerances later.
constexpr double kStallReach = 0x1p12;
// Of the bodies' size: what rounding must at least tell apart for a stall to mean a contact.
constexpr double kSameDistance = 0x1p-16;
// Of so many stalled pairs each is looked at.
constexpr std::size_t kMostStalled = 64;

} // namespace

// Without turning, a pair's first contact is exact. Eberly 2008 §4.2.2.
void ContactQuery::meet_in_translation(const Entry& entry) {
    const LinearMotion motion{a_.screw().linear_velocity, b_.screw().linear_velocity,
                              options_.duration};
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
    const Contact contact{low, high, Evidence::kIntersecting, entry.a, entry.b, 0, 0};
    if (options_.each_pair) {
        report(contact);
        return;
    }
    exact_ = contact;
    set_planes(entry, motion, found->touch);
    queue_.erase_after(high); // what cannot touch before is of no interest any more
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
    Vec3 direction{0, 0, 0};
    TriangleStep step;
    if (clearance_ == 0) {
        step = time_apart(a, b, now, direction);
    }
    // The features' axes alone cannot prove two vertices further apart than they themselves show.
    if (step.time == 0) {
        (void)distance_at(entry, entry.time, direction);
        step = time_apart(a, b, now, direction);
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
        end_stalled({&entry, 1});
    } else if (stalled_.size() < kMostStalled) {
        stall_pops_ = stalled_.empty() ? counts_.pops : stall_pops_;
        stalled_.push_back(entry);
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
    if (distance_tolerance_ >= 0 || clearance_ > 0) {
        Vec3 direction;
        const double distance = distance_at(entry, entry.time, direction);
        const double enough =
            std::max(std::ldexp(std::max(distance_tolerance_, clearance_), length_exponent_), 0.0);
        if (distance <= enough) {
            report({entry.time, entry.time, Evidence::kWithinTolerance, entry.a, entry.b, distance,
                    0});
            return true;
        }
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

// A proven upper bound on the distance of two triangles at a time, mesh units, and the direction
// between their closest points.
double ContactQuery::distance_at(const Entry& entry, double time, Vec3& direction) {
    set_time(time);
    const SpinningTriangle a(a_.triangle(entry.a), a_.spin());
    const SpinningTriangle b(b_.triangle(entry.b), b_.spin());
    const Vec3 between = pivot_between_ + time * closing_velocity_;
    Triangle moved = b.points;
    for (Vec3& p : moved) {
        p = p + between;
    }
    const TriangleDistance closest = measure(a.points, moved);
    direction = closest.low > 0 ? closest.point_b - closest.point_a : Vec3{0, 0, 0};
    const double high = closest.low > 0 ? std::ldexp(closest.high, closest.exponent) : 0.0;
    return std::ldexp(high + 2 * triangle_error(a, b), length_exponent_);
}

// Rounding hides when exactly stalled pairs touch. One may be seen to intersect a little later;
// else all that can be said is how near the earliest is, and nothing where rounding is larger than
// the bodies: a pivot far away, say.
std::optional<Contact> ContactQuery::contact_of(std::span<const Entry> stalled) {
    const Entry& first = stalled.front();
    for (double reach = 0x1p-3; reach <= kStallReach; reach *= 2) {
        for (const Entry& entry : stalled) {
            const double time = std::min(entry.time + reach * time_tolerance_, duration_);
            if (Vec3 unused;
                clearance_ > 0 && distance_at(entry, time, unused) <= options_.limits.clearance) {
                return Contact{first.time, time,    Evidence::kWithinTolerance,
                               entry.a,    entry.b, options_.limits.clearance,
                               0};
            }
            if (surely_intersect_at(entry, time)) {
                return Contact{first.time, time, Evidence::kIntersecting, entry.a, entry.b, 0, 0};
            }
        }
    }
    Vec3 direction;
    const double distance = distance_at(first, first.time, direction);
    const double extents = a_.extent() + b_.extent(); // of points: none
    if (extents > 0 && distance - options_.limits.clearance > kSameDistance * extents) {
        return std::nullopt;
    }
    return Contact{first.time, first.time, Evidence::kWithinTolerance, first.a, first.b,
                   distance,   0};
}

void ContactQuery::end_stalled(std::span<const Entry> stalled) {
    if (const std::optional<Contact> contact = contact_of(stalled)) {
        report(*contact);
    } else {
        give_up(stalled.front().time);
    }
}

} // namespace obb
