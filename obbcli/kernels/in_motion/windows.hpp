// Times for which pairs are opened, after which they are looked at as a whole again.
#pragma once

#include <cstdint>
#include <vector>

namespace obb {

// Each window knows whether anything in it was not proven apart until the duration: then the pair
// that it was opened for has to be looked at again.
class Windows {
  public:
    // Window 0 is the whole duration, which nothing leaves.
    static constexpr std::uint32_t kWhole = 0;

    [[nodiscard]] std::uint32_t open() {
        if (free_.empty()) {
            is_needed_.push_back(false);
            return static_cast<std::uint32_t>(is_needed_.size() - 1);
        }
        const std::uint32_t window = free_.back();
        free_.pop_back();
        return window;
    }
    void need(std::uint32_t window) { is_needed_[window] = true; }
    // Whether the window was needed; it is free for another pair then.
    [[nodiscard]] bool close(std::uint32_t window) {
        const bool is_needed = is_needed_[window];
        is_needed_[window] = false;
        free_.push_back(window);
        return is_needed;
    }

  private:
    std::vector<bool> is_needed_{false};
    std::vector<std::uint32_t> free_;
};

} // namespace obb
