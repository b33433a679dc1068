// Pairs of nodes that a ray cast has still to look into.
#pragma once

#include "descent/bound_queue.hpp"
#include "in_motion/moving_pair.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace obb {

// What lies under the two nodes touches within [time, end] only.
struct RayEntry {
    double time, end; // scaled
    NodeRef a, b;
    std::uint32_t next = 0; // of a leaf that is opened: its first triangle not yet pushed
    double least = 0;       // of the times from here to the bottom of the stack

    [[nodiscard]] PairRef refs() const { return {a, b}; }
};

// A stack, which is quick; or a queue by time where the earliest is wanted first, so that what is
// proven grows steadily.
class RayFrontier {
  public:
    explicit RayFrontier(bool is_queue) : is_queue_(is_queue) {}

    // For good.
    void become_queue() {
        is_queue_ = true;
        for (const RayEntry& entry : stack_) {
            push(entry);
        }
        stack_.clear();
    }

    [[nodiscard]] bool is_empty() const { return is_queue_ ? queue_.is_empty() : stack_.empty(); }
    // No entry is earlier; infinite where there is none.
    [[nodiscard]] double next_time() const {
        if (is_queue_) {
            return queue_.next_time();
        }
        return stack_.empty() ? std::numeric_limits<double>::infinity() : stack_.back().least;
    }
    // The next to look into, where there is one.
    [[nodiscard]] bool is_next_before(double time) const {
        return (is_queue_ ? queue_.next_time() : stack_.back().time) < time;
    }

    void push(const RayEntry& entry) {
        if (is_queue_) {
            queue_.push(entry, entry.time, entry.next > 0 ? 0 : entry.a.depth + entry.b.depth);
            return;
        }
        const double least = std::min(entry.time, next_time());
        stack_.push_back(entry);
        stack_.back().least = least;
    }
    RayEntry pop() {
        if (is_queue_) {
            return queue_.pop();
        }
        const RayEntry entry = stack_.back();
        stack_.pop_back();
        return entry;
    }
    void clear() {
        queue_.clear();
        stack_.clear();
    }

  private:
    bool is_queue_;
    std::vector<RayEntry> stack_;
    BoundQueue<RayEntry> queue_;
};

} // namespace obb
