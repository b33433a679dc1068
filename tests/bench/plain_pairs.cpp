// The paper's tests in plain doubles, with no thought for rounding: what certainty is measured
// against. Tables 1, 3 and 5 of Eberly 2008; moving shapes by the times each axis allows.
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace {

struct Vec {
    double x, y, z;
    double operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
};
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double low3(double a, double b, double c) { return std::min(std::min(a, b), c); }
double high3(double a, double b, double c) { return std::max(std::max(a, b), c); }

struct Triangle {
    Vec p[3];
};
struct Box {
    Vec center, axes[3], half;
};

// Takes low <= speed t <= high of each axis; true: never within the duration.
struct Still {
    explicit Still(double) {}
    bool operator()(double low, double high, double) { return low > 0 || high < 0; }
};
struct Moving {
    double first = 0, last;
    explicit Moving(double duration) : last(duration) {}
    bool operator()(double low, double high, double speed) {
        if (speed == 0) {
            return low > 0 || high < 0;
        }
        const double pace = 1 / speed;
        first = std::max(first, (speed > 0 ? low : high) * pace);
        last = std::min(last, (speed > 0 ? high : low) * pace);
        return first > last;
    }
};

template <bool kMoving, typename Test>
bool apart(const Triangle& a, const Triangle& b, Vec w, Test test) {
    const Vec e[3] = {a.p[1] - a.p[0], a.p[2] - a.p[1], a.p[0] - a.p[2]};
    const Vec f[3] = {b.p[1] - b.p[0], b.p[2] - b.p[1], b.p[0] - b.p[2]};
    const Vec d = b.p[0] - a.p[0], n = cross(e[0], e[1]), m = cross(f[0], f[1]);
    const double nf[3] = {dot(n, f[0]), dot(n, f[1]), dot(n, f[2])};
    const double q = dot(n, d);
    if (test(-high3(q, q + nf[0], q - nf[2]), -low3(q, q + nf[0], q - nf[2]),
             kMoving ? dot(n, w) : 0)) {
        return true;
    }
    const double me[3] = {dot(m, e[0]), dot(m, e[1]), dot(m, e[2])};
    const double r = dot(m, d);
    if (test(low3(0, me[0], -me[2]) - r, high3(0, me[0], -me[2]) - r, kMoving ? dot(m, w) : 0)) {
        return true;
    }
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const Vec axis = cross(e[i], f[j]);
            const double s = dot(axis, b.p[j] - a.p[i]);
            if (test(std::min(0.0, -nf[j]) - s - std::max(0.0, me[i]),
                     std::max(0.0, -nf[j]) - s - std::min(0.0, me[i]),
                     kMoving ? dot(axis, w) : 0)) {
                return true;
            }
        }
    }
    return false;
}

template <bool kMoving, typename Test>
bool apart(const Box& a, const Box& b, Vec v, Test test) {
    const Vec d = b.center - a.center;
    const Vec w = {dot(a.axes[0], v), dot(a.axes[1], v), dot(a.axes[2], v)};
    double c[3][3], r[3][3], t[3];
    for (int i = 0; i < 3; ++i) {
        t[i] = dot(a.axes[i], d);
        double radius = a.half[i];
        for (int j = 0; j < 3; ++j) {
            c[i][j] = dot(a.axes[i], b.axes[j]);
            r[i][j] = std::fabs(c[i][j]);
            radius += b.half[j] * r[i][j];
        }
        if (test(-radius - t[i], radius - t[i], kMoving ? w[i] : 0)) {
            return true;
        }
    }
    for (int j = 0; j < 3; ++j) {
        const double s = t[0] * c[0][j] + t[1] * c[1][j] + t[2] * c[2][j];
        const double radius =
            b.half[j] + a.half.x * r[0][j] + a.half.y * r[1][j] + a.half.z * r[2][j];
        const double speed = kMoving ? w.x * c[0][j] + w.y * c[1][j] + w.z * c[2][j] : 0;
        if (test(-radius - s, radius - s, speed)) {
            return true;
        }
    }
    for (int i = 0; i < 3; ++i) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (int j = 0; j < 3; ++j) {
            const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            const double s = t[i2] * c[i1][j] - t[i1] * c[i2][j];
            const double radius = a.half[i1] * r[i2][j] + a.half[i2] * r[i1][j] +
                                  b.half[j1] * r[i][j2] + b.half[j2] * r[i][j1];
            if (test(-radius - s, radius - s, kMoving ? w[i2] * c[i1][j] - w[i1] * c[i2][j] : 0)) {
                return true;
            }
        }
    }
    return false;
}

template <bool kMoving, typename Test>
bool apart(const Box& a, const Triangle& b, Vec v, Test test) {
    Vec y[3];
    for (int k = 0; k < 3; ++k) {
        const Vec d = b.p[k] - a.center;
        y[k] = {dot(a.axes[0], d), dot(a.axes[1], d), dot(a.axes[2], d)};
    }
    const Vec w = {dot(a.axes[0], v), dot(a.axes[1], v), dot(a.axes[2], v)};
    const Vec e[3] = {y[1] - y[0], y[2] - y[1], y[0] - y[2]};
    const Vec h = a.half, n = cross(e[0], e[1]);
    const double q = dot(n, y[0]);
    const double radius = h.x * std::fabs(n.x) + h.y * std::fabs(n.y) + h.z * std::fabs(n.z);
    if (test(-radius - q, radius - q, kMoving ? dot(n, w) : 0)) {
        return true;
    }
    for (int i = 0; i < 3; ++i) {
        if (test(-h[i] - high3(y[0][i], y[1][i], y[2][i]), h[i] - low3(y[0][i], y[1][i], y[2][i]),
                 kMoving ? w[i] : 0)) {
            return true;
        }
    }
    for (int i = 0; i < 3; ++i) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (int j = 0; j < 3; ++j) {
            const double l1 = -e[j][i2], l2 = e[j][i1];
            const Vec& opposite = y[(j + 2) % 3];
            const double s = l1 * y[j][i1] + l2 * y[j][i2];
            const double s2 = l1 * opposite[i1] + l2 * opposite[i2];
            const double reach = h[i1] * std::fabs(l1) + h[i2] * std::fabs(l2);
            if (test(-reach - std::max(s, s2), reach - std::min(s, s2),
                     kMoving ? l1 * w[i1] + l2 * w[i2] : 0)) {
                return true;
            }
        }
    }
    return false;
}

template <typename A, typename B>
void run(const A* a, const B* b, const Vec* velocity, double duration, std::int64_t count,
         std::uint8_t* meets) {
    for (std::int64_t k = 0; k < count; ++k) {
        meets[k] = velocity == nullptr
                       ? !apart<false>(a[k], b[k], Vec{0, 0, 0}, Still(0))
                       : !apart<true, Moving>(a[k], b[k], velocity[k], Moving(duration));
    }
}

} // namespace

extern "C" {
void triangles(const Triangle* a, const Triangle* b, const Vec* velocity, double duration,
               std::int64_t count, std::uint8_t* meets) {
    run(a, b, velocity, duration, count, meets);
}
void boxes(const Box* a, const Box* b, const Vec* velocity, double duration, std::int64_t count,
           std::uint8_t* meets) {
    run(a, b, velocity, duration, count, meets);
}
void box_triangle(const Box* a, const Triangle* b, const Vec* velocity, double duration,
                  std::int64_t count, std::uint8_t* meets) {
    run(a, b, velocity, duration, count, meets);
}
}
