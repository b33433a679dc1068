// A sum of doubles whose bits do not depend on the order of its terms.
#pragma once

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace obb {

// Terms are rounded towards zero to multiples of 2^-90 of a given size, and added as integers: that
// is twice the digits of a double, and room for 2^36 terms as large as that size.
class FixedSum {
  public:
    // Terms are expected to be about as large as `size` at most.
    explicit FixedSum(double size)
        : exponent_(std::clamp(exponent_of(size), -900, 900) - kDigits),
          scale_(power_of_two(-exponent_)) {}

    void add(double term) {
        const double units = scale_ * term;
        if (!(std::fabs(units) < 0x1p122)) { // NaN included
            is_whole_ = false;
            return;
        }
        // In two steps, each exact: conversions to wide integers are slow calls.
        const auto high = static_cast<std::int64_t>(units * 0x1p-60);
        const auto low = static_cast<std::int64_t>(units - static_cast<double>(high) * 0x1p60);
        sum_ += (Int128{high} << 60) + low;
        ++count_;
        is_whole_ = is_whole_ && sum_ < kLargest && sum_ > -kLargest;
    }

    // The sum, rounded to a double.
    [[nodiscard]] double value() const { return std::ldexp(static_cast<double>(sum_), exponent_); }
    // What was cut off its terms amounts to less than this.
    [[nodiscard]] double cut_off() const {
        return std::ldexp(static_cast<double>(count_), exponent_);
    }
    // False once a term was no number, or far too large: the sum then tells nothing.
    [[nodiscard]] bool is_whole() const { return is_whole_; }

  private:
    __extension__ using Int128 = __int128;
    static constexpr int kDigits = 90;
    static constexpr Int128 kLargest = Int128{1} << 125;

    int exponent_; // of what is counted
    double scale_; // 2^-exponent
    Int128 sum_ = 0;
    std::uint64_t count_ = 0;
    bool is_whole_ = true;
};

} // namespace obb
