#include "overlap/matrix_game.hpp"

#include "numbers/vec.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

constexpr std::size_t kNone = ~std::size_t{0};
constexpr double kTiny = 0x1p-40; // entries are about 1: what is smaller is taken for rounding

} // namespace

void MatrixGame::add_row(const Values& values) {
    if (count_ < kMost) {
        values_[count_++] = values;
        row_count_ = count_;
    }
}

void MatrixGame::add_demand(const Values& values) {
    if (count_ < kMost) {
        values_[count_++] = values;
    }
}

// With the rows brought into [1, 2], the game's value t is positive, and y = weights / t solves
// "maximise the sum of the rows' y, such that at no corner the sum of all exceeds 1": y = 0 is a
// solution to begin with, and the best one has the sum 1 / t.
void MatrixGame::begin() {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t j = 0; j < row_count_; ++j) {
        const auto [least, most] = std::minmax_element(values_[j].begin(), values_[j].end());
        low = std::min(low, *least);
        high = std::max(high, *most);
    }
    const double scale = high > low ? 1 / (high - low) : 1;
    for (std::size_t j = 0; j < count_; ++j) {
        const bool is_row = j < row_count_;
        double factor = scale;
        if (!is_row) { // only its sign matters
            double largest = 0;
            for (const double value : values_[j]) {
                largest = std::max(largest, std::fabs(value));
            }
            factor = largest > 0 ? 1 / largest : 1;
        }
        for (std::size_t k = 0; k < kCorners; ++k) {
            table_[k][j] = is_row ? 1 + (values_[j][k] - low) * scale : values_[j][k] * factor;
        }
        weights_[j] = factor;
        table_[kCorners][j] = is_row ? 1 : 0;
        free_[j] = j;
    }
    for (std::size_t k = 0; k < kCorners; ++k) {
        table_[k][count_] = 1;
        basic_[k] = count_ + k;
    }
    table_[kCorners][count_] = 0;
}

std::size_t MatrixGame::entering() const {
    const auto& gains = table_[kCorners];
    std::size_t best = kNone;
    double most = kTiny;
    for (std::size_t j = 0; j < count_; ++j) {
        if (gains[j] > most) {
            most = gains[j];
            best = j;
        }
    }
    return best;
}

std::size_t MatrixGame::leaving(std::size_t column) const {
    std::size_t best = kNone;
    double least = HUGE_VAL;
    for (std::size_t k = 0; k < kCorners; ++k) {
        const double entry = table_[k][column];
        if (entry > kTiny && table_[k][count_] < least * entry) {
            least = table_[k][count_] / entry;
            best = k;
        }
    }
    return best;
}

// Solves the row for the variable of the column and puts that into the others.
void MatrixGame::pivot(std::size_t row, std::size_t column) {
    auto& leaving = table_[row];
    const double inverse = 1 / leaving[column];
    for (std::size_t j = 0; j <= count_; ++j) {
        leaving[j] *= inverse;
    }
    leaving[column] = inverse;
    for (std::size_t k = 0; k <= kCorners; ++k) {
        const double factor = table_[k][column];
        if (k == row || factor == 0) {
            continue;
        }
        for (std::size_t j = 0; j <= count_; ++j) {
            table_[k][j] -= factor * leaving[j];
        }
        table_[k][column] = -factor * inverse;
    }
    std::swap(basic_[row], free_[column]);
}

// Where the objective grows without end along a column, the weights are its direction.
void MatrixGame::take_weights(std::size_t unbounded) {
    std::array<double, kMost> found{};
    const std::size_t column = unbounded == kNone ? count_ : unbounded;
    const double sign = unbounded == kNone ? 1 : -1;
    for (std::size_t k = 0; k < kCorners; ++k) {
        if (basic_[k] < count_) {
            found[basic_[k]] = std::max(0.0, sign * table_[k][column]);
        }
    }
    if (unbounded != kNone && free_[unbounded] < count_) {
        found[free_[unbounded]] = 1;
    }
    // Back to the values as they were given; rows are all scaled by the same factor.
    const double scale = row_count_ > 0 ? weights_[0] : 1;
    double sum = 0;
    for (std::size_t j = 0; j < count_; ++j) {
        found[j] *= j < row_count_ ? 1 : weights_[j] / scale;
        sum += j < row_count_ ? found[j] : 0;
    }
    if (!(sum > 0) || !std::isfinite(sum)) {
        found.fill(0);
        found[0] = sum = 1;
    }
    for (std::size_t j = 0; j < count_; ++j) {
        weights_[j] = found[j] / sum;
    }

    corner_weights_.fill(0);
    double corner_sum = 0;
    for (std::size_t j = 0; j < count_; ++j) {
        if (free_[j] >= count_) {
            const double weight = std::max(0.0, -table_[kCorners][j]);
            corner_weights_[free_[j] - count_] = weight;
            corner_sum += weight;
        }
    }
    for (double& weight : corner_weights_) {
        weight = corner_sum > 0 ? weight / corner_sum : 1.0 / kCorners;
    }
}

// The rows' weights sum to 1 up to 34 u, for they are at most 32 quotients of what was summed; a
// sum of at most 32 products is off by 33 u of the sum of their magnitudes. Together that is below
// 96 u of the largest sum of magnitudes, over all corners, as a sum of weights other than 1 scales
// the rows' part alone.
void MatrixGame::prove() {
    bound_ = -HUGE_VAL;
    double largest = 0;
    for (std::size_t k = 0; k < kCorners; ++k) {
        double sum = 0, magnitude = 0;
        for (std::size_t j = 0; j < count_; ++j) {
            const double term = weights_[j] * values_[j][k];
            sum += term;
            magnitude += std::fabs(term);
        }
        bound_ = std::max(bound_, sum);
        largest = std::max(largest, magnitude);
        if (!(sum <= bound_)) { // a NaN proves nothing
            bound_ = largest = HUGE_VAL;
            break;
        }
    }
    bound_ += 96 * kUnitRoundoff * largest;
    reach_ = 1 + 96 * kUnitRoundoff;
    for (std::size_t j = row_count_; j < count_; ++j) {
        reach_ += weights_[j];
    }
}

void MatrixGame::solve() {
    constexpr int kMostPivots = 64; // cycles end here, and the weights at hand prove what they do
    begin();
    std::size_t unbounded = kNone;
    for (int pivots = 0; pivots < kMostPivots; ++pivots) {
        const std::size_t column = entering();
        if (column == kNone) {
            break;
        }
        const std::size_t row = leaving(column);
        if (row == kNone) {
            unbounded = column;
            break;
        }
        pivot(row, column);
    }
    take_weights(unbounded);
    prove();
}

} // namespace obb
