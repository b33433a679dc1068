// The least upper bound that weights of some functions prove over a box: a small matrix game.
#pragma once

#include <array>
#include <cstddef>

namespace obb {

// Functions by their values at the eight corners of a box. Rows bound the quantity asked about from
// above, each of them at every point that counts; demands are not negative at any point that
// counts. With weights of the rows that sum to 1 and weights of the demands that are not negative,
// the weighted sum of all bounds the quantity at every point that counts. Rows and demands are
// convex over the box, and so is the sum: it is largest at a corner. *Any* weights prove a bound;
// the game is to find those of the least one.
//
// Von Neumann 1928, Zur Theorie der Gesellschaftsspiele; demands are the multipliers of Lagrange.
class MatrixGame {
  public:
    static constexpr std::size_t kCorners = 8;
    static constexpr std::size_t kMost = 32; // rows and demands together

    using Values = std::array<double, kCorners>;

    void clear() { row_count_ = count_ = 0; }
    // Rows come before demands. Those beyond kMost are left out: the bound is then larger.
    void add_row(const Values& values);
    void add_demand(const Values& values);

    // Finds weights by the simplex method (Dantzig 1951) and the bound that they prove: rounding of
    // the sum is in it, that of the values is not. A bound below every value of the rows says that
    // no point counts.
    void solve();

    [[nodiscard]] double bound() const { return bound_; }
    // Of a row or a demand, by its number in the order in which they were added.
    [[nodiscard]] double weight(std::size_t k) const { return weights_[k]; }
    // By how much the bound grows for an error of 1 in every value: 1 and the demands' weights.
    [[nodiscard]] double reach() const { return reach_; }
    // Weights of the corners, which sum to 1: where the bound is about attained.
    [[nodiscard]] const Values& corner_weights() const { return corner_weights_; }

  private:
    void begin();
    [[nodiscard]] std::size_t entering() const;
    [[nodiscard]] std::size_t leaving(std::size_t column) const;
    void pivot(std::size_t row, std::size_t column);
    void take_weights(std::size_t unbounded);
    void prove();

    std::array<Values, kMost> values_;
    std::size_t row_count_ = 0, count_ = 0;

    // The dictionary: basic variables as affine functions of those that are 0. Column `count_` is
    // the constant, row kCorners the objective.
    std::array<std::array<double, kMost + 1>, kCorners + 1> table_;
    std::array<std::size_t, kCorners> basic_; // variable of each row: weights, then slacks
    std::array<std::size_t, kMost> free_;     // variable of each column

    std::array<double, kMost> weights_;
    Values corner_weights_{};
    double bound_ = 0, reach_ = 1;
};

} // namespace obb
