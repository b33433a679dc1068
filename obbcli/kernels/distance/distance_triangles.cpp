// The triangles of a distance query: which are measured, how finely, and what is kept of them.
#include "distance/distance_query.hpp"
#include "numbers/scale.hpp"
#include "primitives/predicates.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace obb {

namespace {

// A length times 2^exponent, one place further down or up where that rounds.
[[nodiscard]] double scaled_down(double length, int exponent) {
    const double result = std::ldexp(length, exponent);
    return std::ldexp(result, -exponent) > length ? std::nextafter(result, 0.0) : result;
}
[[nodiscard]] double scaled_up(double length, int exponent) {
    const double result = std::ldexp(length, exponent);
    return std::ldexp(result, -exponent) < length ? std::nextafter(result, HUGE_VAL) : result;
}

[[nodiscard]] std::pair<std::int64_t, std::int64_t> ids(const DistanceBounds& b) {
    return {b.triangle_a, b.triangle_b};
}

} // namespace

double DistanceQuery::low_in_unit(double length, int exponent) const {
    return exponent == 0 && unit_ > 0 ? unit_ * length : scaled_down(length, exponent - exponent_);
}

double DistanceQuery::high_in_unit(double length, int exponent) const {
    return exponent == 0 && unit_ > 0 ? unit_ * length : scaled_up(length, exponent - exponent_);
}

// Bounds of several pairs at once leave few to be measured.
void DistanceQuery::measure_all(const Pair& pair) {
    std::array<std::array<Triangle, kFew>, 2> world, unit;
    for (const bool is_a : {true, false}) {
        const NodeRef& ref = is_a ? pair.a : pair.b;
        const PosedTree& body = is_a ? a_ : b_;
        body.tree().prepare_triangles(ref, ref.triangle_count());
        for (std::uint32_t i = 0; i < ref.triangle_count(); ++i) {
            const Triangle t = body.triangle(TreeView::triangle_ref(ref, ref.begin + i));
            world[is_a ? 0 : 1][i] = t;
            unit[is_a ? 0 : 1][i] = in_unit(t);
        }
    }
    std::array<Candidate, kFew * kFew + 3> candidates;
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < pair.a.triangle_count(); ++i) {
        for (std::uint32_t j = 0; j < pair.b.triangle_count(); ++j) {
            candidates[count++] = {pair.key, i, j};
        }
    }
    counts_.triangle_tests += count;
    for (const auto gaps : {quick_gaps, edge_gaps}) {
        std::uint32_t kept = 0;
        for (std::uint32_t first = 0; first < count; first += 4) {
            TriangleLanes a, b;
            for (std::uint32_t k = 0; k < 4; ++k) {
                const Candidate& c = candidates[std::min(first + k, count - 1)];
                a[k] = &unit[0][c.a];
                b[k] = &unit[1][c.b];
            }
            const Gaps lows = gaps(a, b);
            for (std::uint32_t k = 0; k < std::min(4U, count - first); ++k) {
                Candidate c = candidates[first + k];
                c.low = std::max(c.low, lows[k]);
                if (is_settled(c.low)) {
                    settle(c.low);
                } else {
                    candidates[kept++] = c;
                }
            }
        }
        count = kept;
    }
    for (std::uint32_t k = 0; k < count; ++k) {
        const Candidate& c = candidates[k];
        if (is_settled(c.low)) {
            settle(c.low);
        } else {
            measure_one({c.low,
                         TreeView::triangle_ref(pair.a, pair.a.begin + c.a),
                         TreeView::triangle_ref(pair.b, pair.b.begin + c.b),
                         {}},
                        world[0][c.a], world[1][c.b]);
        }
    }
}

Triangle DistanceQuery::in_unit(const Triangle& t) const {
    const auto scaled = [&](const Vec3& v) { return unit_factors_[1] * (unit_factors_[0] * v); };
    return {scaled(t[0]), scaled(t[1]), scaled(t[2])};
}

void DistanceQuery::measure_one(const Pair& pair, const Triangle& a, const Triangle& b) {
    const TriangleDistance found = measure(a, b);
    Pair measured = pair;
    measured.key = std::max(pair.key, low_in_unit(found.low, found.exponent));
    if (measured.key == 0) {
        const TriangleVerdict verdict = test_triangles(a, b);
        counts_.exact_triangle_tests += verdict.exact ? 1 : 0;
        if (verdict.intersects) {
            touch(pair.a, pair.b);
            return;
        }
    }
    measured.features = found.features;
    take(found, pair.a, pair.b);
    add(measured);
}

void DistanceQuery::refine(const Pair& pair) {
    ++counts_.exact_triangle_tests;
    const TriangleDistance found =
        measure_finely(a_.triangle(pair.a), b_.triangle(pair.b), pair.features);
    take(found, pair.a, pair.b);
    settle(std::max(pair.key, low_in_unit(found.low, found.exponent)));
}

// Boxes that stand for what they hold: any of their triangles will do for an upper bound.
void DistanceQuery::close(const Pair& pair) {
    settle(pair.key);
    a_.tree().prepare_triangles(pair.a, 1);
    b_.tree().prepare_triangles(pair.b, 1);
    const Triangle a = a_.triangle(pair.a), b = b_.triangle(pair.b);
    ++counts_.triangle_tests;
    if (triangles_intersect(a, b)) {
        touch(pair.a, pair.b);
    } else {
        take(measure(a, b), pair.a, pair.b);
    }
}

void DistanceQuery::take(const TriangleDistance& found, const NodeRef& a, const NodeRef& b) {
    const double high = high_in_unit(found.high, found.exponent);
    const DistanceBounds one{0, 0, found.point_a, found.point_b, a_.id(a), b_.id(b)};
    if (high < high_ || (high == high_ && ids(one) < ids(best_))) {
        high_ = high;
        best_ = one;
        incumbent_ = {a, b, found.features, false, {}};
    }
}

void DistanceQuery::touch(const NodeRef& a, const NodeRef& b) {
    const Vec3 point = common_point(a_.triangle(a), b_.triangle(b));
    low_ = high_ = 0;
    best_ = {0, 0, point, point, a_.id(a), b_.id(b)};
    queue_.clear();
    stack_.clear();
}

DistanceBounds DistanceQuery::bounds() const {
    double low = std::min(low_, high_);
    low = std::min(low, queue_.next_time());
    for (const Pair& pair : stack_) {
        low = std::min(low, pair.key);
    }
    if (wait_) {
        low = std::min(low, wait_->pair.key);
    }
    DistanceBounds result = best_;
    result.low = scaled_down(low, exponent_);
    result.high = scaled_up(high_, exponent_);
    if (!std::isfinite(result.high)) {
        throw std::domain_error("the distance exceeds the range of double");
    }
    return result;
}

} // namespace obb
