// The boxes of a distance query: which of a pair is opened, and how near the parts may be.
#include "descent/opening.hpp"
#include "distance/distance_query.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace obb {

namespace {

// Boxes so much smaller than the other, as a share of its size, wait for it to be opened first.
constexpr double kMuchSmaller = 0.5;
// So many pops open what they can at once: what they find may keep much from being opened.
constexpr std::uint64_t kEarly = 32;
// Boxes of so few triangles are sooner opened than measured again in doubles.
constexpr std::uint32_t kMany = 16;

} // namespace

// The box of a node that may be opened; none of others, and of triangles.
const Node* DistanceQuery::box_to_open(const PosedTree& body, const NodeRef& ref,
                                       std::uint32_t max_depth) const {
    if (ref.is_triangle() || ref.depth >= max_depth) {
        return nullptr;
    }
    const Node& node = body.tree().node(ref);
    return boxes_.boxes_for_leaves && TreeView::is_leaf(node) ? nullptr : &node;
}

// A pair goes on with the parts of the larger box, or of both where they are about as large; with
// its triangles where they are few; or not at all, where boxes stand for what they hold.
void DistanceQuery::part(const Pair& pair) {
    const bool is_few_a = pair.a.triangle_count() <= kFew;
    const bool is_few_b = pair.b.triangle_count() <= kFew;
    const Node* a = box_to_open(a_, pair.a, boxes_.max_depth_a);
    const Node* b = box_to_open(b_, pair.b, boxes_.max_depth_b);
    if (is_few_a && is_few_b &&
        (!is_coarse_ ||
         ((a != nullptr || pair.a.is_triangle()) && (b != nullptr || pair.b.is_triangle())))) {
        measure_all(pair);
        return;
    }
    if (a == nullptr && b == nullptr) {
        close(pair);
        return;
    }
    if (a != nullptr && b != nullptr) {
        const double size_a = size_of(a_, *a), size_b = size_of(b_, *b);
        if (is_few_b || size_b < kMuchSmaller * size_a) {
            b = nullptr;
        } else if (is_few_a || size_a < kMuchSmaller * size_b) {
            a = nullptr;
        }
    }
    const bool leaf_a = a != nullptr && TreeView::is_leaf(*a);
    const bool leaf_b = b != nullptr && TreeView::is_leaf(*b);
    if (leaf_a || leaf_b) {
        open_leaf(pair, leaf_a);
    } else {
        wait_to_open(pair, a, b);
    }
}

// Some triangles at a time, the rest after what they lead to: leaves may hold whole meshes, and
// neither the queue nor the time between two looks at the clock should.
void DistanceQuery::open_leaf(const Pair& pair, bool opens_a) {
    constexpr std::uint32_t kTrianglesAPop = 64;
    const PosedTree& body = opens_a ? a_ : b_;
    const NodeRef& ref = opens_a ? pair.a : pair.b;
    body.tree().prepare(ref);
    const Side other = side_of(opens_a ? b_ : a_, opens_a ? pair.b : pair.a);
    const std::uint32_t begin = ref.begin + pair.next;
    const std::uint32_t end = begin + std::min(kTrianglesAPop, ref.end - begin);
    if (end < ref.end) {
        Pair rest = pair;
        rest.next = end - ref.begin;
        add(rest);
    }
    for (std::uint32_t i = begin; i < end; ++i) {
        const NodeRef child = TreeView::triangle_ref(ref, i);
        const double key = std::max(pair.key, bound(side_of(body, child), other));
        add(opens_a ? Pair{key, child, pair.b, {}} : Pair{key, pair.a, child, {}});
    }
}

// Two pairs are opened at a time, and two later ones wait for their boxes to come from memory:
// nearly all that wait are opened some time. Not so on the way down to a first pair of triangles,
// nor where boxes meet, which may lead to a contact.
void DistanceQuery::wait_to_open(const Pair& pair, const Node* node_a, const Node* node_b) {
    Openings& openings = openings_[filled_];
    const Node** const nodes = openings.nodes.data() + 4 * openings.count;
    Opening& opening = openings.pairs[openings.count];
    const unsigned triangles_a = find_parts(a_.tree(), pair.a, node_a, nodes);
    const unsigned triangles_b = find_parts(b_.tree(), pair.b, node_b, nodes + 2);
    for (std::size_t k = 0; k < 4; ++k) {
        __builtin_prefetch(nodes[k]);
    }
    opening.pair = pair;
    opening.node_a = node_a;
    opening.node_b = node_b;
    opening.lanes = kLanesOfA[node_a != nullptr ? 3 : 1] & kLanesOfB[node_b != nullptr ? 3 : 1];
    opening.triangle_lanes = opening.lanes & (kLanesOfA[triangles_a] | kLanesOfB[triangles_b]);
    ++openings.count;
    if (is_diving() || pair.key == 0 || (openings.count == 2 && counts_.pops < kEarly)) {
        open_all(openings);
    } else if (openings.count == 2) {
        filled_ = 1 - filled_;
        open_all(openings_[filled_]);
    }
}

// Those that have waited longest; false where none does.
bool DistanceQuery::open_waiting() {
    Openings& openings = openings_[openings_[1 - filled_].count > 0 ? 1 - filled_ : filled_];
    const bool is_any = openings.count > 0;
    open_all(openings);
    return is_any;
}

void DistanceQuery::open_all(Openings& openings) {
    const std::size_t count = std::exchange(openings.count, 0);
    if (count == 0) {
        return;
    }
    EightGaps gaps;
    measure_gaps(frame_, openings.nodes, gaps);
    // What was on top of the stack stays above what was below it.
    for (std::size_t k = count; k-- > 0;) {
        const Opening& opening = openings.pairs[k];
        if (is_settled(opening.pair.key)) {
            settle(opening.pair.key);
        } else {
            add_parts(opening, gaps, 4 * k);
        }
    }
}

OBB_INLINE DistanceQuery::Pair DistanceQuery::part_of(const Opening& opening, std::size_t lane,
                                                      double key) {
    return {key,
            part_of_node(opening.pair.a, opening.node_a, kOfA[lane]),
            part_of_node(opening.pair.b, opening.node_b, kOfB[lane]),
            {}};
}

// Whether a bound in doubles is worth the while. Where it may settle a pair that floats leave open:
// faces along each other have thousands of pairs that are as near as the nearest. And where boxes
// stand for triangles, so that the least bound is an answer: that is the one in doubles then, for a
// pair with a lower one has been measured so, as those that hold it.
bool DistanceQuery::needs_doubles(const Opening& opening, std::size_t lane, double key,
                                  double error) const {
    if (is_settled(key) || (is_coarse_ ? key >= low_ : high_ - key > 4 * error)) {
        return false;
    }
    const Pair part = part_of(opening, lane, key);
    return is_coarse_ || part.a.triangle_count() + part.b.triangle_count() >= kMany;
}

double DistanceQuery::key_in_doubles(const Opening& opening, std::size_t lane) {
    const Pair part = part_of(opening, lane, 0);
    return bound(side_of(a_, part.a), side_of(b_, part.b));
}

OBB_INLINE void DistanceQuery::add_part(const Opening& opening, std::size_t lane, double key) {
    if (is_settled(key)) {
        settle(key);
        return;
    }
    const Pair part = part_of(opening, lane, key);
    if (is_stacked(part.a, part.b)) {
        stack_.push_back(part);
    } else {
        queue_.push(part, key, part.a.depth + part.b.depth);
    }
}

// The nearest part need not wait in the queue where nothing in it is nearer.
OBB_INLINE void DistanceQuery::add_part_next(const Opening& opening, std::size_t lane, double key) {
    if (is_settled(key)) {
        settle(key);
    } else if (is_diving() ||
               (key <= queue_.next_time() && (stack_.empty() || key <= stack_.back().key))) {
        stack_.push_back(part_of(opening, lane, key));
    } else {
        add_part(opening, lane, key);
    }
}

// The nearest of them is next where a dive or a stack goes on with it.
void DistanceQuery::add_parts(const Opening& opening, const EightGaps& gaps,
                              std::size_t first_lane) {
    std::array<double, 4> keys;
    const unsigned boxes = opening.lanes & ~opening.triangle_lanes;
    counts_.box_tests += static_cast<unsigned>(std::popcount(boxes));
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    float nearness = 0;
    unrolled<4>([&](auto lane) __attribute__((always_inline)) {
        if ((opening.lanes >> lane & 1U) == 0) {
            return;
        }
        double key = opening.pair.key;
        float way = 0;
        if ((boxes >> lane & 1U) != 0) {
            key = std::max(key, frame_.shrink * double{gaps.low[first_lane + lane]});
            way = gaps.nearness[first_lane + lane];
            if (needs_doubles(opening, lane, key, double{gaps.error[first_lane + lane]})) {
                key = std::max(key, key_in_doubles(opening, lane));
            }
        } else {
            key = std::max(key, key_in_doubles(opening, lane));
        }
        keys[lane] = key;
        if (key < least || (key == least && way < nearness)) {
            least = key;
            nearness = way;
            nearest = lane;
        }
    });
    unrolled<4>([&](auto lane) __attribute__((always_inline)) {
        if ((opening.lanes >> lane & 1U) != 0 && lane != nearest) {
            add_part(opening, lane, keys[lane]);
        }
    });
    add_part_next(opening, nearest, keys[nearest]);
}

} // namespace obb
