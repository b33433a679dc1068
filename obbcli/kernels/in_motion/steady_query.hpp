// The whole question about two bodies of constant velocities: at t = 0, exactly, and then later.
#pragma once

#include "at_rest/static_query.hpp"
#include "in_motion/contact_query.hpp"

#include <cstdint>
#include <optional>

namespace obb {

// A tree where it is at t = 0, and how it moves from there.
struct SteadyBody {
    const TreeView* tree;
    Pose pose;
    Screw screw;
};

// Whether neither of two bodies moves against the other until `duration`.
[[nodiscard]] bool moves_nothing(const Screw& a, const Screw& b, double duration);

class SteadyQuery {
  public:
    // The trees must outlive the query. Throws std::domain_error where posed coordinates would
    // leave the range of double.
    SteadyQuery(const SteadyBody& a, const SteadyBody& b, const ContactQueryOptions& options);

    // Takes at most so many pairs from stack and queue, fewer where they take long (see
    // SliceClock); true when the answer is complete. Throws std::domain_error where positions
    // would leave the range of double.
    bool advance(std::uint64_t max_pops);

    // Contact at t = 0, or else, once that is ruled out and something moves, later.
    [[nodiscard]] StaticQuery& at_start() { return at_start_; }
    [[nodiscard]] std::optional<ContactQuery>& moving() { return moving_; }
    [[nodiscard]] bool is_contact() const;
    // The motion is too fast to be followed in doubles.
    [[nodiscard]] bool has_given_up() const { return moving_ && moving_->has_given_up(); }
    [[nodiscard]] WalkCounts counts() const;

  private:
    SteadyBody a_, b_;
    ContactQueryOptions options_;
    StaticQuery at_start_;
    std::optional<ContactQuery> moving_;
};

} // namespace obb
