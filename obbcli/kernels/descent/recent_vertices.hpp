// Vertices that a loop over triangles met last.
#pragma once

#include <array>
#include <cstdint>

namespace obb {

// Neighbouring triangles share vertices, and a vertex that was met once needs no second look. The
// vertices are kept in slots by their number, so that a later vertex may displace an earlier one:
// that costs a second look, and nothing else.
class RecentVertices {
  public:
    RecentVertices() { seen_.fill(-1); }
    // Adds a vertex; true where it is known already.
    [[nodiscard]] bool add(std::uint32_t vertex) {
        std::int64_t& place = seen_[vertex % seen_.size()];
        const bool is_known = place == vertex;
        place = vertex;
        return is_known;
    }

  private:
    std::array<std::int64_t, 512> seen_;
};

} // namespace obb
