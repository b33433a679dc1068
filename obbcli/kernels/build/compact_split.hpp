// Where to part a node so that questions meet few boxes below it.
#pragma once

#include "numbers/registers.hpp"
#include "numbers/vec.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace obb {

// Triangles in doubles, stored coordinate by coordinate: the first of the nine columns, the others
// `stride` apart. Columns go on to a whole number of registers, with some triangle of these.
struct DoubleColumns {
    const double* first;
    std::size_t stride;
    std::uint32_t count;
};

// Of the planes across the node's three axes, 15 each, evenly spaced, the one is taken that makes
// the sum of both sides' squared diagonals times counts least: the surface area heuristic
// (Goldsmith and Salmon 1987; bins as in Wald 2007, On fast construction of SAH-based bounding
// volume hierarchies) with a size in place of the area. What meets a box here is another box of
// about its size, not a ray: long thin boxes are met as often as wide ones, and measured trees are
// better. The boxes are those along the node's own axes, in floats: they are weighed, not kept.
class CompactSplit {
  public:
    static constexpr std::size_t kBins = 16;

    struct Box {
        std::array<Vec3, 3> axes;
        Vec3 center, half_extents;
    };
    // Centroids in bins up to `last_left` go left; those from `first_right` on go right, and
    // there are none between.
    struct Cut {
        std::size_t axis;
        std::size_t last_left, first_right;

        // Where it crosses its axis, of half extents: in the middle of the empty bins.
        [[nodiscard]] double place() const {
            return static_cast<double>(last_left + 1 + first_right) / kBins - 1.0;
        }
    };

    // A workshop for at most so many triangles.
    explicit CompactSplit(std::uint32_t most);

    // Nothing where all centroids are in one bin on every axis.
    [[nodiscard]] std::optional<Cut> best(const Box& box, const DoubleColumns& triangles);

    // Of the triangles last looked at.
    [[nodiscard]] bool is_left(const Cut& cut, std::uint32_t triangle) const {
        return bins_of_[cut.axis][triangle] <= cut.last_left;
    }

  private:
    // Lower ends along the three axes, and upper ones with their signs turned.
    using Bounds = std::array<float, 8>;

    template <std::size_t kBytes>
    void measure(const Box& box, const DoubleColumns& triangles);
    template <std::size_t kBytes>
    void fill_bins(std::uint32_t count);
    template <std::size_t kBytes>
    void weigh(std::size_t axis, float& least, std::optional<Cut>& found) const;

    std::vector<Bounds> bounds_;
    std::array<std::vector<std::uint8_t>, 3> bins_of_;
    std::array<std::array<Bounds, kBins>, 3> bins_;
    std::array<std::array<std::uint32_t, kBins>, 3> counts_;
};

} // namespace obb
