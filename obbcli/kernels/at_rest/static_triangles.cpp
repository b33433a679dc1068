// The triangles of a question at rest, one pair at a time or many.
#include "at_rest/static_query.hpp"

#include "descent/triangle_lanes.hpp"
#include "primitives/predicates.hpp"

#include <algorithm>
#include <bit>

namespace obb {

namespace {

// So many pairs of triangles are sooner tested than the boxes between them.
constexpr std::uint32_t kCrowd = 16;

} // namespace

bool StaticQuery::keep_if_intersecting(const NodeRef& ref_a, const NodeRef& ref_b,
                                       const TriangleVerdict& verdict) {
    counts_.exact_triangle_tests += verdict.exact ? 1 : 0;
    if (verdict.intersects) {
        pairs_.push_back({a_.id(ref_a), b_.id(ref_b)});
    }
    return verdict.intersects;
}

void StaticQuery::meet(const Pair& pair) {
    if (!pair.a.is_triangle() || !pair.b.is_triangle()) {
        is_by_boxes_ = true;
        error_bound_ = distance_bound(pair);
        stack_.clear();
        return;
    }
    ++counts_.triangle_tests;
    const TriangleVerdict verdict = test_triangles(a_.triangle(pair.a), b_.triangle(pair.b));
    if (!keep_if_intersecting(pair.a, pair.b, verdict)) {
        return;
    }
    if (!options_.all_pairs || pairs_.size() >= options_.limit) {
        stack_.clear();
    }
}

// Only where every pair is wanted: else which is found first would depend on it. And only where no
// box may stand for triangles.
bool StaticQuery::tests_crowds(const StaticQueryOptions& options) {
    constexpr StaticQueryOptions kNoLimits;
    return options.all_pairs && options.limit == kNoLimits.limit &&
           options.boxes == kNoLimits.boxes;
}

bool StaticQuery::is_crowd(const Pair& pair) const {
    return tests_crowds_ &&
           std::uint64_t{pair.a.triangle_count()} * pair.b.triangle_count() <= kCrowd;
}

// Tests all triangles under one node against all under the other: those under the larger in lanes.
void StaticQuery::meet_all(const Pair& pair) {
    const bool swaps = pair.a.triangle_count() > pair.b.triangle_count();
    const PosedTree &body = swaps ? b_ : a_, &others = swaps ? a_ : b_;
    const NodeRef few = swaps ? pair.b : pair.a, many = swaps ? pair.a : pair.b;
    body.tree().prepare_triangles(few, few.triangle_count());
    others.tree().prepare_triangles(many, many.triangle_count());
    // Of a product of at most kCrowd the smaller factor is at most its root.
    static_assert(4 * 4 == kCrowd);
    FourTriangles ones, group;
    FourSides sides_one, sides_others;
    body.place_triangles(few.begin, few.triangle_count(), ones);
    for (std::uint32_t begin = many.begin; begin < many.end; begin += 4) {
        const std::uint32_t count = std::min(4U, many.end - begin);
        others.place_triangles(begin, count, group);
        counts_.triangle_tests += few.triangle_count() * count;
        for (std::uint32_t i = few.begin; i < few.end; ++i) {
            const Triangle one = lane(ones, i - few.begin);
            const NodeRef ref = TreeView::triangle_ref(few, i);
            unsigned crossing =
                crossing_planes(one, group, sides_one, sides_others) & ((1U << count) - 1);
            for (; crossing != 0; crossing &= crossing - 1) {
                const auto k = static_cast<std::uint32_t>(std::countr_zero(crossing));
                const NodeRef other = TreeView::triangle_ref(many, begin + k);
                const TriangleVerdict verdict =
                    test_triangles(one, lane(group, k), sides_one.lane(k), sides_others.lane(k));
                keep_if_intersecting(swaps ? other : ref, swaps ? ref : other, verdict);
            }
        }
    }
}

} // namespace obb
