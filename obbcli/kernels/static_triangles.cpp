// The triangles of a question at rest, one pair at a time or many.
#include "static_query.hpp"

#include "predicates.hpp"
#include "triangle_lanes.hpp"

#include <algorithm>
#include <bit>

namespace obb {

namespace {

// So many pairs of triangles are sooner tested than the boxes between them.
constexpr std::uint32_t kCrowd = 16;

} // namespace

bool StaticQuery::keep_if_intersecting(const NodeRef& ref_a, const Triangle& a,
                                       const NodeRef& ref_b, const Triangle& b) {
    const TriangleVerdict verdict = test_triangles(a, b);
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
    if (!keep_if_intersecting(pair.a, a_.triangle(pair.a), pair.b, b_.triangle(pair.b))) {
        return;
    }
    if (!options_.all_pairs || pairs_.size() >= options_.limit) {
        stack_.clear();
    }
}

// Only where every pair is wanted: else which is found first would depend on it. And only where no
// box may stand for triangles.
bool StaticQuery::is_crowd(const Pair& pair) const {
    constexpr StaticQueryOptions kNoLimits;
    const std::uint64_t a = pair.a.triangle_count(), b = pair.b.triangle_count();
    return a * b <= kCrowd && options_.all_pairs && options_.limit == kNoLimits.limit &&
           !options_.boxes_for_leaves && options_.max_depth_a == kNoLimits.max_depth_a &&
           options_.max_depth_b == kNoLimits.max_depth_b;
}

// Tests all triangles under one node against all under the other: those under the larger in lanes.
void StaticQuery::meet_all(const Pair& pair) {
    const bool swaps = pair.a.triangle_count() > pair.b.triangle_count();
    const PosedTree &body = swaps ? b_ : a_, &others = swaps ? a_ : b_;
    const NodeRef few = swaps ? pair.b : pair.a, many = swaps ? pair.a : pair.b;
    body.tree().prepare_triangles(few, few.triangle_count());
    others.tree().prepare_triangles(many, many.triangle_count());
    // Of a product of at most kCrowd the smaller factor is at most its root.
    std::array<Triangle, 4> ones;
    static_assert(ones.size() * ones.size() == kCrowd);
    for (std::uint32_t i = few.begin; i < few.end; ++i) {
        ones[i - few.begin] = body.triangle(TreeView::triangle_ref(few, i));
    }
    for (std::uint32_t begin = many.begin; begin < many.end; begin += 4) {
        const std::uint32_t count = std::min(4U, many.end - begin);
        std::array<Triangle, 4> group;
        FourTriangles lanes;
        for (std::uint32_t k = 0; k < 4; ++k) {
            group[k] =
                k < count ? others.triangle(TreeView::triangle_ref(many, begin + k)) : group[0];
            set_lane(lanes, k, group[k]);
        }
        counts_.triangle_tests += few.triangle_count() * count;
        for (std::uint32_t i = few.begin; i < few.end; ++i) {
            const Triangle& one = ones[i - few.begin];
            const NodeRef ref = TreeView::triangle_ref(few, i);
            unsigned crossing = crossing_planes(one, lanes) & ((1U << count) - 1);
            for (; crossing != 0; crossing &= crossing - 1) {
                const auto k = static_cast<std::uint32_t>(std::countr_zero(crossing));
                const NodeRef other = TreeView::triangle_ref(many, begin + k);
                if (swaps) {
                    keep_if_intersecting(other, group[k], ref, one);
                } else {
                    keep_if_intersecting(ref, one, other, group[k]);
                }
            }
        }
    }
}

} // namespace obb
