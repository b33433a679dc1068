#include "in_motion/triangle_advancement.hpp"

#include "shapes/extremes.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::array<Vec3, 3> edges_of(const Triangle& t) { return {t[1] - t[0], t[2] - t[1], t[0] - t[2]}; }

// Projections of points and velocities on one axis, and what bounds their accelerations.
struct Side {
    std::array<double, 3> position, velocity, acceleration;
};

// The least root over all pairs of vertices.
double least_root(const Side& a, const Side& b, double error, double velocity_error) {
    double least = kInfinity;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const double gap = b.position[j] - a.position[i] - error;
            const double w = b.velocity[j] - a.velocity[i] - velocity_error;
            const double h = closing_time(gap, w, a.acceleration[i] + b.acceleration[j]);
            least = smaller(least, h);
        }
    }
    return least;
}

class TriangleAxes {
  public:
    TriangleAxes(const SpinningTriangle& a, const SpinningTriangle& b, const MovingFrame& frame)
        : a_(a), b_(b), frame_(frame) {
        const double sizes = a.size + b.size;
        error_ = frame.relative * sizes + frame.absolute;
        speeds_ = frame.spin_a->speed() + frame.spin_b->speed();
        velocity_error_ = frame.relative * (speeds_ * (sizes + norm_1(frame.between)) +
                                            norm_1(frame.closing_velocity));
    }

    [[nodiscard]] const TriangleStep& best() const { return best_; }

    // Tries n in the world; cheap where it shows no gap.
    void try_axis(Vec3 direction) {
        std::array<double, 3> pa, pb;
        if (!(gap_along(direction, pa, pb) > 0)) {
            return; // before a root and a division are spent on it
        }
        Vec3 n = unit_or(direction, {0, 0, 0});
        const double gap = gap_along(n, pa, pb);
        if (!(gap > error_)) {
            return;
        }
        const bool is_behind = pa[0] > pb[0];
        if (is_behind) {
            n = -n;
            for (std::size_t k = 0; k < 3; ++k) {
                pa[k] = -pa[k];
                pb[k] = -pb[k];
            }
        }
        consider({in_world(n, pa, pb), gap, n});
    }

    // The same axis fixed in either body.
    void try_attached() {
        if (speeds_ == 0 || best_.time == 0) {
            return;
        }
        const Vec3 n = best_.normal;
        consider({attached<true>(n), 0, n});
        consider({attached<false>(n), 0, n});
    }

  private:
    // Projections of both, and the gap between them.
    [[nodiscard]] double gap_along(Vec3 n, std::array<double, 3>& pa,
                                   std::array<double, 3>& pb) const {
        const double offset = dot(n, frame_.between);
        for (std::size_t k = 0; k < 3; ++k) {
            pa[k] = dot(n, a_.points[k]);
            pb[k] = dot(n, b_.points[k]) + offset;
        }
        const double ahead = smallest(pb[0], pb[1], pb[2]) - largest(pa[0], pa[1], pa[2]);
        const double behind = smallest(pa[0], pa[1], pa[2]) - largest(pb[0], pb[1], pb[2]);
        return larger(ahead, behind);
    }

    void consider(const TriangleStep& step) {
        const double gap = larger(best_.gap, step.gap);
        if (step.time > best_.time) {
            best_ = step;
        }
        best_.gap = gap;
    }

    [[nodiscard]] static double across(const Spin& spin, Vec3 n) {
        return spin.is_still() ? 0.0
                               : spin.speed() * norm(cross(n, spin.velocity())) * (1 + 0x1p-40);
    }

    [[nodiscard]] double in_world(Vec3 n, const std::array<double, 3>& pa,
                                  const std::array<double, 3>& pb) const {
        const double drift = dot(n, frame_.closing_velocity);
        const double across_a = across(*frame_.spin_a, n), across_b = across(*frame_.spin_b, n);
        Side a{pa, {}, {}}, b{pb, {}, {}};
        for (std::size_t k = 0; k < 3; ++k) {
            a.velocity[k] = dot(n, a_.velocities[k]);
            b.velocity[k] = dot(n, b_.velocities[k]) + drift;
            a.acceleration[k] = across_a * a_.radii[k];
            b.acceleration[k] = across_b * b_.radii[k];
        }
        const double parabola = least_root(a, b, error_, velocity_error_);
        return larger(parabola, on_circles(n, drift));
    }

    // Bounds by the whole circles of the points: good for many turns.
    [[nodiscard]] double on_circles(Vec3 n, double drift) const {
        if (!(speeds_ * frame_.remaining > 0.5)) {
            return 0;
        }
        const auto farthest = [&](const SpinningTriangle& t, const Spin& spin, double sign) {
            const double along = dot(n, spin.axis());
            const double width = spin.is_still() ? 0.0 : norm(cross(n, spin.axis()));
            double most = -kInfinity;
            for (std::size_t k = 0; k < 3; ++k) {
                const double center =
                    spin.is_still() ? dot(n, t.points[k]) : along * dot(spin.axis(), t.points[k]);
                most = larger(most, sign * center + width * t.radii[k]);
            }
            return most;
        };
        const double gap = dot(n, frame_.between) - farthest(a_, *frame_.spin_a, 1.0) -
                           farthest(b_, *frame_.spin_b, -1.0) - error_;
        const double drift_error = frame_.relative * norm_1(frame_.closing_velocity);
        return gap > 0 ? closing_time(gap, drift - drift_error, 0.0) : 0.0;
    }

    // Seen from one body, at rest there, a point q of the other moves with u + O x r, where O is
    // the difference of the spins, and its acceleration is at most |O| (|W'| r + |W| |r|) + 2 |W x
    // u| + |W|^2 |D|, D the way between the pivots.
    template <bool kInA>
    [[nodiscard]] double attached(Vec3 n) const {
        const Spin& own = kInA ? *frame_.spin_a : *frame_.spin_b;
        const Spin& other = kInA ? *frame_.spin_b : *frame_.spin_a;
        if (own.is_still()) {
            return 0;
        }
        const SpinningTriangle& still = kInA ? a_ : b_;
        const SpinningTriangle& moving = kInA ? b_ : a_;
        const double sign = kInA ? 1.0 : -1.0;
        const Vec3 between = sign * frame_.between;
        const Vec3 drift = sign * frame_.closing_velocity;
        const Vec3 w = own.velocity();
        const double difference = norm(other.velocity() - w);
        const double way = larger(norm(between), norm(between + frame_.remaining * drift));
        const double shared = 2 * norm(cross(w, drift)) + own.speed() * own.speed() * way;
        Side a{}, b{};
        Side& seen = kInA ? b : a;
        Side& at_rest = kInA ? a : b;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 q = moving.points[k];
            at_rest.position[k] = dot(n, still.points[k]);
            seen.position[k] = dot(n, q + between);
            seen.velocity[k] = dot(n, drift + moving.velocities[k] - cross(w, q + between));
            seen.acceleration[k] =
                (1 + 0x1p-40) *
                (difference * (other.speed() * moving.radii[k] + own.speed() * norm(q)) + shared);
        }
        return least_root(a, b, error_, velocity_error_);
    }

    const SpinningTriangle& a_;
    const SpinningTriangle& b_;
    const MovingFrame& frame_;
    double error_, velocity_error_, speeds_;
    TriangleStep best_;
};

} // namespace

SpinningTriangle::SpinningTriangle(const Triangle& t, const Spin& spin) : points(t), size(0) {
    for (std::size_t k = 0; k < 3; ++k) {
        velocities[k] = cross(spin.velocity(), t[k]);
        radii[k] = spin.is_still() ? 0.0 : norm(cross(spin.axis(), t[k])) * (1 + 0x1p-40);
        size = larger(size, norm_1(t[k]));
    }
}

// All axes of the complete set (Eberly 2008 §4, with the in-plane axes that coplanar triangles
// need), the rotation axes, and the hint.
TriangleStep triangle_step(const SpinningTriangle& a, const SpinningTriangle& b,
                           const MovingFrame& frame, Vec3 hint) {
    TriangleAxes axes(a, b, frame);
    const auto e = edges_of(a.points), f = edges_of(b.points);
    const Vec3 normal_a = cross(e[0], e[1]), normal_b = cross(f[0], f[1]);
    axes.try_axis(normal_a);
    axes.try_axis(normal_b);
    for (const Vec3& ea : e) {
        for (const Vec3& fb : f) {
            axes.try_axis(cross(ea, fb));
        }
    }
    for (std::size_t k = 0; k < 3; ++k) {
        axes.try_axis(cross(normal_a, e[k]));
        axes.try_axis(cross(normal_b, f[k]));
    }
    axes.try_axis(frame.spin_a->axis());
    axes.try_axis(frame.spin_b->axis());
    axes.try_axis(hint);
    axes.try_attached();
    return axes.best();
}

} // namespace obb
