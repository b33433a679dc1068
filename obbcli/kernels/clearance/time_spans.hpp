// Stretches of time in which something may come as near as the least distance found.
#pragma once

#include <cstddef>
#include <vector>

namespace obb {

struct TimeSpan {
    double low, high;
};

// Intervals with proven lower bounds on the distance in them; those above a falling limit are let
// go, and neighbours are joined.
class TimeSpans {
  public:
    void add(const TimeSpan& span, double key) {
        spans_.push_back({span, key});
        if (spans_.size() >= most_) {
            is_due_ = true;
        }
    }
    // Whether there are so many that it is time to thin them out.
    [[nodiscard]] bool is_due() const { return is_due_; }
    // Keeps what may be below the limit.
    void thin_out(double limit);
    // In order, joined where they meet.
    [[nodiscard]] std::vector<TimeSpan> below(double limit) const;

  private:
    struct Keyed {
        TimeSpan span;
        double key;
    };
    std::vector<Keyed> spans_;
    std::size_t most_ = 4096;
    bool is_due_ = false;
};

} // namespace obb
