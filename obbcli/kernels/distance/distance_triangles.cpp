// The triangles of a distance query: which are measured, how finely, and what is kept of them.
#include "distance/distance_query.hpp"
#include "numbers/scale.hpp"
#include "primitives/predicates.hpp"

#include <algorithm>
#include <bit>
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

// The pairs of two blocks by their numbers of triangles, less one.
constexpr auto kPairs = [] {
    std::array<std::array<unsigned, 4>, 4> pairs{};
    for (std::uint32_t a = 0; a < 4; ++a) {
        for (std::uint32_t b = 0; b < 4; ++b) {
            pairs[a][b] = pairs_of(a + 1, b + 1);
        }
    }
    return pairs;
}();

// The least float that is at least a number, or the one after it.
[[nodiscard]] float float_above(double number) {
    const auto nearest = static_cast<float>(number);
    return nearest >= number ? nearest : std::nextafter(nearest, HUGE_VALF);
}

} // namespace

double DistanceQuery::low_in_unit(double length, int exponent) const {
    return exponent == 0 && unit_ > 0 ? unit_ * length : scaled_down(length, exponent - exponent_);
}

double DistanceQuery::high_in_unit(double length, int exponent) const {
    return exponent == 0 && unit_ > 0 ? unit_ * length : scaled_up(length, exponent - exponent_);
}

void DistanceQuery::keep_unsettled(Candidate candidate, std::span<Candidate> candidates,
                                   std::uint32_t& kept) {
    if (is_settled(candidate.low)) {
        settle(candidate.low);
    } else {
        candidates[kept++] = candidate;
    }
}

// Those of some pairs that their edges leave, moved to the front.
std::uint32_t DistanceQuery::keep_by_edges(const TriangleBlock& a, const TriangleBlock& b,
                                           std::span<Candidate> candidates) {
    const auto count = static_cast<std::uint32_t>(candidates.size());
    std::uint32_t kept = 0;
    for (std::uint32_t first = 0; first < count; first += 4) {
        PairsInLanes pairs;
        for (std::uint32_t k = 0; k < 4; ++k) {
            pairs[k] = candidates[std::min(first + k, count - 1)].pair;
        }
        const std::array<double, 4> lows = edge_gaps(a, b, unit_factors_, pairs);
        for (std::uint32_t k = 0; k < std::min(4U, count - first); ++k) {
            const Candidate& c = candidates[first + k];
            keep_unsettled({std::max(c.low, lows[k]), c.pair}, candidates, kept);
        }
    }
    return kept;
}

// Bounds of several pairs at once leave few to be measured.
void DistanceQuery::measure_all(const Pair& pair) {
    const TriangleBlock& a = blocks_a_.placed(a_, pair.a, unit_factors_);
    const TriangleBlock& b = blocks_b_.placed(b_, pair.b, unit_factors_);
    counts_.triangle_tests += std::uint64_t{a.count} * b.count;
    const float limit = float_above(high_ - slack_);
    BlockGaps gaps;
    measure_block(a, b, limit, gaps);
    const unsigned all = kPairs[a.count - 1][b.count - 1];
    // Lanes left over hold one of the pairs again.
    settle(std::max({pair.key, double{gaps.least_of_others}, 0.0}));
    std::array<Candidate, 16> candidates;
    std::uint32_t count = 0;
    for (unsigned open = gaps.open & all; open != 0; open &= open - 1) {
        const auto k = static_cast<std::uint32_t>(std::countr_zero(open));
        candidates[count++] = {std::max(pair.key, double{gaps.lows[k]}), k};
    }
    count = keep_by_edges(a, b, {candidates.data(), count});
    for (std::uint32_t k = 0; k < count; ++k) {
        const Candidate& c = candidates[k];
        if (is_settled(c.low)) {
            settle(c.low);
            continue;
        }
        const std::uint32_t i = c.pair % 4, j = second_of_pair(c.pair);
        measure_one({c.low,
                     TreeView::triangle_ref(pair.a, pair.a.begin + i),
                     TreeView::triangle_ref(pair.b, pair.b.begin + j),
                     {}},
                    lane(a.corners, i), lane(b.corners, j));
    }
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

// Where a corner is nearest, all triangles around it are as near: the direction of the least
// distance tells it sooner than each of them. Not of a pair that is to be named rather than the one
// found: of equal pairs that is the first by its rows.
void DistanceQuery::refine(const Pair& pair) {
    ++counts_.exact_triangle_tests;
    const std::pair<std::int64_t, std::int64_t> rows{a_.id(pair.a), b_.id(pair.b)};
    if (incumbent_.is_measured && rows > ids(best_)) {
        refine_incumbent();
        if (const double low = all_apart(pair); is_settled(low)) {
            settle(low);
            return;
        }
    }
    const TriangleDistance found =
        measure_finely(a_.triangle(pair.a), b_.triangle(pair.b), pair.features);
    incumbent_.is_measured |= take(found, pair.a, pair.b);
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

// Whether it is the least now.
bool DistanceQuery::take(const TriangleDistance& found, const NodeRef& a, const NodeRef& b) {
    const double high = high_in_unit(found.high, found.exponent);
    const DistanceBounds one{0, 0, found.point_a, found.point_b, a_.id(a), b_.id(b)};
    const bool is_least = high < high_ || (high == high_ && ids(one) < ids(best_));
    if (is_least) {
        high_ = high;
        best_ = one;
        incumbent_ = {a, b, found.features, false, false, {}};
    }
    slack_ = slack();
    return is_least;
}

void DistanceQuery::touch(const NodeRef& a, const NodeRef& b) {
    const Vec3 point = common_point(a_.triangle(a), b_.triangle(b));
    low_ = high_ = 0;
    slack_ = slack();
    best_ = {0, 0, point, point, a_.id(a), b_.id(b)};
    stop();
}

void DistanceQuery::stop() {
    queue_.clear();
    stack_.clear();
    openings_[0].count = openings_[1].count = 0;
}

DistanceBounds DistanceQuery::bounds() const {
    double low = std::min(low_, high_);
    low = std::min(low, queue_.next_time());
    for (const Pair& pair : stack_) {
        low = std::min(low, pair.key);
    }
    for (const Openings& openings : openings_) {
        for (std::size_t k = 0; k < openings.count; ++k) {
            low = std::min(low, openings.pairs[k].pair.key);
        }
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
