// Verdicts from separating axes in doubles: what is certain beyond rounding, and what is not.
// The axes come from sat_<shape>_<shape>.hpp as AxisBounds, in the paper's order.
#pragma once

#include "numbers/vec.hpp"
#include "primitives/axis.hpp"
#include "primitives/exact_contact.hpp"
#include "shapes/extremes.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace obb {

// The bounds of every filter hold for magnitudes up to kLargestFiltered; beyond it arithmetic is
// exact from the start. Products that underflow lose at most 2^-1074 each before they meet
// factors of that size: kUnderflow covers a sum of them.
inline constexpr double kLargestFiltered = 0x1p100;
inline constexpr double kUnderflow = 0x1p-700;

// Whether u x v is zero because of their zeros alone, so also for what u and v are rounded from.
[[nodiscard]] inline bool is_surely_parallel(const Vec3& u, const Vec3& v) {
    const auto vanish = [](double p, double q) { return p == 0 || q == 0; };
    return vanish(u.x, v.y) && vanish(u.y, v.x) && vanish(u.y, v.z) && vanish(u.z, v.y) &&
           vanish(u.z, v.x) && vanish(u.x, v.z);
}

enum class Verdict : std::uint8_t { kSeparated, kIntersecting, kUnsure };

// Shapes at rest. Takes bounds until an axis separates for certain.
class StillSat {
  public:
    [[nodiscard, gnu::always_inline]] bool operator()(AxisId id, const AxisBound& axis) {
        if (axis.low > axis.error || axis.high < -axis.error) {
            separated_ = true;
            return true;
        }
        any_ = true;
        const bool sure = axis.low < -axis.error && axis.high > axis.error;
        unsure_ |= static_cast<std::uint32_t>(!sure) << axis_index(id);
        return false;
    }

    [[nodiscard]] Verdict verdict() const {
        return separated_             ? Verdict::kSeparated
               : any_ && unsure_ == 0 ? Verdict::kIntersecting
                                      : Verdict::kUnsure;
    }
    // The axes that may yet separate, a bit each by axis_index.
    [[nodiscard]] std::uint32_t unsure() const { return unsure_; }

  private:
    bool separated_ = false;
    bool any_ = false;
    std::uint32_t unsure_ = 0;
};

// Bounds on when one axis begins and ceases to allow contact within [0, duration]; what lies
// outside of that is outside for certain.
struct AxisTimes {
    double entry_low, entry_high, exit_low, exit_high;
};

[[nodiscard, gnu::always_inline]] inline AxisTimes axis_times(const AxisBound& axis,
                                                              double duration) {
    constexpr double kForever = std::numeric_limits<double>::infinity();
    const double size = std::fabs(axis.speed);
    if (size <= kUnderflow) {
        const double slack = axis.error + duration * size;
        if (axis.low > slack || axis.high < -slack) {
            return {kForever, kForever, -kForever, -kForever};
        }
        if (axis.low < -slack && axis.high > slack) {
            return {-kForever, -kForever, kForever, kForever};
        }
        return {-kForever, kForever, -kForever, kForever};
    }
    // Where a linear function of time is 1.5 errors beyond zero at t and more so at one end of the
    // interval, the true one has that sign from t to there, whatever the sign of its true speed.
    const double pace = 1 / size;
    const double entry = (axis.speed > 0 ? axis.low : -axis.high) * pace;
    const double exit = (axis.speed > 0 ? axis.high : -axis.low) * pace;
    const double error = 1.5 * axis.error * pace + 8 * kUnitRoundoff * duration;
    return {entry - error, entry + error, exit - error, exit + error};
}

// Shapes in motion. Takes bounds until the entries and exits leave no time for contact.
class MovingSat {
  public:
    explicit MovingSat(double duration) : duration_(duration), times_{0, 0, duration, duration} {}

    [[nodiscard, gnu::always_inline]] bool operator()(AxisId, const AxisBound& axis) {
        add(axis_times(axis, duration_));
        any_ = true;
        return is_separated();
    }

    void add(const AxisTimes& times) {
        times_.entry_low = larger(times_.entry_low, times.entry_low);
        times_.entry_high = larger(times_.entry_high, times.entry_high);
        times_.exit_low = smaller(times_.exit_low, times.exit_low);
        times_.exit_high = smaller(times_.exit_high, times.exit_high);
    }

    [[nodiscard]] bool is_separated() const { return times_.entry_low > times_.exit_high; }
    [[nodiscard]] Verdict verdict() const {
        return is_separated()                                 ? Verdict::kSeparated
               : any_ && times_.entry_high <= times_.exit_low ? Verdict::kIntersecting
                                                              : Verdict::kUnsure;
    }
    // Bounds on the first and last time, if there is contact at all.
    [[nodiscard]] const AxisTimes& times() const { return times_; }

  private:
    double duration_;
    AxisTimes times_;
    bool any_ = false;
};

// The same, keeping what each axis says in order to select those that matter.
class AxisRecorder {
  public:
    explicit AxisRecorder(double duration) : duration_(duration), sat_(duration) {}

    [[nodiscard]] bool operator()(AxisId id, const AxisBound& axis) {
        const std::size_t k = axis_index(id);
        seen_ |= 1u << k;
        bounds_[k] = axis;
        times_[k] = axis_times(axis, duration_);
        sat_.add(times_[k]);
        return sat_.is_separated();
    }

    [[nodiscard]] bool is_separated() const { return sat_.is_separated(); }

    // The axes that can have the latest entry or the earliest exit, or a gap of zero at the first
    // time. Axes that were not seen have no direction.
    [[nodiscard]] AxisSelection selection() const {
        AxisSelection selection{0, 0};
        const AxisTimes& all = sat_.times();
        const double latest = smaller(all.entry_high, all.exit_high);
        for (std::size_t k = 0; k < kAxisCount; ++k) {
            if (((seen_ >> k) & 1) == 0) {
                continue;
            }
            if (times_[k].entry_high >= all.entry_low || times_[k].exit_low <= all.exit_high) {
                selection.binding |= 1u << k;
            }
            // The first time is between the greatest lower bound and `latest`.
            const AxisBound& axis = bounds_[k];
            const double size = std::fabs(axis.speed);
            const double slack = 2 * (axis.error + (latest - all.entry_low) * size) +
                                 8 * kUnitRoundoff * latest * size;
            const double way = latest * axis.speed;
            if (std::fabs(way - axis.low) <= slack || std::fabs(way - axis.high) <= slack) {
                selection.near |= 1u << k;
            }
        }
        return selection;
    }

  private:
    double duration_;
    std::uint32_t seen_ = 0;
    MovingSat sat_;
    std::array<AxisBound, kAxisCount> bounds_;
    std::array<AxisTimes, kAxisCount> times_;
};

} // namespace obb
