// How long a query goes on before its caller may look at clock and signals.
#pragma once

#include <chrono>

namespace obb {

// Pops differ in what they take by a factor of a thousand: exact tests, nodes to be made. So a
// slice of a query ends after so many of them or after some milliseconds, whichever comes first;
// answers do not depend on where slices end.
class SliceClock {
  public:
    // Looks at the clock every few calls only, for that takes as long as some pops.
    [[nodiscard]] bool is_over() {
        if (++calls_ % kCallsALook != 0) {
            return false;
        }
        return std::chrono::steady_clock::now() - start_ >= kLength;
    }

  private:
    static constexpr unsigned kCallsALook = 8;
    static constexpr std::chrono::milliseconds kLength{10};

    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    unsigned calls_ = 0;
};

} // namespace obb
