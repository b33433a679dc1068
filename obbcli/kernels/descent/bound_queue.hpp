// A queue of entries by time, earliest first; of equal times the one of the highest rank.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace obb {

// The heap moves keys alone: entries stay where they were put.
template <typename Entry>
class BoundQueue {
  public:
    [[nodiscard]] bool is_empty() const { return keys_.empty(); }
    // Infinite where nothing is left.
    [[nodiscard]] double next_time() const {
        return keys_.empty() ? std::numeric_limits<double>::infinity() : keys_.front().time;
    }

    void reserve(std::size_t count) {
        keys_.reserve(count);
        entries_.reserve(count);
        free_.reserve(count);
    }

    void push(const Entry& entry, double time, std::uint32_t rank) {
        std::uint32_t place = 0;
        if (free_.empty()) {
            place = static_cast<std::uint32_t>(entries_.size());
            entries_.push_back(entry);
        } else {
            place = free_.back();
            free_.pop_back();
            entries_[place] = entry;
        }
        keys_.push_back({time, rank, place});
        std::push_heap(keys_.begin(), keys_.end(), LaterFirst{});
    }

    // Only where there is one.
    Entry pop() {
        std::pop_heap(keys_.begin(), keys_.end(), LaterFirst{});
        const std::uint32_t place = keys_.back().place;
        keys_.pop_back();
        free_.push_back(place);
        return entries_[place];
    }

    // Those that wait, in no order.
    template <typename Each>
    void for_each(Each each) const {
        for (const Key& key : keys_) {
            each(entries_[key.place]);
        }
    }

    void erase_after(double time) {
        std::erase_if(keys_, [&](const Key& key) {
            const bool is_late = key.time > time;
            if (is_late) {
                free_.push_back(key.place);
            }
            return is_late;
        });
        std::make_heap(keys_.begin(), keys_.end(), LaterFirst{});
    }

    void clear() {
        keys_.clear();
        entries_.clear();
        free_.clear();
    }

  private:
    struct Key {
        double time;
        std::uint32_t rank, place;
    };
    struct LaterFirst {
        bool operator()(const Key& x, const Key& y) const {
            return x.time > y.time || (x.time == y.time && x.rank < y.rank);
        }
    };

    std::vector<Key> keys_;
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> free_;
};

} // namespace obb
