// Contacts of many pairs of triangles, to be taken in order of time.
#pragma once

#include "in_motion/contact.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <tuple>
#include <unordered_set>
#include <vector>

namespace obb {

class ContactList {
  public:
    void add(const Contact& contact) { add(contact, key_of(contact.a, contact.b)); }
    // The same where another key names the pair.
    void add(const Contact& contact, std::uint64_t key) {
        known_.insert(key);
        found_.push_back(contact);
        std::push_heap(found_.begin(), found_.end(), LaterLow{});
    }
    // Whether a contact of the pair was added, be it taken or not.
    [[nodiscard]] bool knows(std::uint64_t key) const { return known_.contains(key); }
    // When the next contact starts; infinite where there is none.
    [[nodiscard]] double next_low() const {
        return found_.empty() ? std::numeric_limits<double>::infinity() : found_.front().low;
    }
    // The earliest contact, which there must be.
    Contact pop() {
        std::pop_heap(found_.begin(), found_.end(), LaterLow{});
        const Contact contact = found_.back();
        found_.pop_back();
        return contact;
    }

  private:
    struct LaterLow {
        bool operator()(const Contact& x, const Contact& y) const {
            return std::tuple(x.low, x.triangle_a, x.triangle_b) >
                   std::tuple(y.low, y.triangle_a, y.triangle_b);
        }
    };
    [[nodiscard]] static std::uint64_t key_of(const NodeRef& a, const NodeRef& b) {
        return std::uint64_t{a.begin} << 32U | b.begin;
    }

    std::vector<Contact> found_;              // a heap, those that were not taken
    std::unordered_set<std::uint64_t> known_; // the pairs of all that were added
};

} // namespace obb
