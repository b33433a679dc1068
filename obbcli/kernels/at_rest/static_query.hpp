// Do two posed trees touch, and which triangles? Dual descent; Eberly 2008 §7.1.
#pragma once

#include "at_rest/pair_stack.hpp"
#include "descent/box_lanes.hpp"
#include "descent/limits.hpp"
#include "descent/posed_tree.hpp"
#include "primitives/predicates.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace obb {

struct StaticQueryOptions {
    // Find every intersecting pair of triangles instead of stopping at the first contact.
    bool all_pairs = false;
    BoxLimits boxes{};
    // Stop after so many pairs.
    std::uint64_t limit = std::numeric_limits<std::uint64_t>::max();
    // The roots' boxes were tested, and no axis parts them.
    bool roots_may_meet = false;
};

struct TrianglePair {
    std::int64_t a, b;
    friend auto operator<=>(const TrianglePair&, const TrianglePair&) = default;
};

// The query as an object: advanced by so many pops at a time, so that callers can look at the clock
// or at a Ctrl-C in between.
class StaticQuery {
  public:
    // The trees must outlive the query. Throws std::domain_error where posed coordinates would
    // leave the range of double.
    StaticQuery(const TreeView& a, const Pose& pose_a, const TreeView& b, const Pose& pose_b,
                const StaticQueryOptions& options);

    // Takes at most so many pairs off the stack, fewer where they take long (see SliceClock); true
    // when the answer is complete.
    bool advance(std::uint64_t max_pops);

    // Of a query for all pairs without a limit: goes on breadth first until there are so many pairs
    // of nodes to look into, or none, and hands each over to a query of its own. These can be
    // advanced at the same time; join() takes over what they found. The pairs and counts are those
    // of the undivided query.
    [[nodiscard]] std::vector<StaticQuery> divide(std::size_t count);
    void join(std::span<StaticQuery> parts);

    // Pairs of rows of the mesh files, sorted; the first contact found unless all were asked for.
    [[nodiscard]] std::span<const TrianglePair> pairs() const { return pairs_; }
    [[nodiscard]] std::vector<TrianglePair> take_pairs() { return std::move(pairs_); }
    // Contact between boxes that stand for what they hold.
    [[nodiscard]] bool is_by_boxes() const { return is_by_boxes_; }
    [[nodiscard]] bool is_contact() const { return is_by_boxes_ || !pairs_.empty(); }
    // Bounds how far apart the surfaces can be where boxes met, mesh units; 0 elsewhere.
    [[nodiscard]] double error_bound() const { return error_bound_; }
    [[nodiscard]] const WalkCounts& counts() const { return counts_; }

  private:
    using Pair = NodePair;
    // A pair about to be opened: into the children of either node, or the node as it is.
    struct Opening {
        Pair pair;
        const Node *node_a, *node_b; // where opened
        unsigned lanes;              // the pairs of parts there are, a bit each by kOfA and kOfB
        unsigned triangle_lanes;     // those of them with a triangle
    };
    static constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();
    static constexpr std::size_t kMostAhead = 8;
    // A pair that was judged while it lay on the stack.
    struct Ahead {
        std::size_t place = kNowhere; // how many pairs lie under it
        Opening opening;
        std::array<const Node*, 4> nodes;
        EightVerdicts verdicts; // in the last four lanes
    };
    // So many pairs of triangles are sooner tested than the boxes between them.
    static constexpr std::uint32_t kCrowd = 16;

    void begin();
    void pop();
    void pop_alone();
    void visit(const Pair& pair);
    [[nodiscard]] bool visit_boxes(const Pair& pair);
    [[nodiscard]] const Node* box_to_open(const PosedTree& body, const NodeRef& ref,
                                          std::uint32_t max_depth) const;
    void wait_to_open(const Pair& pair, const Node* node_a, const Node* node_b);
    void open_waiting();
    void look_ahead();
    void open_first(std::size_t place);
    void open_ahead(Ahead& ahead);
    [[nodiscard]] Ahead& ahead_of(std::size_t place) { return ahead_[place % kMostAhead]; }
    void forget_ahead();
    void open(const Opening& opening, const Node* const* nodes, EightVerdicts& verdicts,
              std::size_t first_lane);
    [[nodiscard]] static Pair part_of(const Opening& opening, std::size_t lane);
    [[nodiscard]] unsigned meeting_in_doubles(const Opening& opening, unsigned lanes) const;
    [[nodiscard]] unsigned meeting_triangles(const Opening& opening, float* nearness);
    void push_meeting(const Opening& opening, const Node* const* nodes, unsigned meeting,
                      const float* nearness);
    void push_in_order(const Opening& opening, unsigned meeting);
    [[nodiscard]] bool may_triangle_meet(const NodeRef& ref_a, const NodeRef& ref_b,
                                         float& nearness) const;
    void open_leaf(const Pair& pair, bool opens_a);
    bool keep_if_intersecting(const NodeRef& ref_a, const NodeRef& ref_b,
                              const TriangleVerdict& verdict);
    void meet(const Pair& pair);
    // Not where boxes may stand for triangles.
    [[nodiscard]] bool is_crowd(const Pair& pair) const {
        return !is_coarse_ &&
               std::uint64_t{pair.a.triangle_count()} * pair.b.triangle_count() <= kCrowd;
    }
    void meet_all(const Pair& pair);
    [[nodiscard]] double distance_bound(const Pair& pair) const;
    [[nodiscard]] std::vector<Pair> take_stack();
    void stop();
    void finish();

    PosedTree a_, b_;
    StaticQueryOptions options_;
    bool is_coarse_; // boxes may stand for triangles
    RoundingBound bound_{};
    int exponent_ = 0;
    EightFrame frame_;
    PairStack stack_;
    // Popped, and opened with the next one: there are none while the stack is empty.
    std::array<Opening, 2> waiting_;
    EightNodes waiting_nodes_;
    std::size_t waiting_count_ = 0;
    std::array<Ahead, kMostAhead> ahead_; // by the place, modulo their number
    std::vector<TrianglePair> pairs_;
    bool is_by_boxes_ = false;
    bool is_finished_ = false;
    double error_bound_ = 0;
    WalkCounts counts_;
};

} // namespace obb
