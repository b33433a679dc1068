#include "overlap/shadow_pairs.hpp"

#include "shapes/extremes.hpp"

#include <algorithm>

namespace obb {

ShadowGroups::ShadowGroups(const ColumnBody& body, const ColumnFrame& frame)
    : body_(body), frame_(frame),
      groups_(std::min<std::size_t>(kSlots, 1 + body.tree().triangle_count() / 4)) {}

std::span<const Shadow> ShadowGroups::of(const NodeRef& ref) {
    Group& group = groups_[ref.begin % groups_.size()];
    if (group.begin != ref.begin || group.end != ref.end) {
        group.end = group.begin; // in case that what follows throws
        body_.tree().prepare_triangles(ref, ref.triangle_count());
        for (std::uint32_t i = ref.begin; i < ref.end; ++i) {
            group.shadows[i - ref.begin] = frame_.shadow(body_.triangle(i));
        }
        group.begin = ref.begin;
        group.end = ref.end;
    }
    return {group.shadows.data(), group.end - group.begin};
}

ShadowPairs::ShadowPairs(const ColumnBody& a, const ColumnBody& b, const ColumnFrame& frame)
    : a_(a), b_(b), frame_(frame), groups_a_(a, frame), groups_b_(b, frame) {
    Parts roots_a, roots_b;
    if (!frame.is_empty) {
        add(roots_a, a, a.tree().root());
        add(roots_b, b, b.tree().root());
    }
    if (roots_a.count == 1 && roots_b.count == 1) {
        stack_.push_back({roots_a.sides[0], roots_b.sides[0], &a == &b});
    }
}

void ShadowPairs::add(Parts& parts, const ColumnBody& body, const NodeRef& ref) const {
    const Bounds bounds = body.around(ref);
    if (frame_.may_matter(bounds)) {
        const std::size_t u = (frame_.axis + 1) % 3, v = (frame_.axis + 2) % 3;
        parts.sides[parts.count++] = {
            ref, {bounds.low[u], bounds.low[v]}, {bounds.high[u], bounds.high[v]}};
    }
}

ShadowPairs::Parts ShadowPairs::parts_of_side(const ColumnBody& body, const Side& side) const {
    Parts parts;
    for (const NodeRef& ref : parts_of(body.tree(), side.ref)) {
        add(parts, body, ref);
    }
    return parts;
}

// The larger node is opened. Of a node with itself both are, and each pair of parts is kept once.
void ShadowPairs::part(const Pair& pair) {
    if (pair.is_same) {
        const Parts parts = parts_of_side(a_, pair.a);
        for (std::size_t i = 0; i < parts.count; ++i) {
            stack_.push_back({parts.sides[i], parts.sides[i], true});
        }
        if (parts.count == 2) {
            push(parts.sides[0], parts.sides[1]);
        }
        return;
    }
    const bool opens_a = pair.a.ref.triangle_count() >= pair.b.ref.triangle_count();
    const Parts parts = opens_a ? parts_of_side(a_, pair.a) : parts_of_side(b_, pair.b);
    for (std::size_t i = 0; i < parts.count; ++i) {
        opens_a ? push(parts.sides[i], pair.b) : push(pair.a, parts.sides[i]);
    }
}

// Keeps a pair whose shadows may meet within the window.
void ShadowPairs::push(const Side& a, const Side& b) {
    ++counts_.box_tests;
    for (std::size_t k = 0; k < 2; ++k) {
        const double low = larger(larger(a.low[k], b.low[k]), frame_.window.low[k]);
        const double high = smaller(smaller(a.high[k], b.high[k]), frame_.window.high[k]);
        if (low > high) {
            return;
        }
    }
    stack_.push_back({a, b, false});
}

} // namespace obb
