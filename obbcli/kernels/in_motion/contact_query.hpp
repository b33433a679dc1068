// When do two moving trees first touch? Best-first advancement on separating axes: every pair in
// the queue carries a time before which it is proven apart, so the smallest is a bound for the
// bodies.
#pragma once

#include "descent/bound_queue.hpp"
#include "descent/limits.hpp"
#include "descent/recent_vertices.hpp"
#include "in_motion/box_steps.hpp"
#include "in_motion/contact_plane.hpp"
#include "in_motion/moving_tree.hpp"
#include "in_motion/triangle_advancement.hpp"
#include "work/slice.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <unordered_set>
#include <vector>

namespace obb {

struct ContactQueryOptions {
    double duration = 0;
    // Width asked of the bracket around the first contact, s.
    double time_tolerance = 0;
    Limits limits{};
    // Any proof of contact will do; how early it is does not matter.
    bool any_contact = false;
    // Not the bodies' first contact alone: that of every pair of triangles, one after the other.
    bool each_pair = false;
};

enum class Evidence : std::uint8_t { kNone, kIntersecting, kWithinTolerance, kBoxes };

// A proven bracket of the first contact: none before `low`, and contact at `high` as `evidence`
// says. Where `distance` exceeds the clearance, contact is not proven: the triangles are in contact
// by `high`, or they pass each other and have parted by then. Times in s.
struct Contact {
    double low = 0;
    double high = 0;
    Evidence evidence = Evidence::kNone;
    NodeRef a{}, b{};
    double distance = 0;    // proven bound on the distance at `high`, mesh units; 0 if intersecting
    double error_bound = 0; // of boxes that met: how far apart the surfaces can be, mesh units
    std::uint32_t triangle_a = 0, triangle_b = 0; // rows of the mesh files; 0 where boxes met
};

// What is to be said of the place of a contact, world coordinates at its time. NaN where nothing
// is.
struct ContactPlace {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    static constexpr Vec3 kNowhere{kNone, kNone, kNone};

    Vec3 point_a = kNowhere, point_b = kNowhere;
    Vec3 normal = kNowhere;                        // unit, from A to B
    Vec3 normal_a = kNowhere, normal_b = kNowhere; // unit face normals, outward of the contact
    FeatureCode feature = kNoFeature;
    Vec3 point = kNowhere; // midway between point_a and point_b
};

class ContactQuery {
  public:
    // The trees must outlive the query. But for `each_pair` it asks about times later than 0: the
    // bodies must be known to be apart at 0. Throws std::domain_error where positions would leave
    // the range of double.
    ContactQuery(const TreeView& a, const Pose& pose_a, const Screw& screw_a, const TreeView& b,
                 const Pose& pose_b, const Screw& screw_b, const ContactQueryOptions& options);

    // Takes at most so many pairs from the queue, fewer where they take long (see SliceClock), and
    // none once the lower bound exceeds `until`, s; true when the answer is complete. With
    // `each_pair` it also ends, and returns false, when a contact is ready to be taken.
    bool advance(std::uint64_t max_pops, double until = std::numeric_limits<double>::infinity());

    // With `each_pair`: the next contact in order of `low`, once no other can come before it.
    [[nodiscard]] std::optional<Contact> take();

    // No contact in [0, lower_bound()): proven at any moment; the duration when proven apart.
    [[nodiscard]] double lower_bound() const;
    // The motion is too fast to be followed in doubles: nothing is known beyond lower_bound().
    [[nodiscard]] bool has_given_up() const { return has_given_up_; }
    [[nodiscard]] const std::optional<Contact>& contact() const { return contact_; }
    // Where a contact that this query found is, at its `low`.
    [[nodiscard]] ContactPlace place(const Contact& contact);
    [[nodiscard]] const WalkCounts& counts() const { return counts_; }

  private:
    // A pair that is proven apart before `time`. From `end` on, unless that is the duration, an
    // entry for the pair it came from sees to it, if the window they share says that it has to.
    struct Entry {
        double time, end;
        NodeRef a, b;
        std::uint32_t window = 0;
        std::uint32_t opened = 0;   // the window that it was opened for before
        std::uint32_t reopened = 0; // how often since the two were last seen to have parted
        std::uint32_t next = 0;     // of a leaf that is opened, the first triangle not yet pushed
    };

    // A plane that parts what touches at the time of the earliest contact so far, and, in the
    // query's units from the bodies' pivots, up to where A reaches along it and from where on B.
    struct Tie {
        ContactPlane plane;
        Vec3 normal;
        double top_of_a, bottom_of_b;
    };
    // A pair whose vertices are being compared with a plane.
    struct Wait {
        Entry candidate; // the pair, or the bodies as a whole
        Entry entry;
        std::size_t plane;
        std::array<Preparation, 2> preparations;
        std::uint32_t next_a, next_b;
        std::array<SeenLately, 2> seen;
    };

    // Bounds on the distance of two triangles, mesh units, and the direction from A's nearest point
    // to B's; zeros where they may intersect.
    struct Gap {
        double low, high;
        Vec3 direction;
    };
    // How long a pair that is near stays so: it is near at `last`, and at `end`, if not in contact,
    // it is proven no longer to be near, unless that is the duration.
    struct Nearness {
        double last, end;
        bool is_contact; // whether it is proven to be in contact at `end`
    };

    void set_units();
    void set_motion();
    void set_time(double time);
    [[nodiscard]] MovingFrame frame(double absolute, double time) const;
    [[nodiscard]] bool is_open(const TreeView& tree, const NodeRef& ref,
                               std::uint32_t max_depth) const;
    [[nodiscard]] static double size_of(const MovingTree& body, const NodeRef& ref);
    [[nodiscard]] std::optional<double> later(const Entry& entry, double step);
    void push(const Entry& entry);
    void visit(const Entry& entry);
    void part(const Entry& entry);
    [[nodiscard]] LinearMotion linear_motion() const;
    void set_planes(const Entry& entry, const Touch& touch);
    [[nodiscard]] static double top_of(const Triangle& t, Vec3 direction);
    [[nodiscard]] bool may_tie(const Entry& entry) const;
    [[nodiscard]] bool are_sides(const Entry& entry, const Tie& tie) const;
    void look_for_tie(const Entry& entry);
    [[nodiscard]] bool waits_for(const Entry& candidate, const Entry& entry, std::size_t plane);
    [[nodiscard]] bool has_limits() const;
    void probe(const Entry& entry);
    [[nodiscard]] Entry nearer_half(const Entry& entry, bool opens_a);
    [[nodiscard]] bool end_wait(SliceClock& clock);
    template <bool kOpensA>
    void open(Entry entry);
    [[nodiscard]] double window(const Entry& entry) const;
    void close_after(Entry& entry, double wide);
    void place(const std::array<NodeRef, 2>& a, const std::array<NodeRef, 2>& b);
    void place_triangles(const MovingTree& body, const std::array<NodeRef, 2>& parts,
                         std::size_t lane);
    [[nodiscard]] double step_of_boxes(const Entry& entry, double margin);
    [[nodiscard]] bool is_over(const Entry& entry);
    void meet_triangles(const Entry& entry);
    void meet_in_translation(const Entry& entry);
    void meet_within_clearance(const Entry& entry);
    void solve_within_clearance(const Entry& entry);
    void keep(const Contact& contact);
    void meet_boxes(const Entry& entry);
    [[nodiscard]] bool meet_at_start(const Entry& entry);
    [[nodiscard]] bool prove_contact(const Entry& entry);
    [[nodiscard]] bool surely_intersect_at(const Entry& entry, double time);
    [[nodiscard]] Gap gap_at(const Entry& entry, double time);
    [[nodiscard]] Nearness nearness_from(const Entry& entry, double near);
    [[nodiscard]] bool has_ended();
    [[nodiscard]] static std::uint64_t key_of(const NodeRef& a, const NodeRef& b);
    [[nodiscard]] bool is_ready() const;
    void name_triangles(Contact& contact) const;
    void report(Contact contact);
    [[nodiscard]] std::optional<Contact> soon_after(std::span<const Entry> stalled);
    [[nodiscard]] std::optional<Contact> undecided(std::span<const Entry> stalled);
    [[nodiscard]] Contact as_near(std::span<const Entry> stalled, double low, double high);
    [[nodiscard]] std::optional<Contact> of_patches(std::span<const Entry> stalled, double reach);
    [[nodiscard]] bool surely_meets_patch(std::span<const Entry> patch, bool shares_a, double time);
    void stall(const Entry& entry);
    [[nodiscard]] bool is_near_enough(const Entry& entry);
    void end_stalled(const Entry& entry);
    void settle_stalled(double next);
    void give_up(double time);
    void finish(std::optional<Contact> contact);
    [[nodiscard]] Contact in_seconds(Contact contact) const;
    [[nodiscard]] ContactPlace place_of_triangles(const Contact& contact);
    [[nodiscard]] ContactPlace place_in_translation(const Contact& contact) const;
    [[nodiscard]] ContactPlace place_of_boxes(const Contact& contact);
    [[nodiscard]] Vec3 in_world(Vec3 point, double low) const;
    [[nodiscard]] double triangle_error(const SpinningTriangle& a, const SpinningTriangle& b) const;

    MovingTree a_, b_;
    // Apart from this object, which Python aligns no better than other objects.
    std::unique_ptr<LaneMotion> motion_ = std::make_unique<LaneMotion>();
    std::unique_ptr<BasicObb<Four>> boxes_ = std::make_unique<BasicObb<Four>>(); // of the parts
    ContactQueryOptions options_;
    // In the query's units.
    double duration_ = 0, time_tolerance_ = 0, distance_tolerance_ = -1, clearance_ = 0;
    int length_exponent_ = 0, time_exponent_ = 0;
    Vec3 pivot_between_{0, 0, 0}, closing_velocity_{0, 0, 0};
    double relative_ = 0, between_error_ = 0;
    bool is_translation_ = false;
    double time_ = -1; // that the bodies are at

    TimeQueue<Entry> queue_;
    std::vector<bool> is_needed_; // of windows: whether not all in it was proven apart for good
    std::vector<std::uint32_t> free_windows_;
    std::optional<Entry> proof_; // the earliest pair proven to intersect, and when
    std::optional<Contact> exact_;
    std::vector<Tie> planes_; // of that
    std::uint64_t next_probe_ = 0;
    std::uint64_t tie_pops_ = 0;
    bool may_all_tie_ = false;    // whether the bodies as a whole were not looked at yet
    std::uint32_t tie_limit_ = 0; // how many triangles may be looked at for a tie
    std::optional<Wait> wait_;
    std::vector<Entry> stalled_; // pairs that rounding lets nobody push on, earliest first
    double stall_end_ = 0;       // once all pairs are past this time, the stalled ones are settled
    std::uint64_t stall_pops_ = 0; // or after so many pops
    std::optional<Contact> near_;  // what is known of them then
    bool is_near_proven_ = false;  // whether it is contact for certain, at the end of its bracket
    std::uint64_t exact_pops_ = 0; // when `exact_` was found
    std::vector<Contact> found_;              // of `each_pair`, not taken yet
    std::unordered_set<std::uint64_t> known_; // the pairs of all contacts found
    std::optional<Contact> contact_;
    double lower_bound_ = 0;
    bool is_finished_ = false;
    bool has_given_up_ = false;
    WalkCounts counts_;
};

} // namespace obb
