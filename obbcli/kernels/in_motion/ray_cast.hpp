// When do two trees first touch of which neither turns? The one travels along a line as the other
// sees it, so that boxes and triangles meet for one stretch of time: a ray cast. Entries and exits
// of boxes lead down, depth first and the nearest on top; of triangles doubles tell the latest
// possible entry, and exact arithmetic decides among those that may come first.
#pragma once

#include "descent/limits.hpp"
#include "in_motion/box_entries.hpp"
#include "in_motion/contact.hpp"
#include "in_motion/contact_list.hpp"
#include "in_motion/moving_pair.hpp"
#include "in_motion/ray_boxes.hpp"
#include "in_motion/ray_frontier.hpp"
#include "in_motion/tie_planes.hpp"
#include "primitives/moving_lanes.hpp"
#include "work/slice.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace obb {

struct RayCastOptions {
    // Any proof of contact will do; how early it is does not matter.
    bool any_contact = false;
    // The first contact of every pair of triangles, one after the other: the earliest boxes go
    // first then, so that contacts can be told in order before all are known.
    bool each_pair = false;
};

// Times are scaled, as MovingPair says. Every call takes the pair that the cast began with.
class RayCast {
  public:
    // Whether a pair is in the range of what is computed here: its positions in the world are no
    // more than 2^90 times its size.
    [[nodiscard]] static bool suits(const MovingPair& pair);

    RayCast(const MovingPair& pair, const RayCastOptions& options);

    // As ContactQuery::advance().
    bool advance(MovingPair& pair, std::uint64_t max_pops, double until);

    // No contact in [0, lower_bound()): proven at any moment.
    [[nodiscard]] double lower_bound() const { return lower_bound_; }
    [[nodiscard]] const std::optional<Contact>& contact() const { return exact_; }
    // With `each_pair`: the next contact in order of `low`, once no other can come before it.
    [[nodiscard]] std::optional<Contact> take();
    [[nodiscard]] const WalkCounts& counts() const { return counts_; }

  private:
    // Triangles that may touch: not before `low`.
    struct Candidate {
        double low;
        NodeRef a, b;

        friend bool operator<(const Candidate& x, const Candidate& y) { return x.low > y.low; }
    };
    using Entry = RayEntry;
    // One or two parts of a node.
    struct Parts {
        std::array<NodeRef, 2> refs;
        std::size_t count;
    };
    // A pair of small nodes that waits until another one is opened too: both in lanes at once.
    struct Waiting {
        Entry entry;
        Parts a, b;
    };
    // So many pairs of triangles are sooner tested than the boxes between them.
    static constexpr std::uint32_t kCrowd = 16;

    [[nodiscard]] static Parts parts_of(const TreeView& tree, const NodeRef& ref,
                                        const Node* opened);
    void visit(MovingPair& pair, const Entry& entry);
    void take_tie(MovingPair& pair, TiePlanes::Verdict verdict);
    void part(MovingPair& pair, const Entry& entry);
    void open(MovingPair& pair, const Entry& entry, const Node* node_a, const Node* node_b);
    [[nodiscard]] bool is_opening_due() const;
    void open_waiting();
    void open_leaf(MovingPair& pair, const Entry& entry, bool opens_a);
    [[nodiscard]] BoxEntries entries_of(MovingPair& pair, const Entry& entry, const Parts& a,
                                        const Parts& b) const;
    [[nodiscard]] bool narrow(const Entry& entry, double first, double last, Entry& part) const;
    void push_meeting(MovingPair& pair, const Entry& entry, const Parts& a, const Parts& b);
    void push_in_order(std::span<const Entry> parts);
    void meet(MovingPair& pair, const Entry& entry);
    void meet_pairs(MovingPair& pair, const Entry& entry, std::span<const PairRef> refs,
                    std::span<const Triangle* const> a, std::span<const Triangle* const> b);
    void add_unsure(MovingPair& pair, const Entry& entry);
    void add(const Candidate& candidate);
    [[nodiscard]] bool is_next_due() const;
    [[nodiscard]] bool is_candidate_due() const;
    [[nodiscard]] Candidate take_candidate();
    void solve(const MovingPair& pair);
    void keep(const MovingPair& pair, const Candidate& candidate, const Contact& contact,
              const Touch& touch);
    void drop_late();
    [[nodiscard]] bool has_ended();
    [[nodiscard]] bool is_ready() const { return found_.next_low() < next_time(); }
    [[nodiscard]] double next_time() const;

    RayCastOptions options_;
    double duration_;
    ClosingMotion motion_;
    std::array<double, 2> vertex_scales_; // mesh units to scaled ones, in two factors
    double relative_;                     // rounding of a projection of boxes
    std::optional<RayFrame> frame_;       // once it is needed
    RayFrontier frontier_;
    std::array<Waiting, 2> waiting_;
    std::array<RayOpening, 2> openings_; // of these
    std::size_t waiting_count_ = 0;
    std::vector<Candidate> candidates_;                       // a heap, the earliest first
    double latest_ = std::numeric_limits<double>::infinity(); // some contact comes no later
    std::optional<Candidate> front_runner_; // which surely touches by then, if not solved yet
    std::optional<Contact> exact_;          // the earliest that is known exactly
    TiePlanes ties_;                        // of that
    std::optional<Entry> looked_at_;        // the pair that a tie is looked for
    bool is_close_ = false;                 // whether floats say too little of what comes first
    std::uint64_t patience_, waits_;        // pops, and until when
    ContactList found_;                     // with `each_pair`
    double lower_bound_ = 0;
    bool is_finished_ = false;
    WalkCounts counts_;
};

} // namespace obb
