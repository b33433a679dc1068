// The triangles of a clearance query: how far apart they are at single times, and what follows.
#include "clearance/clearance_query.hpp"

#include "primitives/predicates.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

// They are measured at the middle: nobody knows yet whether that is the least distance of all.
void ClearanceQuery::add_triangles(Item item, const IntervalFrame& frame) {
    ++counts_.triangle_tests;
    const PairRef pair{item.a, item.b};
    const double middle = 0.5 * item.span.low + 0.5 * item.span.high;
    const PlacedTriangles placed = pair_.triangles_at(pair, middle);
    const TriangleDistance near = measure(placed.a.points, placed.moved_b);
    if (!std::isfinite(look(pair, middle, placed, near))) {
        settle(item); // of a damaged tree: nothing more can be said of it
        return;
    }
    refine(pair, middle, item.span.high - item.span.low);
    if (is_contact_) {
        return;
    }
    const double low = bound_triangles(frame, placed, near);
    if (low > item.key) {
        item.key = low;
    }
    add(item);
}

// Triangles whose distance is lost to rounding are told from others by an exact test of their
// computed corners.
double ClearanceQuery::look(const PairRef& pair, double time, const PlacedTriangles& placed,
                            const TriangleDistance& near) {
    const bool meets = !(near.low > 0) && triangles_intersect(placed.a.points, placed.moved_b);
    const double found = meets ? 0 : std::ldexp(near.high, near.exponent);
    if (meets && slack_ == 0 && pair_.surely_intersect_at(pair, time)) {
        end_in_contact(pair, time);
        return 0;
    }
    const double high = found + 2 * placed.error + slack_;
    if (high < high_) {
        high_ = high;
        const double seconds = pair_.seconds(time);
        const Vec3 common = meets ? common_point(placed.a.points, placed.moved_b) : near.point_a;
        witness_ = {seconds, pair_.in_world(common, seconds),
                    pair_.in_world(meets ? common : near.point_b, seconds), pair_.a().id(pair.a),
                    pair_.b().id(pair.b)};
    }
    return found;
}

// Along a pair that came nearer than all before, by the golden section: most of what is still open
// need not be looked at once the least distance is about known.
void ClearanceQuery::refine(const PairRef& pair, double time, double reach) {
    constexpr int kSteps = 24;
    constexpr double kGolden = 0.6180339887498949, kWorthwhile = 0.999;
    if (!(high_ < kWorthwhile * refined_) || is_contact_ || whole_.low == whole_.high) {
        return;
    }
    reach = std::max(reach, 0x1p-6 * (whole_.high - whole_.low));
    double low = std::max(whole_.low, time - reach), high = std::min(whole_.high, time + reach);
    const auto distance = [&](double at) {
        ++counts_.triangle_tests;
        const PlacedTriangles placed = pair_.triangles_at(pair, at);
        return look(pair, at, placed, measure(placed.a.points, placed.moved_b));
    };
    double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    double at_left = distance(left), at_right = distance(right);
    for (int k = 0; k < kSteps && !is_contact_ && low < left && left < right; ++k) {
        if (at_left <= at_right) {
            high = right;
            right = left;
            at_right = at_left;
            left = high - kGolden * (high - low);
            at_left = distance(left);
        } else {
            low = left;
            left = right;
            at_left = at_right;
            right = low + kGolden * (high - low);
            at_right = distance(right);
        }
    }
    refined_ = high_;
    pair_.set_time(time);
}

void ClearanceQuery::end_in_contact(const PairRef& pair, double time) {
    const PlacedTriangles placed = pair_.triangles_at(pair, time);
    const Vec3 point = common_point(placed.a.points, placed.moved_b);
    const double seconds = pair_.seconds(time);
    const Vec3 world = pair_.in_world(point, seconds);
    is_contact_ = true;
    high_ = settled_ = 0;
    witness_ = {seconds, world, world, pair_.a().id(pair.a), pair_.b().id(pair.b)};
    queue_.clear();
    stack_.clear();
}

} // namespace obb
