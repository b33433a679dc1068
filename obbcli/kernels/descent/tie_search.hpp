// Crowds that tie: thousands of pairs that are as near, or meet as early, as the best pair known.
// Boxes, which are rounded, cannot tell that none of them is better, and to ask every pair would
// take the product of their numbers. A plane or a direction can tell it of all vertices under two
// nodes, one by one; here is when that is tried, and what is waited for.
#pragma once

#include "tree/tree.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

namespace obb {

// By how much a box may be larger than what it holds, of its extents: its axes and extents are
// rounded to float32, 2^-24 each, and a projection of it sums three of both.
inline constexpr double kBoxRounding = 0x1p-21;

// Which nodes are worth a look: those of a crowd, and after a look in vain only much smaller ones.
class TieCrowd {
  public:
    // Whether two nodes with so many triangles together may be looked at.
    [[nodiscard]] bool may_look_at(std::uint32_t count) const {
        return count >= kCrowd && count <= most_;
    }
    // Whether the bodies as a whole are to be looked at: true once, before any look.
    [[nodiscard]] bool starts_with_all() {
        const bool is_first = most_ == kAnyNumber;
        most_ = is_first ? kAnyNumber - 1 : most_;
        return is_first;
    }
    // After a look at so many triangles that found no tie.
    void fail(std::uint32_t count) { most_ = count / kFewer; }
    [[nodiscard]] bool has_failed() const { return most_ < kAnyNumber - 1; }

  private:
    static constexpr std::uint32_t kAnyNumber = std::numeric_limits<std::uint32_t>::max();
    static constexpr std::uint32_t kCrowd = 16; // fewer triangles are opened as fast
    static constexpr std::uint32_t kFewer = 4;

    std::uint32_t most_ = kAnyNumber;
};

// Two nodes whose triangles are being made ready, which takes longer than a slice may.
template <typename Pair>
struct TieWait {
    Pair candidate; // the pair, or the bodies as a whole
    Pair pair;      // the pair that was popped, which the candidate is or holds
    std::array<Preparation, 2> preparations{};

    void begin(const TreeView& a, const TreeView& b) {
        preparations[0].begin(a, candidate.a);
        preparations[1].begin(b, candidate.b);
    }
    // True when all is ready; false where the slice is over before.
    template <typename Clock>
    [[nodiscard]] bool advance(Clock& clock) {
        return preparations[0].advance(clock) && preparations[1].advance(clock);
    }
    [[nodiscard]] std::uint32_t triangle_count() const {
        return candidate.a.triangle_count() + candidate.b.triangle_count();
    }
};

} // namespace obb
