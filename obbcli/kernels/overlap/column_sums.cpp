#include "overlap/column_sums.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obb {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

[[nodiscard]] double size_of(const ColumnWindow& w) {
    return (w.high[0] - w.low[0]) * (w.high[1] - w.low[1]) * w.height;
}

} // namespace

// Converting sums to doubles, adding both and what follows is off by a few units of roundoff of
// what is converted: 8 u covers it.
Bracket ColumnSum::bracket() const {
    if (!values_.is_whole() || !errors_.is_whole()) {
        return {-kInfinity, kInfinity};
    }
    const double value = values_.value();
    const double off =
        error() + values_.cut_off() + 8 * kUnitRoundoff * (std::fabs(value) + error());
    return {value - off, value + off};
}

ColumnSums::ColumnSums(const ColumnFrame& frame)
    : frame_(frame), volume_(size_of(frame.window)),
      moments_{FixedSum(size_of(frame.window) * (frame.window.high[0] - frame.window.low[0])),
               FixedSum(size_of(frame.window) * (frame.window.high[1] - frame.window.low[1])),
               FixedSum(size_of(frame.window) * frame.window.height)} {}

void ColumnSums::add(const ShadowTerm& term) {
    if (term.error == 0) { // and so is the term
        return;
    }
    volume_.add(term.volume, term.error, 1);
    for (std::size_t k = 0; k < 3; ++k) {
        moments_[k].add(term.moments[k]);
    }
}

// With m and v the moment and the volume as computed, M and V the true ones: M / V - m / v =
// ((M - m) - m / v (V - v)) / V. Rounding of the quotient and of the origin's coordinate is added.
ColumnSums::Centroid ColumnSums::centroid() const {
    const Bracket volume = volume_.bracket();
    const double least = magnitude(volume).low;
    if (!(least > 0) || !(volume.high < kInfinity && volume.low > -kInfinity)) {
        return {{0, 0, 0}, 0, false};
    }
    Centroid found{frame_.origin, 0, true};
    const double value = volume_.value();
    const ColumnWindow& w = frame_.window;
    const std::array<double, 3> sizes{w.high[0] - w.low[0], w.high[1] - w.low[1], w.height};
    for (std::size_t k = 0; k < 3; ++k) {
        const double place = moments_[k].value() / value;
        const double error = 2 * volume_.error() * sizes[k] + moments_[k].cut_off() +
                             std::fabs(place) * (volume.high - volume.low);
        found.is_known = found.is_known && moments_[k].is_whole();
        double& coordinate = found.point[(frame_.axis + 1 + k) % 3];
        coordinate += place;
        const double off =
            error / least + 4 * kUnitRoundoff * (std::fabs(coordinate) + std::fabs(place));
        found.error += (1 + 16 * kUnitRoundoff) * off;
    }
    return found;
}

Bracket scaled_outwards(const Bracket& bracket, int exponent) {
    // Scaling rounds only where the result is subnormal or too large.
    return {std::nextafter(std::ldexp(bracket.low, exponent), -kInfinity),
            std::nextafter(std::ldexp(bracket.high, exponent), kInfinity)};
}

Bracket magnitude(const Bracket& bracket) {
    if (bracket.low >= 0) {
        return bracket;
    }
    return bracket.high <= 0 ? Bracket{-bracket.high, -bracket.low}
                             : Bracket{0, std::max(-bracket.low, bracket.high)};
}

} // namespace obb
