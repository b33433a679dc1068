// When do two moving trees first touch? Best-first advancement on separating axes: every pair in
// the queue carries a time before which it is proven apart, so the smallest is a bound for the
// bodies. Where neither turns, a ray cast takes its place.
#pragma once

#include "descent/bound_queue.hpp"
#include "descent/limits.hpp"
#include "in_motion/contact.hpp"
#include "in_motion/contact_list.hpp"
#include "in_motion/contact_place.hpp"
#include "in_motion/moving_pair.hpp"
#include "in_motion/nearness.hpp"
#include "in_motion/ray_cast.hpp"
#include "in_motion/screw_search.hpp"
#include "in_motion/tie_planes.hpp"
#include "in_motion/windows.hpp"
#include "work/slice.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
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
    // Pairs of boxes to be tested before it is asked whether the bodies move on a common screw.
    // Nothing: as many as they have triangles, so that quick questions pay nothing for it.
    std::optional<std::uint64_t> box_tests_before_screw = std::nullopt;
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
    [[nodiscard]] ContactPlace place(const Contact& contact) { return place_of(pair_, contact); }
    [[nodiscard]] const WalkCounts& counts() const { return counts_; }

  private:
    // A pair of nodes, a node and a triangle, or two triangles, which waits in the queue. Its
    // invariant: the pair is proven apart in [0, time), and the search answers for it in
    // [time, end]. An entry whose end is before the duration lies in a window: the pair that the
    // window was opened for waits in the queue too, with the window's end as its time, and answers
    // for what comes later. It is looked at then only if some entry in the window needed it, that
    // is, reached `end` without being proven apart until the duration.
    struct Entry {
        double time, end;
        NodeRef a, b;
        std::uint32_t window = Windows::kWhole; // the one that the entry lies in
        std::uint32_t opened = Windows::kWhole; // the one that was opened for this pair before
        std::uint32_t reopened = 0; // how many windows were, since the two last moved apart
        std::uint32_t next = 0;     // of a leaf that is opened: its first triangle not yet pushed
        ImagePair images{};         // of two triangles on a screw: they meet in its windows only

        [[nodiscard]] PairRef refs() const { return {a, b}; }
    };

    [[nodiscard]] bool is_ray_cast() const;
    bool advance_cast(std::uint64_t max_pops, double until);
    [[nodiscard]] bool is_open(const TreeView& tree, const NodeRef& ref,
                               std::uint32_t max_depth) const;
    [[nodiscard]] std::optional<double> later(const Entry& entry, double step);
    [[nodiscard]] double next_time() const;
    [[nodiscard]] bool is_asking_screw() const { return screw_ != nullptr && !screw_->is_made(); }
    [[nodiscard]] bool is_screw_due() const;
    void ask_screw();
    [[nodiscard]] bool make_images(SliceClock& clock);
    void advance_images();
    [[nodiscard]] std::optional<double> in_window(const Entry& entry, double time) const;
    void push(const Entry& entry);
    void visit(const Entry& entry);
    [[nodiscard]] std::array<double, 2> sizes_of(const Entry& entry) const;
    void part(const Entry& entry);
    void set_planes(const Entry& entry, const Touch& touch);
    void take_tie(TiePlanes::Verdict verdict);
    [[nodiscard]] bool has_limits() const;
    void probe(const Entry& entry);
    [[nodiscard]] Entry nearer_half(const Entry& entry, bool opens_a);
    template <bool kOpensA>
    void open(Entry entry, const std::array<double, 2>& sizes);
    [[nodiscard]] double window(const std::array<double, 2>& sizes) const;
    void close_after(Entry& entry, double wide);
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
    [[nodiscard]] bool has_ended();
    [[nodiscard]] static std::uint64_t key_of(const NodeRef& a, const NodeRef& b);
    [[nodiscard]] std::uint64_t known_key(const NodeRef& a, const NodeRef& b) const;
    [[nodiscard]] bool is_ready() const;
    void name_triangles(Contact& contact) const;
    void report(Contact contact);
    [[nodiscard]] bool is_near_enough(const Entry& entry);
    void settle(const StalledPairs::Verdict& verdict, double time);
    void give_up(double time);
    void finish(std::optional<Contact> contact);
    [[nodiscard]] Contact in_seconds(Contact contact) const;

    MovingPair pair_;
    ContactQueryOptions options_;
    double time_tolerance_, distance_tolerance_; // scaled
    std::optional<RayCast> cast_;                // which answers in place of what follows
    BoundQueue<Entry> queue_;
    Windows windows_;
    std::uint64_t screw_due_;            // at so many box tests
    std::unique_ptr<ScrewSearch> screw_; // where the bodies move on a common screw
    std::optional<Entry> proof_;         // the earliest pair proven to intersect, and when
    std::optional<Contact> exact_;
    TiePlanes ties_;                 // of that
    std::optional<Entry> looked_at_; // the pair that a tie is looked for
    std::uint64_t next_probe_ = 0;
    StalledPairs stalled_{0};
    std::uint64_t exact_pops_ = 0; // when `exact_` was found
    ContactList found_;            // with `each_pair`
    std::optional<Contact> contact_;
    double lower_bound_ = 0;
    bool is_finished_ = false;
    bool has_given_up_ = false;
    WalkCounts counts_;
};

} // namespace obb
