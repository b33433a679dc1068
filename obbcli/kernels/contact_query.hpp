// When do two moving trees first touch? Best-first advancement on separating axes: every pair in
// the queue carries a time before which it is proven apart, so the smallest is a bound for the
// bodies.
#pragma once

#include "moving_tree.hpp"
#include "triangle_advancement.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace obb {

struct ContactQueryOptions {
    double duration = 0;
    // Width asked of the bracket around the first contact, s.
    double time_tolerance = 0;
    // Points this close may end the search, mesh units; negative: only proof does.
    double distance_tolerance = -1;
    // Surfaces this close or closer are in contact, mesh units.
    double clearance = 0;
    bool boxes_for_leaves = false;
    std::uint32_t max_depth_a = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t max_depth_b = std::numeric_limits<std::uint32_t>::max();
    // Any proof of contact will do; how early it is does not matter.
    bool any_contact = false;
};

enum class Evidence : std::uint8_t { kNone, kIntersecting, kWithinTolerance, kBoxes };

struct ContactQueryCounts {
    std::uint64_t box_tests = 0;
    std::uint64_t triangle_tests = 0;
    std::uint64_t exact_triangle_tests = 0;
    std::uint64_t pops = 0;
};

// A proven bracket of the first contact: none before `low`; contact at `high` as `evidence` says.
// Times in s.
struct Contact {
    double low = 0;
    double high = 0;
    Evidence evidence = Evidence::kNone;
    NodeRef a{}, b{};
    double distance = 0;    // proven bound on the distance at `high`, mesh units; 0 if intersecting
    double error_bound = 0; // of boxes that met: how far apart the surfaces can be, mesh units
};

// What is to be said of the place of a contact, world coordinates at its time.
struct ContactPlace {
    Vec3 point_a, point_b;
    Vec3 normal;                  // unit, from A to B
    Vec3 normal_a, normal_b;      // unit face normals, outward of the contact
    int dimension_a, dimension_b; // of the features that meet: 0 vertex, 1 edge, 2 face
};

class ContactQuery {
  public:
    // The trees must outlive the query. Asks about times later than 0: the bodies must be known to
    // be apart at 0. Throws std::domain_error where positions would leave the range of double.
    ContactQuery(const TreeView& a, const Pose& pose_a, const Screw& screw_a, const TreeView& b,
                 const Pose& pose_b, const Screw& screw_b, const ContactQueryOptions& options);

    // Takes at most so many pairs from the queue; true when the answer is complete.
    bool advance(std::uint64_t max_pops);

    // No contact in [0, lower_bound()): proven at any moment; the duration when proven apart.
    [[nodiscard]] double lower_bound() const;
    // The motion is too fast to be followed in doubles: nothing is known beyond lower_bound().
    [[nodiscard]] bool has_given_up() const { return has_given_up_; }
    [[nodiscard]] const std::optional<Contact>& contact() const { return contact_; }
    // Where the contact is, at its `low`; only for a query that found one.
    [[nodiscard]] ContactPlace place();
    [[nodiscard]] std::uint32_t id_a(const NodeRef& ref) const { return a_.id(ref); }
    [[nodiscard]] std::uint32_t id_b(const NodeRef& ref) const { return b_.id(ref); }
    [[nodiscard]] const ContactQueryCounts& counts() const { return counts_; }

  private:
    struct Entry {
        double time;
        NodeRef a, b;
    };
    // A pair that rounding lets nobody push on.
    struct Stall {
        double time;
        NodeRef a, b;
        std::uint64_t pops;
    };

    void set_units();
    void set_time(double time);
    [[nodiscard]] MovingFrame frame(double absolute, double time) const;
    [[nodiscard]] bool is_open(const TreeView& tree, const NodeRef& ref,
                               std::uint32_t max_depth) const;
    [[nodiscard]] static double size_of(const MovingTree& body, const NodeRef& ref);
    [[nodiscard]] std::optional<double> later(double time, double step) const;
    void push(const Entry& entry);
    void forget_after(double time);
    void visit(const Entry& entry);
    template <bool kOpensA>
    void open(const Entry& entry);
    template <bool kOpensA>
    void advance_child(const Entry& entry, const NodeRef& child, double step);
    void meet_triangles(const Entry& entry);
    void meet_in_translation(const Entry& entry);
    void meet_boxes(const Entry& entry);
    [[nodiscard]] bool prove_contact(const Entry& entry);
    [[nodiscard]] bool surely_intersect_at(const Entry& entry, double time);
    [[nodiscard]] double distance_at(const Entry& entry, double time, Vec3& direction);
    [[nodiscard]] bool has_ended();
    void finish_stalled();
    void give_up(double time);
    void finish(std::optional<Contact> contact);
    [[nodiscard]] ContactPlace place_of_triangles();
    [[nodiscard]] ContactPlace place_in_translation() const;
    [[nodiscard]] ContactPlace place_of_boxes();
    [[nodiscard]] Vec3 in_world(Vec3 point) const;
    [[nodiscard]] double triangle_error(const SpinningTriangle& a, const SpinningTriangle& b) const;

    MovingTree a_, b_;
    ContactQueryOptions options_;
    // In the query's units.
    double duration_ = 0, time_tolerance_ = 0, distance_tolerance_ = -1, clearance_ = 0;
    int length_exponent_ = 0, time_exponent_ = 0;
    Vec3 pivot_between_{0, 0, 0}, closing_velocity_{0, 0, 0};
    double relative_ = 0, between_error_ = 0;
    bool is_translation_ = false;

    std::vector<Entry> queue_;
    std::optional<Entry> proof_; // the earliest pair proven to intersect, and when
    std::optional<Contact> exact_;
    std::optional<Stall> stall_;
    std::optional<Contact> contact_;
    double lower_bound_ = 0;
    bool is_finished_ = false;
    bool has_given_up_ = false;
    ContactQueryCounts counts_;
};

} // namespace obb
