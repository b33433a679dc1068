// How far apart are two posed trees? Best-first on proven lower bounds: the pair of nodes that may
// be nearest is opened first, so that the smallest key that waits bounds the distance from below.
#pragma once

#include "at_rest/static_query.hpp"
#include "descent/bound_queue.hpp"
#include "descent/limits.hpp"
#include "descent/tie_search.hpp"
#include "distance/gap_lanes.hpp"
#include "distance/triangle_blocks.hpp"
#include "nearest/closest_points.hpp"
#include "shapes/pose.hpp"
#include "tree/tree.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace obb {

// What is proven at any time: the surfaces, with their vertices posed and rounded to double, are at
// least `low` and at most `high` apart, in mesh units. Both are 0 if and only if two triangles have
// been proven to intersect. `point_a` and `point_b` are where `high` was measured.
struct DistanceBounds {
    double low;
    double high;
    Vec3 point_a, point_b;
    std::int64_t triangle_a, triangle_b;
};

class DistanceQuery {
  public:
    // The trees must outlive the query. Throws std::domain_error where posed coordinates would
    // leave the range of double.
    DistanceQuery(const TreeView& a, const Pose& pose_a, const TreeView& b, const Pose& pose_b,
                  const Limits& limits);

    // Takes at most so many pairs off the queue, fewer where they take long (see SliceClock); true
    // when the bounds are as close as asked, or as rounding, boxes for triangles and the depth
    // limits allow.
    bool advance(std::uint64_t max_pops);

    // Throws std::domain_error where the distance exceeds the largest double.
    [[nodiscard]] DistanceBounds bounds() const;
    [[nodiscard]] const WalkCounts& counts() const { return counts_; }

  private:
    // Of nodes with at most so many triangles all pairs are looked at, rather than smaller boxes.
    static constexpr std::uint32_t kFew = TriangleBlock::kMost;
    // A search that takes more pops than this does pairs of so few triangles depth-first: the queue
    // costs more than it saves once the least distance is about known.
    static constexpr std::uint64_t kPatience = 512;
    static constexpr std::uint32_t kSmall = 512;
    // Lengths within the query are in its unit: mesh units times 2^-exponent_.
    struct Pair {
        double key; // proven: nothing in `a` is nearer to anything in `b`
        NodeRef a, b;
        NearFeatures features;  // where two triangles were measured: only more digits tell more
        std::uint32_t next = 0; // of a leaf that is opened, the first triangle not yet added
    };
    // Where the least distance was found.
    struct Incumbent {
        NodeRef a, b;
        NearFeatures features;
        bool is_measured;           // with twice the digits
        bool is_fine;               // whether the direction is known
        Vector3<Twofold> direction; // from A to B
    };
    // A node as the tests see it: its box, or the triangle that needs none.
    struct Side {
        NodeRef ref;
        Obb box;
        Triangle triangle; // in the frame of the boxes
    };

    // A pair about to be opened: into the children of either node, or the node as it is.
    struct Opening {
        Pair pair;
        const Node *node_a, *node_b; // where opened
        unsigned lanes;              // the pairs of parts there are, a bit each by kOfA and kOfB
        unsigned triangle_lanes;     // those of them with a triangle
    };
    // Two at most, which are opened together.
    struct Openings {
        std::array<Opening, 2> pairs;
        EightNodes nodes;
        std::size_t count = 0;
    };
    struct Candidate {
        double low;
        std::uint32_t pair; // of two blocks, see second_of_pair()
    };

    [[nodiscard]] bool is_diving() const { return high_ > std::numeric_limits<double>::max(); }
    [[nodiscard]] Pair pop();
    void visit(const Pair& pair);
    void part(const Pair& pair);
    [[nodiscard]] const Node* box_to_open(const PosedTree& body, const NodeRef& ref,
                                          std::uint32_t max_depth) const;
    void open_leaf(const Pair& pair, bool opens_a);
    void wait_to_open(const Pair& pair, const Node* node_a, const Node* node_b);
    [[nodiscard]] bool open_waiting();
    void open_all(Openings& openings);
    void add_parts(const Opening& opening, const EightGaps& gaps, std::size_t first_lane);
    void add_part(const Opening& opening, std::size_t lane, double key);
    void add_part_next(const Opening& opening, std::size_t lane, double key);
    [[nodiscard]] static Pair part_of(const Opening& opening, std::size_t lane, double key);
    [[nodiscard]] bool needs_doubles(const Opening& opening, std::size_t lane, double key,
                                     double error) const;
    [[nodiscard]] double key_in_doubles(const Opening& opening, std::size_t lane);
    [[nodiscard]] bool is_stacked(const NodeRef& a, const NodeRef& b) const {
        return counts_.pops > kPatience && a.triangle_count() + b.triangle_count() <= kSmall;
    }
    void stop();
    void measure_all(const Pair& pair);
    [[nodiscard]] std::uint32_t keep_by_edges(const TriangleBlock& a, const TriangleBlock& b,
                                              std::span<Candidate> candidates);
    void keep_unsettled(Candidate candidate, std::span<Candidate> candidates, std::uint32_t& kept);
    void measure_one(const Pair& pair, const Triangle& a, const Triangle& b);
    void refine(const Pair& pair);
    void close(const Pair& pair);

    [[nodiscard]] Side side_of(const PosedTree& body, const NodeRef& ref) const;
    [[nodiscard]] double bound(const Side& a, const Side& b);
    [[nodiscard]] double high_in_unit(double length, int exponent) const;
    [[nodiscard]] double low_in_unit(double length, int exponent) const;

    // Whether a lower bound is as good as the least distance found.
    [[nodiscard]] bool is_settled(double key) const { return high_ - key <= slack_; }
    [[nodiscard]] double slack() const; // of the least distance
    [[nodiscard]] bool has_many_ties() const;

    // Faces along each other, of which boxes cannot tell whether any two are nearer than the rest:
    // all vertices of both nodes are looked at, along the direction that the least distance has.
    [[nodiscard]] bool may_tie(const Pair& pair) const;
    [[nodiscard]] bool are_sides_apart(const Pair& pair);
    void look_for_tie(const Pair& pair);
    void wait_for(const Pair& candidate, const Pair& pair);
    void end_wait();
    void refine_incumbent();
    [[nodiscard]] bool are_boxes_apart(const Pair& pair) const;
    [[nodiscard]] double all_apart(const Pair& pair) const;
    void settle(double key) { low_ = std::min(low_, key); }
    void add(const Pair& pair);
    [[nodiscard]] Vec3 in_unit(const Vec3& v) const {
        return unit_factors_[1] * (unit_factors_[0] * v);
    }
    bool take(const TriangleDistance& found, const NodeRef& a, const NodeRef& b);
    void touch(const NodeRef& a, const NodeRef& b);

    PosedTree a_, b_;
    BoxLimits boxes_;
    RoundingBound bound_{};
    double shrink_ = 1; // a distance of boxes in their frame times this is one in the world
    int exponent_ = 0;
    double unit_ = 0; // 2^-exponent_; 0 where products with it may underflow
    std::array<double, 2> unit_factors_{1, 1}; // of which the product is 2^-exponent_
    GapFrame frame_;
    double tolerance_ = 0;
    bool is_coarse_; // boxes may stand for triangles
    TriangleBlocks blocks_a_, blocks_b_;
    BoundQueue<Pair> queue_;  // by their keys
    std::vector<Pair> stack_; // small pairs, done before the queue goes on
    // Popped, and opened when two more have been: their boxes come from memory meanwhile.
    std::array<Openings, 2> openings_;
    std::size_t filled_ = 0;                                // which of them takes the next
    double low_ = std::numeric_limits<double>::infinity();  // least bound of what is settled
    double high_ = std::numeric_limits<double>::infinity(); // between explicit points
    double slack_ = -1;                                     // slack(), once there are such points
    DistanceBounds best_{};
    Incumbent incumbent_{};
    std::array<TieCrowd, 2> crowds_; // before there are many ties, and from then on
    std::optional<TieWait<Pair>> wait_;
    WalkCounts counts_;
};

} // namespace obb
