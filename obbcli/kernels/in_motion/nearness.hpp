// How long pairs that are near stay near, and what is said of pairs that cannot be
// told from contact: brackets as wide as what is not known.
#pragma once

#include "in_motion/contact.hpp"
#include "in_motion/moving_pair.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace obb {

// Two triangles that are proven apart before a time, scaled.
struct TimedPair {
    PairRef refs;
    double time;
};

// How long a pair that is near stays so: it is near at `last`, and at `end` it is proven to be in
// contact, or no longer to be near, or `end` is the duration. Scaled times.
struct Nearness {
    double last, end;
    bool is_contact; // whether it is proven to be in contact at `end`
};

// Of a pair that is near at its time. It is near while points of it are within `near`, mesh units,
// for certain; or, where that is no more than the clearance, while it is not proven to be beyond
// the clearance. Of the time between two looks nothing is said but that the pair may be near.
[[nodiscard]] Nearness nearness_from(MovingPair& pair, const TimedPair& entry, double near,
                                     double time_tolerance);

// Pairs of triangles that no step proves apart any longer, earliest first.
class StalledPairs {
  public:
    // The width asked of a bracket, scaled.
    explicit StalledPairs(double time_tolerance) : time_tolerance_(time_tolerance) {}

    // What a search says of stalled pairs: nothing yet; a contact; or that it can say nothing, as
    // rounding is larger than the bodies.
    struct Verdict {
        bool is_final = false;
        std::optional<Contact> contact;
    };

    [[nodiscard]] bool is_empty() const { return pairs_.empty(); }
    // No stalled pair is in contact before this time.
    [[nodiscard]] double first_time() const { return pairs_.front().time; }
    // A pair that stalls after so many pops of the search.
    void add(MovingPair& pair, const TimedPair& entry, std::uint64_t pops);
    // Whether to settle: no other pair may be in contact before the time `next`.
    [[nodiscard]] bool is_due(double next, std::uint64_t pops) const {
        return !is_empty() && (next > end_ || pops > most_pops_);
    }
    [[nodiscard]] Verdict settle(MovingPair& pair, double next, std::uint64_t pops);
    // Of a single pair, whatever others do.
    [[nodiscard]] Verdict settle_alone(MovingPair& pair, const TimedPair& entry);

  private:
    [[nodiscard]] std::optional<Contact> soon_after(MovingPair& pair,
                                                    std::span<const TimedPair> stalled) const;
    [[nodiscard]] std::optional<Contact> undecided(MovingPair& pair,
                                                   std::span<const TimedPair> stalled);

    double time_tolerance_;
    std::vector<TimedPair> pairs_;
    double end_ = 0;               // once all pairs are past this time, the stalled are settled
    std::uint64_t most_pops_ = 0;  // or after so many pops
    std::optional<Contact> known_; // what is known of them since they were settled first
    bool is_proven_ = false;       // whether that is contact for certain, at the end of its bracket
};

} // namespace obb
