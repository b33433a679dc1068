// An array of zeros that costs what is touched of it: the system hands pages out on first use.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <type_traits>

namespace obb {

// Of plain records for which zero bytes are a value; aligned to cache lines.
template <typename Record>
class ZeroedArray {
    static_assert(std::is_trivially_copyable_v<Record>);
    static constexpr std::size_t kAlignment = 64;
    static_assert(alignof(Record) <= kAlignment);

  public:
    ZeroedArray() = default;
    explicit ZeroedArray(std::size_t count) : count_(count) {
        if (count > (std::numeric_limits<std::size_t>::max() - kAlignment) / sizeof(Record)) {
            throw std::bad_alloc();
        }
        std::size_t space = count * sizeof(Record) + kAlignment;
        bytes_.reset(std::calloc(space, 1));
        if (!bytes_) {
            throw std::bad_alloc();
        }
        void* first = bytes_.get();
        first_ = static_cast<Record*>(std::align(kAlignment, count * sizeof(Record), first, space));
    }

    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] Record* data() const { return first_; }
    [[nodiscard]] Record& operator[](std::size_t i) const { return first_[i]; }
    [[nodiscard]] std::span<const Record> span() const { return {first_, count_}; }

  private:
    struct Free {
        void operator()(void* p) const { std::free(p); }
    };
    std::unique_ptr<void, Free> bytes_;
    Record* first_ = nullptr;
    std::size_t count_ = 0;
};

} // namespace obb
