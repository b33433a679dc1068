// Which vertices were looked at a moment ago.
#pragma once

#include <array>
#include <cstdint>

namespace obb {

// Neighbours share vertices: who was seen lately needs no second look.
class SeenLately {
  public:
    SeenLately() { seen_.fill(-1); }
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
