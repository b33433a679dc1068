// Two shapes at rest and in motion: verdicts keep the laws that exact ones keep, and the two ways
// to them, by planes and edges and by separating axes, agree.
#include "bytes.hpp"
#include "exact/orientation.hpp"
#include "primitives/pair_query.hpp"
#include "primitives/predicates.hpp"

#include <optional>

namespace {

using fuzz::require;

obb::Triangle turned_over(const obb::Triangle& t) { return {t[0], t[2], t[1]}; }
obb::Triangle turned_on(const obb::Triangle& t) { return {t[1], t[2], t[0]}; }

// Coordinates of which no sum overflows, whatever is done to them.
bool is_far(const obb::Triangle& t) {
    return obb::norm_inf(t[0]) > 1e300 || obb::norm_inf(t[1]) > 1e300 ||
           obb::norm_inf(t[2]) > 1e300;
}

void check_orientation(const obb::Triangle& t, const obb::Vec3& d) {
    const int sign = obb::orientation(t[0], t[1], t[2], d).sign;
    require(obb::orientation(t[1], t[2], t[0], d).sign == sign, "a turn keeps the orientation");
    require(obb::orientation(t[0], t[2], t[1], d).sign == -sign, "a swap turns it over");
    require(obb::orientation(d, t[0], t[2], t[1]).sign == sign, "any two swaps keep it");
    const obb::Sign quick = obb::side(t[0], t[1], t[2], d);
    require(quick == obb::Sign::kUnsure || (quick == obb::Sign::kPositive) == (sign > 0),
            "a sure sign is the exact one");
    require(quick == obb::Sign::kUnsure || sign != 0, "no sign is sure where it is zero");
}

void check_rest(const obb::Triangle& a, const obb::Triangle& b) {
    const bool meet = obb::triangles_intersect(a, b);
    require(obb::triangles_intersect(b, a) == meet, "a meets b as b meets a");
    require(obb::triangles_intersect(turned_over(a), turned_on(b)) == meet,
            "the order of vertices does not matter");
    require(obb::triangles_intersect(a, a), "a triangle meets itself");
    require(obb::test_pair(a, b, {}).intersects == meet, "axes say what planes say");
    for (const obb::Vec3& p : a) {
        for (const obb::Vec3& q : b) {
            require(meet || p != q, "a common vertex is a contact");
        }
    }
}

template <typename A, typename B>
void check_motion(const A& a, const B& b, const obb::LinearMotion& motion) {
    const bool meet = obb::test_pair(a, b, motion).intersects;
    const obb::LinearMotion other{motion.velocity_b, motion.velocity_a, motion.duration};
    require(obb::test_pair(b, a, other).intersects == meet, "motion may be told from either side");
    if (obb::test_pair(a, b, {}).intersects) {
        require(meet, "who meets at the start meets");
    }
    if (motion.velocity_a == motion.velocity_b) {
        require(obb::test_pair(a, b, {}).intersects == meet, "who moves alike rests");
    }
    const std::optional<obb::PairContact> found = obb::first_contact(a, b, motion);
    require(found.has_value() == meet, "a contact is found where there is one");
    if (found) {
        require(0 <= found->time && found->time <= found->last_time &&
                    found->last_time <= motion.duration,
                "contacts lie within the duration, in order");
        require(found->time_below <= found->time && found->time <= found->time_above,
                "a time lies within its bracket");
        obb::LinearMotion shorter = motion;
        shorter.duration = found->time_above;
        require(obb::test_pair(a, b, shorter).intersects, "they have met by then");
        shorter.duration = std::nextafter(found->time_below, -1.0);
        require(shorter.duration < 0 || !obb::test_pair(a, b, shorter).intersects,
                "they have not met before");
    }
}

obb::Obb box_of(fuzz::Bytes& bytes, bool on_grid) {
    const obb::Mat3 axes = bytes.rotation();
    const obb::Vec3 center = bytes.point(on_grid), extents = obb::abs(bytes.point(on_grid));
    return {center, {axes.rows[0], axes.rows[1], axes.rows[2]}, extents};
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Bytes bytes(data, size);
    const auto options = bytes.take<std::uint8_t>();
    const bool on_grid = (options & 1) != 0;
    const obb::Triangle a = bytes.triangle(on_grid), b = bytes.triangle(on_grid);
    check_orientation(a, b[0]);
    check_rest(a, b);
    if (is_far(a) || is_far(b)) {
        return 0;
    }
    const bool whole = (options & 2) != 0;
    const obb::Vec3 velocity_a = bytes.point(whole), velocity_b = bytes.point(whole);
    const obb::LinearMotion motion{velocity_a, velocity_b, std::fabs(bytes.number(whole))};
    try {
        check_motion(a, b, motion);
        if ((options & 4) != 0) {
            const obb::Obb box = box_of(bytes, on_grid);
            check_motion(box, a, motion);
            check_motion(box, box_of(bytes, on_grid), motion);
        }
    } catch (const std::domain_error&) { // numbers beyond the range of double
    }
    return 0;
}
