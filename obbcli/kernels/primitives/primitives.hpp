// The pair questions on arrays of pairs: one shape for all pairs or one for each, on some threads.
#pragma once

#include "primitives/pair_query.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace obb {

// One value for all pairs, or one for each.
template <typename T>
class Repeated {
  public:
    explicit Repeated(std::span<const T> values) : values_(values) {}
    [[nodiscard]] const T& operator[](std::size_t k) const {
        return values_.size() == 1 ? values_[0] : values_[k];
    }
    [[nodiscard]] std::size_t size() const { return values_.size(); }

  private:
    std::span<const T> values_;
};

struct RepeatedMotion {
    Repeated<Vec3> velocity_a, velocity_b;
    Repeated<double> duration;

    [[nodiscard]] LinearMotion operator[](std::size_t k) const {
        return {velocity_a[k], velocity_b[k], duration[k]};
    }
};

// Of a byte of verdicts: whether the pair meets, and whether it took exact arithmetic to know.
inline constexpr std::uint8_t kMeets = 1;
inline constexpr std::uint8_t kExact = 2;

// Who does the work: at most so many threads. pause() is called between slices of it by the thread
// that asks; what it throws ends the work.
struct Crew {
    unsigned threads;
    std::function<void()> pause;
};

// Writes what is found of pair k to verdicts[k].
template <typename A, typename B>
void test_pairs(Repeated<A> a, Repeated<B> b, const RepeatedMotion& motion, const Crew& crew,
                std::span<std::uint8_t> verdicts);

struct PairContacts {
    std::vector<std::int64_t> rows; // ascending
    std::vector<PairContact> contacts;
};

// The contacts of those of `count` pairs that meet.
template <typename A, typename B>
[[nodiscard]] PairContacts first_contacts(Repeated<A> a, Repeated<B> b,
                                          const RepeatedMotion& motion, std::size_t count,
                                          const Crew& crew);

} // namespace obb
