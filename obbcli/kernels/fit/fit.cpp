#include "fit/fit.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

template <typename Reals>
using Matrix = std::array<std::array<Reals, 3>, 3>;

// One Jacobi rotation, in the lanes of the mask, that makes m[p][q] zero. Golub & Van Loan 2013,
// Algorithm 8.5.1.
template <std::size_t p, std::size_t q, typename Reals>
OBB_INLINE void rotate(Matrix<Reals>& m, Matrix<Reals>& vectors,
                       const typename Reals::Mask& wanted) {
    constexpr std::size_t r = 3 - p - q;
    constexpr double kNothing = 0x1p-500; // its square vanishes
    const Reals mpq = m[p][q], mrp = m[r][p], mrq = m[r][q];
    const Reals d = m[q][q] - m[p][p];
    const Reals root = root_of(d * d + 4.0 * (mpq * mpq));
    const Reals tangent = (mpq + mpq) / select(d < 0.0, d - root, d + root);
    const auto turns = wanted & (magnitude(mpq) > kNothing);
    const Reals t = select(turns, tangent, 0.0);
    const Reals c = 1.0 / root_of(1.0 + t * t);
    const Reals s = t * c;
    m[p][p] -= t * mpq;
    m[q][q] += t * mpq;
    m[p][q] = m[q][p] = select(turns, 0.0, mpq);
    m[r][p] = m[p][r] = c * mrp - s * mrq;
    m[r][q] = m[q][r] = s * mrp + c * mrq;
    for (auto& row : vectors) {
        const Reals vp = row[p], vq = row[q];
        row[p] = c * vp - s * vq;
        row[q] = s * vp + c * vq;
    }
}

// Eigenvectors as columns. Jacobi uses only + - * / and sqrt, so that the same mesh gives the same
// tree on every machine; a lane that has converged is left alone, so that its company changes
// nothing.
template <typename Reals>
OBB_INLINE Matrix<Reals> eigenvectors_of(Matrix<Reals>& m) {
    // The convergence is quadratic: the axes are as good as the float32 quaternion that keeps them
    // once the off-diagonal part is this small, and a later sweep changes nothing that is stored.
    constexpr double kConverged = 0x1p-60;
    constexpr int kMaxSweeps = 16;
    Matrix<Reals> v;
    v[0][0] = v[1][1] = v[2][2] = 1.0;
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
        const Reals off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
        const Reals on = m[0][0] * m[0][0] + m[1][1] * m[1][1] + m[2][2] * m[2][2];
        const auto wanted = off > kConverged * on; // never where they are not numbers
        if (!wanted.is_any()) {
            break;
        }
        rotate<0, 1>(m, v, wanted);
        rotate<0, 2>(m, v, wanted);
        rotate<1, 2>(m, v, wanted);
    }
    return v;
}

// Of trace 1, so that squares neither vanish nor overflow.
template <typename Reals>
OBB_INLINE Matrix<Reals> covariances_of(std::span<const Moments, kOrientationsAtOnce> moments) {
    Reals weight;
    std::array<Reals, 3> first;
    std::array<Reals, 6> second;
    for (std::size_t lane = 0; lane < kOrientationsAtOnce; ++lane) {
        const Moments& one = moments[lane];
        weight.set(lane, one.weight);
        for (std::size_t i = 0; i < 3; ++i) {
            first[i].set(lane, one.first[i]);
        }
        for (std::size_t k = 0; k < 6; ++k) {
            second[k].set(lane, one.second[k]);
        }
    }
    Matrix<Reals> m;
    std::size_t k = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = i; j < 3; ++j, ++k) {
            m[i][j] = m[j][i] =
                second[k] / weight / 12.0 - first[i] / weight * (first[j] / weight) / 9.0;
        }
    }
    const Reals trace = magnitude(m[0][0]) + magnitude(m[1][1]) + magnitude(m[2][2]);
    for (auto& row : m) {
        for (Reals& entry : row) {
            entry /= trace;
        }
    }
    return m;
}

// Two of the eigenvectors of each covariance matrix, and all eigenvalues.
struct Eigensystem {
    Vec3 first, second;
    Vec3 values;
};
using Eigensystems = std::array<Eigensystem, kOrientationsAtOnce>;

template <std::size_t kBytes>
OBB_INLINE void find_eigensystems(std::span<const Moments, kOrientationsAtOnce> moments,
                                  Eigensystems& found) {
    auto m = covariances_of<Lanes<double, kOrientationsAtOnce, kBytes>>(moments);
    const auto v = eigenvectors_of(m); // what is left on the diagonal are the eigenvalues
    for (std::size_t lane = 0; lane < kOrientationsAtOnce; ++lane) {
        found[lane] = {{v[0][0][lane], v[1][0][lane], v[2][0][lane]},
                       {v[0][1][lane], v[1][1][lane], v[2][1][lane]},
                       {m[0][0][lane], m[1][1][lane], m[2][2][lane]}};
    }
}

Eigensystems eigensystems_of(std::span<const Moments, kOrientationsAtOnce> moments) {
    Eigensystems found;
    in_registers([&]<std::size_t kBytes>() { find_eigensystems<kBytes>(moments, found); });
    return found;
}

} // namespace

void Moments::add(const Triangle& t, bool by_corners) {
    LaneTriangles<Doubles<kNarrow>> lanes;
    for (std::size_t k = 0; k < 9; ++k) {
        lanes[k / 3][k % 3] = t[k / 3][k % 3];
    }
    MomentSums<Doubles<kNarrow>> sums;
    sums.add(lanes, Doubles<kNarrow>::first(1), by_corners);
    sums.add_to(*this);
}

std::array<Vec3, 3> principal_axes(const Moments& moments) {
    std::array<Moments, kOrientationsAtOnce> one;
    one[0] = moments;
    const Eigensystem found = eigensystems_of(one)[0];
    return {found.first, found.second, cross(found.first, found.second)};
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

void orient(std::span<const Moments, kOrientationsAtOnce> moments,
            std::span<Orientation, kOrientationsAtOnce> orientations) {
    const Eigensystems found = eigensystems_of(moments);
    for (std::size_t lane = 0; lane < kOrientationsAtOnce; ++lane) {
        Orientation& orientation = orientations[lane];
        orientation = {};
        if (!moments[lane].is_empty()) {
            const auto& [first, second, values] = found[lane];
            orientation.rotation = quaternion_of({first, second, cross(first, second)});
            orientation.axes = axes_of(orientation.rotation);
            orientation.widest = values.x >= values.y ? (values.x >= values.z ? 0 : 2)
                                                      : (values.y >= values.z ? 1 : 2);
        }
    }
}

} // namespace obb
