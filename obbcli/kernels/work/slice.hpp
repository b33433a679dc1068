// How long a query goes on before its caller may look at clock and signals.
#pragma once

#include <chrono>

namespace obb {

// Pops differ in what they take by a factor of a thousand: exact tests, nodes to be made. So a
// slice of a query ends after so many of them or after some milliseconds, whichever comes first;
// answers do not depend on where slices end.
class SliceClock {
  public:
    enum class Steps {
        kLong,  // pops that may take long, as where nodes are made: the clock runs from the start
        kShort, // others: it runs from its first look on, which many a question ends before
    };
    explicit SliceClock(Steps steps = Steps::kLong) : mask_(steps == Steps::kLong ? 7 : 31) {
        if (steps == Steps::kLong) {
            start_ = std::chrono::steady_clock::now();
        }
    }

    // Looks at the clock every few calls only, for that takes as long as some pops.
    [[nodiscard]] bool is_over() {
        if ((++calls_ & mask_) != 0) {
            return false;
        }
        const auto now = std::chrono::steady_clock::now();
        if (start_ == std::chrono::steady_clock::time_point{}) {
            start_ = now;
        }
        return now - start_ >= kLength;
    }

  private:
    static constexpr std::chrono::milliseconds kLength{10};

    std::chrono::steady_clock::time_point start_{};
    unsigned mask_, calls_ = 0;
};

} // namespace obb
