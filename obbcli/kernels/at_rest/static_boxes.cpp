// The boxes of a question at rest: which parts of a pair that is opened may meet.
#include "at_rest/static_query.hpp"

#include "descent/opening.hpp"
#include "numbers/registers.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>

namespace obb {

namespace {

// Boxes that rounding to floats leaves undecided are tested in doubles where one of them holds more
// triangles than this; else they are sooner opened.
constexpr std::uint32_t kMany = 512;

// How many bits are set.
constexpr std::array<unsigned, 16> kCounts{0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

} // namespace

OBB_INLINE StaticQuery::Pair StaticQuery::part_of(const Opening& opening, std::size_t lane) {
    return {part_of_node(opening.pair.a, opening.node_a, kOfA[lane]),
            part_of_node(opening.pair.b, opening.node_b, kOfB[lane])};
}

// The nearest comes on top, the others in the order of the lanes. A branch a lane, of which the
// processor guesses the outcome, is faster than to wait for it.
OBB_INLINE void StaticQuery::push_meeting(const Opening& opening, const Node* const* nodes,
                                          unsigned meeting, const float* nearness) {
    float least = std::numeric_limits<float>::infinity();
    std::size_t nearest = 0;
    unrolled<4>([&](auto lane) __attribute__((always_inline)) {
        if ((meeting >> lane & 1U) != 0) {
            fetch_children(a_.tree(), *nodes[kOfA[lane]]);
            fetch_children(b_.tree(), *nodes[2 + kOfB[lane]]);
            stack_.push_back(part_of(opening, lane));
            if (nearness[lane] <= least) {
                least = nearness[lane];
                nearest = stack_.size();
            }
        }
    });
    if (nearest > 0 && nearest < stack_.size()) {
        std::swap(stack_[nearest - 1], stack_.back());
    }
}

// The farthest first; the order of equal ones is that of the children. In doubles, for which of the
// boxes meets first may be all that is told.
void StaticQuery::push_in_order(const Opening& opening, unsigned meeting) {
    constexpr std::array<std::size_t, 4> kByChildren{0, 2, 3, 1};
    const auto middle = [](const PosedTree& body, const NodeRef& ref) {
        if (!ref.is_triangle()) {
            return body.box(body.tree().nodes[ref.slot]).center;
        }
        const Triangle t = body.triangle_in_frame(ref);
        return (1.0 / 3.0) * (t[0] + t[1] + t[2]);
    };
    std::array<std::pair<double, std::size_t>, 4> lanes;
    std::size_t count = 0;
    for (const std::size_t lane : kByChildren) {
        if ((meeting >> lane & 1U) == 0) {
            continue;
        }
        const Pair pair = part_of(opening, lane);
        const double distance = norm_1(middle(a_, pair.a) - middle(b_, pair.b));
        std::size_t place = count++;
        for (; place > 0 && lanes[place - 1].first < distance; --place) {
            lanes[place] = lanes[place - 1];
        }
        lanes[place] = {distance, lane};
    }
    for (std::size_t k = 0; k < count; ++k) {
        stack_.push_back(part_of(opening, lanes[k].second));
    }
}

OBB_INLINE void StaticQuery::open(const Opening& opening, const Node* const* nodes,
                                  EightVerdicts& verdicts, std::size_t first_lane) {
    const unsigned unsure_lanes = is_coarse_ ? verdicts.open : verdicts.open_by_faces;
    float* const nearness = verdicts.nearness.data() + first_lane;
    const unsigned boxes = opening.lanes & ~opening.triangle_lanes;
    counts_.box_tests += kCounts[boxes];
    unsigned meeting = boxes & ~(verdicts.apart >> first_lane);
    if (const unsigned unsure = meeting & (unsure_lanes >> first_lane); unsure != 0) {
        meeting ^= unsure ^ meeting_in_doubles(opening, unsure);
    }
    if (opening.triangle_lanes != 0) {
        meeting |= meeting_triangles(opening, nearness);
    }
    if (is_coarse_) {
        push_in_order(opening, meeting);
    } else {
        push_meeting(opening, nodes, meeting, nearness);
    }
}

void StaticQuery::open_waiting() {
    EightVerdicts verdicts;
    judge_boxes(frame_, waiting_nodes_, verdicts);
    // What was on top of the stack stays above what was below it.
    for (std::size_t k = waiting_count_; k-- > 0;) {
        open(waiting_[k], waiting_nodes_.data() + 4 * k, verdicts, 4 * k);
    }
    waiting_count_ = 0;
}

// Opens the first of the pairs that wait; what is judged of the second, at a place of the stack, is
// kept until its turn comes.
void StaticQuery::open_first(std::size_t place) {
    Ahead& ahead = ahead_of(place);
    judge_boxes(frame_, waiting_nodes_, ahead.verdicts);
    ahead.place = place;
    ahead.opening = waiting_[1];
    std::copy_n(waiting_nodes_.begin() + 4, 4, ahead.nodes.begin());
    waiting_count_ = 0;
    open(waiting_[0], waiting_nodes_.data(), ahead.verdicts, 0);
}

// Opens a pair that was judged before its turn, which has come.
void StaticQuery::open_ahead(Ahead& ahead) {
    ahead.place = kNowhere;
    open(ahead.opening, ahead.nodes.data(), ahead.verdicts, 4);
}

// Those of some pairs of boxes that doubles do not prove apart, if that is worth the while.
unsigned StaticQuery::meeting_in_doubles(const Opening& opening, unsigned lanes) const {
    unsigned meeting = 0;
    for (; lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        const Pair pair = part_of(opening, lane);
        const bool is_small =
            !is_coarse_ && std::max(pair.a.triangle_count(), pair.b.triangle_count()) <= kMany;
        const bool meets = is_small || !are_separated(a_.box(a_.tree().nodes[pair.a.slot]),
                                                      b_.box(b_.tree().nodes[pair.b.slot]), bound_);
        meeting |= static_cast<unsigned>(meets) << lane;
    }
    return meeting;
}

// Of the pairs with a triangle, which has no box.
unsigned StaticQuery::meeting_triangles(const Opening& opening, float* nearness) {
    unsigned meeting = 0;
    for (unsigned lanes = opening.triangle_lanes; lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        const Pair pair = part_of(opening, lane);
        counts_.box_tests += pair.a.is_triangle() && pair.b.is_triangle() ? 0 : 1;
        const bool meets = may_triangle_meet(pair.a, pair.b, nearness[lane]);
        meeting |= static_cast<unsigned>(meets) << lane;
    }
    return meeting;
}

} // namespace obb
