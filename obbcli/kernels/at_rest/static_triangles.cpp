// The triangles of a question at rest, one pair at a time or many.
#include "at_rest/static_query.hpp"

#include "descent/triangle_lanes.hpp"
#include "primitives/predicates.hpp"

#include <algorithm>
#include <bit>

namespace obb {

// Whether that was the last pair wanted.
bool StaticQuery::keep_if_intersecting(const NodeRef& ref_a, const NodeRef& ref_b,
                                       const TriangleVerdict& verdict) {
    counts_.exact_triangle_tests += verdict.exact ? 1 : 0;
    if (!verdict.intersects) {
        return false;
    }
    pairs_.push_back({a_.id(ref_a), b_.id(ref_b)});
    const bool is_last = !options_.all_pairs || pairs_.size() >= options_.limit;
    if (is_last) {
        stop();
    }
    return is_last;
}

void StaticQuery::meet(const Pair& pair) {
    if (!pair.a.is_triangle() || !pair.b.is_triangle()) {
        is_by_boxes_ = true;
        error_bound_ = distance_bound(pair);
        stop();
        return;
    }
    ++counts_.triangle_tests;
    const TriangleVerdict verdict = test_triangles(a_.triangle(pair.a), b_.triangle(pair.b));
    (void)keep_if_intersecting(pair.a, pair.b, verdict);
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
                if (keep_if_intersecting(swaps ? other : ref, swaps ? ref : other, verdict)) {
                    return;
                }
            }
        }
    }
}

// Whether the exact test has to decide.
bool StaticQuery::may_triangle_meet(const NodeRef& ref_a, const NodeRef& ref_b,
                                    float& nearness) const {
    const bool is_a = ref_a.is_triangle(), is_b = ref_b.is_triangle();
    const Triangle a = is_a ? a_.triangle_in_frame(ref_a) : Triangle{};
    const Triangle b = is_b ? b_.triangle_in_frame(ref_b) : Triangle{};
    const Obb box = !is_a   ? a_.box(a_.tree().node(ref_a))
                    : !is_b ? b_.box(b_.tree().node(ref_b))
                            : Obb{};
    const auto middle = [&](bool is_triangle, const Triangle& t) {
        return is_triangle ? (1.0 / 3.0) * (t[0] + t[1] + t[2]) : box.center;
    };
    nearness = static_cast<float>(norm_1(middle(is_a, a) - middle(is_b, b)));
    return (is_a && is_b) || !are_separated(box, is_a ? a : b, bound_);
}

// Pushes the leaf's next triangles, above what is left of the leaf: leaves may hold whole meshes,
// and neither the stack nor the time between two looks at the clock should.
void StaticQuery::open_leaf(const Pair& pair, bool opens_a) {
    constexpr std::uint32_t kTrianglesAPop = 64;
    const NodeRef leaf = opens_a ? pair.a : pair.b, other = opens_a ? pair.b : pair.a;
    const auto push = [&](const NodeRef& part) {
        stack_.push_back(opens_a ? Pair{part, other} : Pair{other, part});
    };
    (opens_a ? a_ : b_).tree().prepare(leaf);
    const std::uint32_t end = leaf.begin + std::min(kTrianglesAPop, leaf.triangle_count());
    if (end < leaf.end) {
        push({end, leaf.end, leaf.slot, leaf.depth});
    }
    for (std::uint32_t i = leaf.begin; i < end; ++i) {
        const NodeRef child = TreeView::triangle_ref(leaf, i);
        counts_.box_tests += other.is_triangle() ? 0 : 1;
        float nearness = 0;
        if (opens_a ? may_triangle_meet(child, other, nearness)
                    : may_triangle_meet(other, child, nearness)) {
            push(child);
        }
    }
}

} // namespace obb
