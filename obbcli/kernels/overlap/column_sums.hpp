// Sums of terms along columns, and the brackets that follow from them.
#pragma once

#include "overlap/column_frame.hpp"
#include "overlap/fixed_sum.hpp"
#include "overlap/shadow_term.hpp"

#include <array>
#include <cstddef>

namespace obb {

// Proven: what is bracketed lies in [low, high].
struct Bracket {
    double low, high;
};

// A sum of terms, each times a whole number.
class ColumnSum {
  public:
    explicit ColumnSum(double size) : values_(size), errors_(size) {}

    void add(double value, double error, int times) {
        values_.add(times * value);
        errors_.add(std::abs(times) * error);
    }
    // In the unit of the query to the third power. Everything where a term was no number.
    [[nodiscard]] Bracket bracket() const;
    [[nodiscard]] double value() const { return values_.value(); }
    [[nodiscard]] double error() const { return errors_.value() + errors_.cut_off(); }

  private:
    FixedSum values_, errors_;
};

// The volume that a number of terms add up to, and its first moments.
class ColumnSums {
  public:
    explicit ColumnSums(const ColumnFrame& frame);

    void add(const ShadowTerm& term);
    [[nodiscard]] Bracket volume() const { return volume_.bracket(); }

    struct Centroid {
        Vec3 point;   // x, y, z
        double error; // proven: it is no further from the true one
        bool is_known;
    };
    // Known where the volume is not 0 by proof. In the unit of the query.
    [[nodiscard]] Centroid centroid() const;

  private:
    const ColumnFrame& frame_;
    ColumnSum volume_;
    std::array<FixedSum, 3> moments_; // u, v, w
};

// A bracket times 2^exponent, rounded outwards.
[[nodiscard]] Bracket scaled_outwards(const Bracket& bracket, int exponent);

// The magnitude of what is bracketed.
[[nodiscard]] Bracket magnitude(const Bracket& bracket);

} // namespace obb
