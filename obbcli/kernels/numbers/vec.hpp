// Vectors and matrices of three doubles: the arithmetic under every other kernel.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace obb {

// Of doubles, or of numbers of more digits.
template <typename Real>
struct Vector3 {
    Real x, y, z;

    [[nodiscard]] constexpr Real operator[](std::size_t k) const {
        return k == 0 ? x : k == 1 ? y : z;
    }
    [[nodiscard]] constexpr Real& operator[](std::size_t k) { return k == 0 ? x : k == 1 ? y : z; }

    friend constexpr Vector3 operator+(Vector3 a, Vector3 b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend constexpr Vector3 operator-(Vector3 a, Vector3 b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend constexpr Vector3 operator-(Vector3 a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vector3 operator*(Real s, Vector3 a) { return {s * a.x, s * a.y, s * a.z}; }
    friend constexpr bool operator==(const Vector3&, const Vector3&) = default;
};

using Vec3 = Vector3<double>;

template <typename Real>
[[nodiscard]] constexpr Real dot(Vector3<Real> a, Vector3<Real> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] constexpr Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline Vec3 abs(Vec3 a) { return {std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)}; }
[[nodiscard]] inline bool is_finite(Vec3 a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
[[nodiscard]] inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }

// Sum and largest of the absolute components: the norms that rounding bounds are written in.
[[nodiscard]] inline double norm_1(Vec3 a) {
    return std::fabs(a.x) + std::fabs(a.y) + std::fabs(a.z);
}
[[nodiscard]] inline double norm_inf(Vec3 a) {
    const Vec3 b = abs(a);
    const double yz = b.y < b.z ? b.z : b.y; // std::fmax is a call, for the sake of NaN
    return b.x < yz ? yz : b.x;
}

// The direction of a vector of any length, to rounding; that of zero is the fallback.
[[nodiscard]] inline Vec3 unit_or(Vec3 v, Vec3 fallback) {
    const double scale = norm_inf(v);
    if (!(scale > 0)) {
        return fallback;
    }
    const Vec3 w = (1.0 / scale) * v;
    return (1.0 / norm(w)) * w;
}

// Rows of a 3x3 matrix.
struct Mat3 {
    std::array<Vec3, 3> rows;

    [[nodiscard]] static constexpr Mat3 identity() {
        return {{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}};
    }
    [[nodiscard]] constexpr Vec3 column(std::size_t k) const {
        return {rows[0][k], rows[1][k], rows[2][k]};
    }
    friend constexpr bool operator==(const Mat3&, const Mat3&) = default;
};

[[nodiscard]] constexpr Vec3 operator*(const Mat3& m, Vec3 v) {
    return {dot(m.rows[0], v), dot(m.rows[1], v), dot(m.rows[2], v)};
}

[[nodiscard]] inline Mat3 operator*(const Mat3& a, const Mat3& b) {
    const Vec3 c0 = b.column(0), c1 = b.column(1), c2 = b.column(2);
    Mat3 result;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 row = a.rows[i];
        result.rows[i] = {dot(row, c0), dot(row, c1), dot(row, c2)};
    }
    return result;
}

// Inverse of a matrix that is orthonormal up to 1e-9, by its adjugate.
[[nodiscard]] inline Mat3 inverse(const Mat3& m) {
    const Vec3 c0 = cross(m.rows[1], m.rows[2]);
    const Vec3 c1 = cross(m.rows[2], m.rows[0]);
    const Vec3 c2 = cross(m.rows[0], m.rows[1]);
    const double scale = 1.0 / dot(m.rows[0], c0);
    return {{scale * Vec3{c0.x, c1.x, c2.x}, scale * Vec3{c0.y, c1.y, c2.y},
             scale * Vec3{c0.z, c1.z, c2.z}}};
}

// How far columns are from orthonormal: the largest entry of |M^T M - 1|.
[[nodiscard]] inline double skew_of(const Mat3& m) {
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            const double wanted = i == j ? 1 : 0;
            const double entry = std::fabs(dot(m.column(i), m.column(j)) - wanted);
            largest = largest < entry ? entry : largest;
        }
    }
    return largest;
}

// Unit roundoff of double: half a unit in the last place of 1.
inline constexpr double kUnitRoundoff = 0x1p-53;

} // namespace obb
