// How near do two moving trees come? Best-first on proven lower bounds over pairs of nodes and
// intervals of time: the pair that may come nearest is looked at next.
#pragma once

#include "clearance/interval_bounds.hpp"
#include "clearance/time_spans.hpp"
#include "descent/bound_queue.hpp"
#include "descent/limits.hpp"
#include "in_motion/moving_pair.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace obb {

struct ClearanceOptions {
    double from = 0, until = 0;     // s; the closed interval that is asked about
    double tolerance = 1e-6;        // asked of the bracket's width, relative to its upper end
    std::optional<double> at_least; // mesh units; ask only whether the distance is so large
    double high = HUGE_VAL;         // mesh units; a distance known to be attained elsewhere
    double slack = 0;               // mesh units; by what the true paths may be off these
};

// Where the least distance was found: at a time in s, between points in the world.
struct ClearanceWitness {
    double seconds;
    Vec3 point_a, point_b;
    std::uint32_t triangle_a, triangle_b;
};

// At any moment no distance in the interval is below low(), and one is at most high(), between the
// points of the witness. Where triangles are proven to intersect at some time both are 0.
class ClearanceQuery {
  public:
    // The trees must outlive it. Throws std::domain_error where positions would leave the range of
    // double.
    ClearanceQuery(const TreeView& a, const Pose& pose_a, const Screw& screw_a, const TreeView& b,
                   const Pose& pose_b, const Screw& screw_b, const ClearanceOptions& options);

    // Takes at most so many pairs off the queue, fewer where they take long; true when the bracket
    // is as narrow as asked, or as rounding allows, or shows what `at_least` asks. Where slices end
    // makes no difference.
    bool advance(std::uint64_t max_pops);

    // Mesh units. Infinite where nothing is known yet: `high` of what has no triangle within reach
    // of the distance known from elsewhere.
    [[nodiscard]] double low() const;
    [[nodiscard]] double high() const;
    [[nodiscard]] bool is_contact() const { return is_contact_; }
    [[nodiscard]] std::optional<ClearanceWitness> witness() const;
    // Outside of these times, in s, all distances are proven to be above `limit`, in mesh units,
    // which must be no more than any of high() and the distance known from elsewhere.
    [[nodiscard]] std::vector<TimeSpan> when(double limit) const;
    [[nodiscard]] const WalkCounts& counts() const { return counts_; }

  private:
    // Lengths and times within the query are in the moving pair's units.
    struct Item {
        double key;         // proven: no distance of the two in the interval is less
        double gap, travel; // of boxes: at the middle, and how far they move in half of it
        TimeSpan span;
        NodeRef a, b;
        std::uint32_t next; // of a leaf that is opened, the first triangle not yet added
    };
    using Queue = BoundQueue<Item>;

    [[nodiscard]] double bar() const;
    [[nodiscard]] double known_high() const { return std::min(high_, given_high_); }
    [[nodiscard]] bool is_settled(double key) const { return key >= bar(); }
    [[nodiscard]] bool is_answered() const;
    [[nodiscard]] double least_open() const;

    void dive(double time);
    void visit(const Item& item);
    [[nodiscard]] bool halves(const Item& item) const;
    void halve(const Item& item);
    void open(const Item& item);
    void open_leaf(const Item& item, bool opens_a);
    [[nodiscard]] IntervalFrame frame_of(const TimeSpan& span);
    void add_children(const Item& item, const IntervalFrame& frame, const std::array<NodeRef, 2>& a,
                      const std::array<NodeRef, 2>& b, std::size_t count);
    void add_bounded(Item item, const IntervalFrame& frame, const Obb& a, const Obb& b);
    void add_triangles(Item item, const IntervalFrame& frame);
    void add(const Item& item);
    void settle(const Item& item);
    // How far apart two triangles are at a time, proven; this takes it where it is less than all
    // before, and ends the search where they are proven to intersect.
    double look(const PairRef& pair, double time, const PlacedTriangles& placed,
                const TriangleDistance& near);
    void refine(const PairRef& pair, double time, double reach);
    void end_in_contact(const PairRef& pair, double time);

    MovingPair pair_;
    TimeSpan whole_{0, 0};
    double slack_, given_high_, share_, floor_ = 0;
    std::optional<double> at_least_;
    double turning_; // speed of both spins together; 0 where both turn together
    Queue queue_;
    std::vector<Item> stack_; // small pairs, done before the queue goes on
    Queue* diving_ = nullptr; // what items go to while one moment alone is looked at
    TimeSpans spans_;
    double settled_ = std::numeric_limits<double>::infinity();
    double high_ = std::numeric_limits<double>::infinity();
    double refined_ = std::numeric_limits<double>::infinity(); // high_ when last refined
    bool is_contact_ = false;
    std::optional<ClearanceWitness> witness_;
    WalkCounts counts_;
};

} // namespace obb
