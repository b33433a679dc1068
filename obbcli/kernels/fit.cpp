#include "fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace obb {

// Eberly's 6.1.3 with its weights mended: the mean of a triangle is the third of its corners' sum,
// its second moment (sum_j P_j P_j^T + (sum P)(sum P)^T) / 12; the printed form loses the first
// term, has rank one and is zero for a single triangle. The common factors 3 and 12 wait in
// principal_axes().
void Moments::add_weighted(const Triangle& t, double weight, double corner_share,
                           double sum_share) {
    const Vec3 s = t[0] + t[1] + t[2];
    const auto second = [&](std::size_t i, std::size_t k) {
        const double corners = t[0][i] * t[0][k] + t[1][i] * t[1][k] + t[2][i] * t[2][k];
        return weight * (corner_share * corners + sum_share * (s[i] * s[k]));
    };
    weight_ += weight;
    first_ = first_ + weight * s;
    second_[0] += second(0, 0);
    second_[1] += second(0, 1);
    second_[2] += second(0, 2);
    second_[3] += second(1, 1);
    second_[4] += second(1, 2);
    second_[5] += second(2, 2);
}

void Moments::add(const Triangle& t, Fit fit) {
    if (fit == Fit::kPoints) {
        add_corners(t);
    } else {
        add_weighted(t, norm(cross(t[1] - t[0], t[2] - t[0])), 1.0, 1.0);
    }
}

// Three point masses: (sum_j P_j P_j^T) / 3 = 4 (sum_j P_j P_j^T) / 12.
void Moments::add_corners(const Triangle& t) { add_weighted(t, 1.0, 4.0, 0.0); }

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// One Jacobi rotation that makes m[p][q] zero. Golub & Van Loan 2013, Algorithm 8.5.1.
void rotate(Matrix& m, Matrix& vectors, std::size_t p, std::size_t q) {
    if (m[p][q] == 0.0) {
        return;
    }
    const double tau = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
    const double t = std::copysign(1.0, tau) / (std::fabs(tau) + std::sqrt(1.0 + tau * tau));
    const double c = 1.0 / std::sqrt(1.0 + t * t);
    const double s = t * c;
    const std::size_t r = 3 - p - q;
    const double mpq = m[p][q], mrp = m[r][p], mrq = m[r][q];
    m[p][p] -= t * mpq;
    m[q][q] += t * mpq;
    m[p][q] = m[q][p] = 0.0;
    m[r][p] = m[p][r] = c * mrp - s * mrq;
    m[r][q] = m[q][r] = s * mrp + c * mrq;
    for (auto& row : vectors) {
        const double vp = row[p], vq = row[q];
        row[p] = c * vp - s * vq;
        row[q] = s * vp + c * vq;
    }
}

} // namespace

// Jacobi uses only + - * / and sqrt, so that the same mesh gives the same tree on every machine.
std::array<Vec3, 3> Moments::principal_axes() const {
    // The convergence is quadratic: the axes are as good as the float32 quaternion that keeps them
    // once the off-diagonal part is this small, and a later sweep changes nothing that is stored.
    constexpr double kConverged = 0x1p-60;
    constexpr int kMaxSweeps = 16;

    const Vec3 mean = (1.0 / weight_) * first_;
    const auto covariance = [&](std::size_t k, double a, double b) {
        return second_[k] / weight_ / 12.0 - a * b / 9.0;
    };
    Matrix m;
    m[0][0] = covariance(0, mean.x, mean.x);
    m[1][1] = covariance(3, mean.y, mean.y);
    m[2][2] = covariance(5, mean.z, mean.z);
    m[0][1] = m[1][0] = covariance(1, mean.x, mean.y);
    m[0][2] = m[2][0] = covariance(2, mean.x, mean.z);
    m[1][2] = m[2][1] = covariance(4, mean.y, mean.z);

    Matrix v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
        const double off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
        const double on = m[0][0] * m[0][0] + m[1][1] * m[1][1] + m[2][2] * m[2][2];
        if (!(off > kConverged * on)) { // also when the sums are not numbers
            break;
        }
        rotate(m, v, 0, 1);
        rotate(m, v, 0, 2);
        rotate(m, v, 1, 2);
    }
    const Vec3 first{v[0][0], v[1][0], v[2][0]};
    const Vec3 second{v[0][1], v[1][1], v[2][1]};
    return {first, second, cross(first, second)};
}

// Shepperd 1978: divide by the largest component, so that nothing cancels.
std::array<float, 4> quaternion_of(const std::array<Vec3, 3>& a) {
    const double xx = a[0].x, yy = a[1].y, zz = a[2].z;
    std::array<double, 4> q{1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz};
    const auto largest = std::max_element(q.begin(), q.end()) - q.begin();
    const double wx = a[1].z - a[2].y, wy = a[2].x - a[0].z, wz = a[0].y - a[1].x;
    const double xy = a[0].y + a[1].x, xz = a[0].z + a[2].x, yz = a[1].z + a[2].y;
    switch (largest) {
    case 0:
        q = {q[0], wx, wy, wz};
        break;
    case 1:
        q = {wx, q[1], xy, xz};
        break;
    case 2:
        q = {wy, xy, q[2], yz};
        break;
    default:
        q = {wz, xz, yz, q[3]};
        break;
    }
    std::array<float, 4> result;
    for (std::size_t k = 0; k < 4; ++k) {
        result[k] = static_cast<float>(q[k]);
    }
    const float length = result[0] * result[0] + result[1] * result[1] + result[2] * result[2] +
                         result[3] * result[3];
    return length > 0.5f ? result : std::array<float, 4>{1, 0, 0, 0}; // not a number: any axes do
}

} // namespace obb
