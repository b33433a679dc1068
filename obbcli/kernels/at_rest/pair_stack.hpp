// The pairs of nodes that a question has yet to look into, the next one on top.
#pragma once

#include "tree/tree.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace obb {

struct NodePair {
    NodeRef a, b;
};

// The lowest pairs lie in the stack itself: most questions never need memory for more.
class PairStack {
  public:
    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] NodePair& operator[](std::size_t place) {
        return place < kLow ? low_[place] : high_[place - kLow];
    }
    [[nodiscard]] NodePair& back() { return (*this)[size_ - 1]; }

    void push_back(const NodePair& pair) {
        if (size_ < kLow) {
            low_[size_] = pair;
        } else {
            high_.push_back(pair);
        }
        ++size_;
    }
    void pop_back() {
        if (--size_ >= kLow) {
            high_.pop_back();
        }
    }
    void clear() {
        size_ = 0;
        high_.clear();
    }

  private:
    static constexpr std::size_t kLow = 64;

    std::size_t size_ = 0;
    std::array<NodePair, kLow> low_; // of which those below the size are set
    std::vector<NodePair> high_;
};

} // namespace obb
