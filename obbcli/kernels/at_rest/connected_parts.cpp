#include "at_rest/connected_parts.hpp"

#include <numeric>
#include <stdexcept>

namespace obb {

namespace {

// Disjoint sets of positions, with path halving (Tarjan and van Leeuwen 1984).
class Sets {
  public:
    explicit Sets(std::size_t count) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), std::size_t{0});
    }

    [[nodiscard]] std::size_t root(std::size_t k) {
        while (parents_[k] != k) {
            parents_[k] = parents_[parents_[k]];
            k = parents_[k];
        }
        return k;
    }

    // The smaller number becomes the root.
    void join(std::size_t a, std::size_t b) {
        a = root(a);
        b = root(b);
        (a < b ? parents_[b] : parents_[a]) = a < b ? a : b;
    }

  private:
    std::vector<std::size_t> parents_;
};

} // namespace

std::vector<std::int64_t>
first_triangles_of_parts(std::span<const std::array<std::int64_t, 3>> corners,
                         std::int64_t position_count) {
    for (const auto& triangle : corners) {
        for (const std::int64_t k : triangle) {
            if (k < 0 || k >= position_count) {
                throw std::invalid_argument("a corner has no position");
            }
        }
    }
    Sets sets(static_cast<std::size_t>(position_count));
    for (const auto& [a, b, c] : corners) {
        sets.join(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
        sets.join(static_cast<std::size_t>(b), static_cast<std::size_t>(c));
    }
    std::vector<bool> is_known(static_cast<std::size_t>(position_count));
    std::vector<std::int64_t> firsts;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::size_t part = sets.root(static_cast<std::size_t>(corners[i][0]));
        if (!is_known[part]) {
            is_known[part] = true;
            firsts.push_back(static_cast<std::int64_t>(i));
        }
    }
    return firsts;
}

} // namespace obb
