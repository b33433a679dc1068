#include "at_rest/static_query.hpp"

#include "descent/query_frame.hpp"
#include "work/slice.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace obb {

namespace {

// Of two boxes whose sizes differ by no more than this both are opened.
constexpr double kAlike = 0.5;

} // namespace

StaticQuery::StaticQuery(const TreeView& a, const Pose& pose_a, const TreeView& b,
                         const Pose& pose_b, const StaticQueryOptions& options)
    : a_(a, pose_a), b_(b, pose_b), options_(options), tests_crowds_(tests_crowds(options)) {
    const QueryFrame frame = set_common_frame(a_, b_);
    bound_ = frame.bound;
    exponent_ = frame.exponent;
    frame_.node_scale = halves(a_.node_scale(), b_.node_scale());
    for (std::size_t i = 0; i < 3; ++i) {
        frame_.matrix[i] = halves(a_.matrix().rows[i], b_.matrix().rows[i]);
    }
    frame_.shift = halves(a_.offset(), b_.offset());
    // As if both were children of a node.
    open({a.root(), b.root()}, false, false);
}

bool StaticQuery::is_open(const PosedTree& body, const NodeRef& ref,
                          std::uint32_t max_depth) const {
    return !ref.is_triangle() && ref.depth < max_depth &&
           !(options_.boxes.boxes_for_leaves && TreeView::is_leaf(body.tree().node(ref)));
}

// The largest half extent, in the frame's unit; nothing for triangles.
double StaticQuery::size_of(const PosedTree& body, const NodeRef& ref) {
    return ref.is_triangle() ? 0
                             : body.node_scale() * norm_inf(half_extents_of(body.tree().node(ref)));
}

bool StaticQuery::advance(std::uint64_t max_pops) {
    SliceClock clock;
    for (; !stack_.empty() && max_pops > 0 && !clock.is_over(); --max_pops) {
        ++counts_.pops;
        visit();
    }
    if (stack_.empty() && !is_finished_) {
        finish();
    }
    return is_finished_;
}

// The larger box is opened, or both where they are about as large. A node that cannot be opened
// leaves it to the other.
void StaticQuery::visit() {
    const Pair pair = stack_.back();
    if (is_crowd(pair)) {
        stack_.pop_back();
        meet_all(pair);
        return;
    }
    const bool open_a = is_open(a_, pair.a, options_.boxes.max_depth_a);
    const bool open_b = is_open(b_, pair.b, options_.boxes.max_depth_b);
    if (!open_a && !open_b) {
        stack_.pop_back();
        meet(pair);
        return;
    }
    const double size_a = open_a ? size_of(a_, pair.a) : 0;
    const double size_b = open_b ? size_of(b_, pair.b) : 0;
    // Written so that of sizes that are no numbers, in a damaged tree, both are opened.
    const bool opens_a = open_a && !(size_a < kAlike * size_b);
    const bool opens_b = open_b && !(size_b < kAlike * size_a);
    const bool leaf_a = opens_a && TreeView::is_leaf(a_.tree().node(pair.a));
    const bool leaf_b = opens_b && TreeView::is_leaf(b_.tree().node(pair.b));
    if (leaf_a || leaf_b) {
        open_leaf(leaf_a);
        return;
    }
    stack_.pop_back();
    open(pair, opens_a, opens_b);
}

StaticQuery::Parts StaticQuery::parts_of(const PosedTree& body, const NodeRef& ref,
                                         bool is_opened) {
    if (is_opened) {
        return {body.tree().children(ref, body.tree().node(ref)), 2};
    }
    return {{ref, ref}, 1};
}

// Whether shapes, of which triangles have no box, are not proven apart.
bool StaticQuery::may_meet(const Obb* box_a, const Triangle& a, const Obb* box_b,
                           const Triangle& b) {
    if (box_a == nullptr && box_b == nullptr) {
        return true; // the exact test decides
    }
    ++counts_.box_tests;
    if (box_a == nullptr) {
        return !are_separated(*box_b, a, bound_);
    }
    return !(box_b == nullptr ? are_separated(*box_a, b, bound_)
                              : are_separated(*box_a, *box_b, bound_));
}

// Pushes the pairs of their parts that are not proven apart, the nearest on top. All pairs of boxes
// are tested at once.
void StaticQuery::open(const Pair& pair, bool opens_a, bool opens_b) {
    const Parts a = parts_of(a_, pair.a, opens_a), b = parts_of(b_, pair.b, opens_b);
    const auto node = [](const PosedTree& body, const NodeRef& ref) {
        return ref.is_triangle() ? &kNoBox : &body.tree().node(ref);
    };
    BasicObb<Four> boxes;
    const unsigned meeting = meeting_pairs(
        frame_,
        {node(a_, a.refs[0]), node(a_, a.refs[1]), node(b_, b.refs[0]), node(b_, b.refs[1])},
        bound_, boxes);
    std::array<Triangle, 4> triangles;
    std::array<Vec3, 4> middles;
    const auto middle = [&](const PosedTree& body, const NodeRef& ref, std::size_t k) {
        middles[k] = lane(boxes.center, k);
        if (ref.is_triangle()) {
            Triangle& t = triangles[k] = body.triangle_in_frame(ref);
            middles[k] = (1.0 / 3.0) * (t[0] + t[1] + t[2]);
        }
    };
    for (std::size_t k = 0; k < 2; ++k) {
        middle(a_, a.refs[k], k);
        middle(b_, b.refs[k], 2 + k);
    }
    struct Near {
        double distance;
        std::size_t i, j;
    };
    std::array<Near, 4> near;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.count; ++i) {
        for (std::size_t j = 0; j < b.count; ++j) {
            const bool triangle_a = a.refs[i].is_triangle(), triangle_b = b.refs[j].is_triangle();
            bool meets = (meeting >> (2 * i + j) & 1U) != 0;
            if (triangle_a || triangle_b) {
                const Obb box_a = lane(boxes, i), box_b = lane(boxes, 2 + j);
                meets = may_meet(triangle_a ? nullptr : &box_a, triangles[i],
                                 triangle_b ? nullptr : &box_b, triangles[2 + j]);
            } else {
                ++counts_.box_tests;
            }
            if (meets) {
                near[count++] = {tests_crowds_ ? 0 : norm_1(middles[i] - middles[2 + j]), i, j};
            }
        }
    }
    // Farthest first; the order of equal ones is that of the children. Where every pair is wanted,
    // none is urgent.
    for (std::size_t k = 1; k < count && !tests_crowds_; ++k) {
        for (std::size_t m = k; m > 0 && near[m - 1].distance < near[m].distance; --m) {
            std::swap(near[m - 1], near[m]);
        }
    }
    for (std::size_t k = 0; k < count; ++k) {
        stack_.push_back({a.refs[near[k].i], b.refs[near[k].j], 0});
    }
}

// Pushes the leaf's next triangles and, while there are more, leaves the leaf below them: leaves
// may hold whole meshes, and neither the stack nor the time between two looks at the clock should.
void StaticQuery::open_leaf(bool opens_a) {
    constexpr std::uint32_t kTrianglesAPop = 64;
    Pair& top = stack_.back();
    const NodeRef leaf = opens_a ? top.a : top.b, other = opens_a ? top.b : top.a;
    const PosedTree &body = opens_a ? a_ : b_, &others = opens_a ? b_ : a_;
    body.tree().prepare(leaf);
    const std::uint32_t begin = leaf.begin + top.next;
    const std::uint32_t end = begin + std::min(kTrianglesAPop, leaf.end - begin);
    top.next = end - leaf.begin;
    if (end == leaf.end) {
        stack_.pop_back();
    }
    const bool is_triangle = other.is_triangle();
    const Obb box = is_triangle ? Obb{} : others.box(others.tree().node(other));
    const Triangle triangle = is_triangle ? others.triangle_in_frame(other) : Triangle{};
    for (std::uint32_t i = begin; i < end; ++i) {
        const NodeRef child = TreeView::triangle_ref(leaf, i);
        if (may_meet(nullptr, body.triangle_in_frame(child), is_triangle ? nullptr : &box,
                     triangle)) {
            stack_.push_back(opens_a ? Pair{child, other, 0} : Pair{other, child, 0});
        }
    }
}

// Each surface touches its box, so two boxes that meet hold surfaces no further apart than their
// diagonals. Shapes that every axis left undecided need not quite meet. With e what a projection
// may be off by, the gap is at most 2 e along the normal of a face; along the product of two edges
// at an angle of sine s, it is 2 e / s, but turning one shape until they are parallel moves nothing
// by more than s times its size. So the gap is of the order of sqrt(e size) whatever s is, and
// alike for short edges and thin triangles. Climbing through boxes and triangles of all proportions
// found no gap above 1.01 (sqrt(e size) + e), with e of the bound in use, as skewed poses widen it,
// and the size below: what the box tests take for the size of shapes so close never exceeds it.
// Four times that is added here.
double StaticQuery::distance_bound(const Pair& pair) const {
    // Squares of what is far smaller than the scene vanish, and so may products: hence std::hypot
    // and two roots.
    const auto length = [](Vec3 v) { return std::hypot(v.x, v.y, v.z); };
    const auto diagonal = [&](const PosedTree& body, const NodeRef& ref) {
        return ref.is_triangle() ? 0.0 : 2.0 * length(body.box(body.tree().node(ref)).half_extents);
    };
    const auto extent = [&](const PosedTree& body, const NodeRef& ref) {
        if (!ref.is_triangle()) {
            return diagonal(body, ref);
        }
        const Triangle t = body.triangle_in_frame(ref);
        return length(t[1] - t[0]) + length(t[2] - t[0]);
    };
    const double extents = extent(a_, pair.a) + extent(b_, pair.b);
    const double size = 8.0 * (extents + bound_.absolute);
    const double e = bound_.relative * size + bound_.absolute;
    const double slack = 4.0 * (std::sqrt(e) * std::sqrt(size) + e);
    const double bound = std::ldexp(diagonal(a_, pair.a) + diagonal(b_, pair.b) + slack, exponent_);
    // Upwards, for subnormal bounds are rounded by more than the slack.
    const double largest = std::numeric_limits<double>::max();
    return std::fmin(std::nextafter(bound, std::numeric_limits<double>::infinity()), largest);
}

std::vector<StaticQuery> StaticQuery::divide(std::size_t count) {
    std::vector<Pair> wide = std::move(stack_);
    while (!wide.empty() && wide.size() < count) {
        std::vector<Pair> next;
        for (const Pair& pair : wide) {
            stack_.assign(1, pair);
            ++counts_.pops;
            visit();
            next.insert(next.end(), stack_.begin(), stack_.end());
        }
        wide = std::move(next);
    }
    stack_.clear();
    StaticQuery empty = *this;
    empty.pairs_.clear();
    empty.counts_ = {};
    std::vector<StaticQuery> parts(wide.size(), empty);
    for (std::size_t k = 0; k < wide.size(); ++k) {
        parts[k].stack_.assign(1, wide[k]);
    }
    return parts;
}

void StaticQuery::join(std::span<StaticQuery> parts) {
    std::size_t count = pairs_.size();
    for (const StaticQuery& part : parts) {
        count += part.pairs_.size();
    }
    pairs_.reserve(count);
    for (StaticQuery& part : parts) {
        // No pair is held twice for longer than that takes.
        const std::vector<TrianglePair> found = part.take_pairs();
        pairs_.insert(pairs_.end(), found.begin(), found.end());
        counts_ += part.counts_;
    }
    finish();
}

void StaticQuery::finish() {
    std::sort(pairs_.begin(), pairs_.end());
    is_finished_ = true;
}

} // namespace obb
