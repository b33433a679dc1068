// The first contacts of one pair of trees in many motions. Each row has the answer and the counts
// of a single question about its motion, pop by pop; what all rows have in common is asked once.
#pragma once

#include "at_rest/static_query.hpp"
#include "in_motion/contact_query.hpp"

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>

namespace obb {

// Where both bodies are at t = 0.
struct Placement {
    Pose a, b;
};

// How they move from there, for how long, and the width asked of the bracket, s.
struct SweepQuestion {
    Screw a, b;
    double duration, time_tolerance;
};

enum class SweepStatus : std::uint8_t {
    kSeparated,
    kContact,
    kOverlapAtStart,
    kUnresolved,
    kRefused,          // numbers beyond the range of double
    kTrianglesAtStart, // exact triangles meet at t = 0: where is left to be said
};

// A row as Python reads it; what does not apply is NaN, -1 or 0.
struct SweepAnswer {
    double low = ContactPlace::kNone, high = ContactPlace::kNone;
    ContactPlace place;
    double distance = ContactPlace::kNone, error_bound = 0;
    std::int64_t triangle_a = -1, triangle_b = -1;
    WalkCounts counts;
    SweepStatus status = SweepStatus::kSeparated;
    Evidence evidence = Evidence::kNone;
    bool approximate = false;
};

// The question at t = 0, asked once where all rows have one placement.
class SweepStart {
  public:
    // The trees must outlive it. Throws std::domain_error where posed coordinates would leave the
    // range of double.
    SweepStart(const TreeView& a, const TreeView& b, const Placement& placement,
               const Limits& limits);

    // Goes on for a slice; true when answered or out of pops.
    bool advance();
    [[nodiscard]] const StaticQuery& query() const { return query_; }
    [[nodiscard]] bool is_answered() const { return is_answered_; }
    // Pops left when its last slice began, and those that it took.
    [[nodiscard]] std::uint64_t left() const { return left_; }
    [[nodiscard]] std::uint64_t spent() const { return spent_; }

  private:
    StaticQuery query_;
    std::uint64_t left_;
    std::uint64_t spent_ = 0;
    bool is_answered_ = false;
};

// One row, advanced in slices of some milliseconds at most.
class SweepRow {
  public:
    // The arguments must outlive it. `start` is that of all rows, or null.
    SweepRow(const TreeView& a, const TreeView& b, const Placement& placement,
             const SweepQuestion& question, const Limits& limits, const SweepStart* start);

    // True when there is an answer. Throws as the queries do.
    bool advance();
    [[nodiscard]] const SweepAnswer& answer() const { return answer_; }

  private:
    [[nodiscard]] bool settle_at_start();
    [[nodiscard]] ContactQuery moving_query() const;
    [[nodiscard]] bool is_late() const;
    void leave_open(double low);
    void tell(ContactQuery& query, const Contact& found);
    void tell_boxes_at_start();

    const TreeView *a_, *b_;
    const Placement* placement_;
    const SweepQuestion* question_;
    const Limits* limits_;
    std::optional<SweepStart> own_start_;
    const SweepStart* start_;
    std::optional<ContactQuery> moving_;
    std::uint64_t left_ = 0, spent_ = 0;
    SweepAnswer answer_;
    std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

} // namespace obb
