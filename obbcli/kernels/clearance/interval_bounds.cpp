#include "clearance/interval_bounds.hpp"

#include "clearance/edge_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace obb {

namespace {

// Rounding. A projection n . z sums products of positions that are off by `relative` times their
// size and by `absolute`. Its first derivative times h is off by as large a share of
// (|Wx| + |Wy|) h |z| + h |V|, the second by one of half the square: with (|Wx| + |Wy|) h at most
// 1/4 and h |V| within `absolute` they come to less than the projection's own, each with up to
// three times as many operations. Four times the error of the projection covers the three.
constexpr double kTerms = 4;

[[nodiscard]] double radius_along(const Obb& box, Vec3 n) {
    return box.half_extents.x * std::fabs(dot(n, box.axes[0])) +
           box.half_extents.y * std::fabs(dot(n, box.axes[1])) +
           box.half_extents.z * std::fabs(dot(n, box.axes[2]));
}

[[nodiscard]] double extents(const Obb& box) {
    return box.half_extents.x + box.half_extents.y + box.half_extents.z;
}

// A direction from X to Y between points that are nearly the nearest; any will do.
[[nodiscard]] Vec3 near_direction(const Obb& x, const Obb& y, Vec3 y_center) {
    const auto nearest_in = [](const Obb& box, Vec3 center, Vec3 p) {
        Vec3 q = center;
        for (std::size_t k = 0; k < 3; ++k) {
            const double h = box.half_extents[k];
            q = q + std::clamp(dot(box.axes[k], p - center), -h, h) * box.axes[k];
        }
        return q;
    };
    const Vec3 p = nearest_in(x, x.center, y_center);
    const Vec3 q = nearest_in(y, y_center, p);
    return q - nearest_in(x, x.center, q);
}

// The least of a + b s + c s^2 for |s| <= h.
[[nodiscard]] double least_of(double a, double b, double c, double h) {
    const double slope = std::fabs(b);
    return c > 0 && slope < 2 * c * h ? a - slope * slope / (4 * c) : a - slope * h + c * h * h;
}

// Boxes as seen from X.
class BoxPair {
  public:
    BoxPair(const IntervalFrame& frame, const RelativeMotion& motion, const Obb& x, const Obb& y)
        : motion_(&motion), x_(&x), y_(&y), half_(frame.half),
          center_(motion.between() + y.center) {
        const double sizes = norm_1(x.center) + norm_1(y.center) + extents(x) + extents(y);
        error_ = kTerms * (frame.relative * sizes + frame.absolute + frame.box_error) +
                 8 * frame.skew * (extents(x) + extents(y));
        const double reach = norm(y.half_extents) * (1 + 2 * frame.skew);
        const double radius = (1 + 0x1p-40) * (norm(y.center) + reach);
        const double around = std::min(motion.axis_radius(y.center, radius) + reach, radius);
        bend_ = (1 + 0x1p-20) * motion.jerk(radius, around, half_) * half_ * half_ * half_ / 6;
        bound_.travel = half_ * motion.speed(y.center, reach);
    }

    // The gap at the middle, and where that promises more than is proven, that of all the interval:
    // the quadratic lies above its least control value, which is one linear form in r, least over
    // a box in closed form.
    void try_axis(Vec3 n) {
        const double offset = dot(n, center_ - x_->center);
        if (offset < 0) {
            n = -n;
        }
        const double width = radius_along(*x_, n);
        const double gap = std::fabs(offset) - width - radius_along(*y_, n) - error_;
        bound_.gap = std::max(bound_.gap, gap);
        if (!(gap > bound_.low)) {
            return;
        }
        const MotionForms f = motion_->forms(n);
        const double square = 0.5 * half_ * half_;
        const Vec3 step = half_ * f.first, bow = square * f.second;
        const double along = half_ * f.first_constant, over = square * f.second_constant;
        const double base = dot(n, motion_->between());
        const double least =
            std::min({lowest(base - along + over, n - step + bow), lowest(base - over, n - bow),
                      lowest(base + along + over, n + step + bow)});
        bound_.low = std::max(bound_.low, least - dot(n, x_->center) - width - bend_ - error_);
    }

    [[nodiscard]] BoxBound bound() const { return bound_; }

  private:
    [[nodiscard]] double lowest(double constant, Vec3 form) const {
        return constant + dot(form, y_->center) - radius_along(*y_, form);
    }

    const RelativeMotion* motion_;
    const Obb *x_, *y_;
    double half_;
    Vec3 center_; // of Y's box, about X's pivot
    double error_ = 0, bend_ = 0;
    BoxBound bound_{0, 0, 0};
};

// Triangles as seen from X, along directions that are fixed in it.
class TrianglePair {
  public:
    TrianglePair(const IntervalFrame& frame, const RelativeMotion& motion, const Triangle& x,
                 const Triangle& y)
        : motion_(&motion), x_(&x), y_(&y), half_(frame.half) {
        for (std::size_t k = 0; k < 3; ++k) {
            const double radius = (1 + 0x1p-40) * norm(y[k]);
            const double jerk = motion.jerk(radius, motion.axis_radius(y[k], radius), half_);
            bends_[k] = (1 + 0x1p-20) * jerk * half_ * half_ * half_ / 6;
        }
    }

    // From X to Y or the other way round; lengths count.
    [[nodiscard]] double along(Vec3 n) const {
        const double length = norm(n);
        if (!(length > 0x1p-300)) {
            return 0;
        }
        n = (1 / length) * n;
        const Vec3 y0 = motion_->between() + (*y_)[0];
        if (dot(n, y0 - (*x_)[0]) < 0) {
            n = -n;
        }
        const MotionForms f = motion_->forms(n);
        const double base = dot(n, motion_->between());
        double least = HUGE_VAL;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 r = (*y_)[k];
            const double low = least_of(base + dot(n, r), f.first_constant + dot(f.first, r),
                                        0.5 * (f.second_constant + dot(f.second, r)), half_);
            least = std::min(least, low - bends_[k]);
        }
        return least - std::max({dot(n, (*x_)[0]), dot(n, (*x_)[1]), dot(n, (*x_)[2])});
    }

  private:
    const RelativeMotion* motion_;
    const Triangle *x_, *y_;
    double half_;
    std::array<double, 3> bends_{};
};

[[nodiscard]] Vec3 normal_of(const Triangle& t) { return cross(t[1] - t[0], t[2] - t[0]); }

} // namespace

IntervalFrame::IntervalFrame(const MovingPair& pair, double middle, double half_length,
                             double slack)
    : half(half_length) {
    const MovingFrame frame = pair.frame(slack, middle);
    from_a = RelativeMotion(frame, true);
    from_b = RelativeMotion(frame, false);
    is_a_slower = frame.spin_a->speed() <= frame.spin_b->speed();
    relative = frame.relative;
    absolute = frame.absolute;
    box_error = pair.a().box_error() + pair.b().box_error();
    skew = std::max(pair.a().skew(), pair.b().skew());
}

BoxBound bound_boxes(const IntervalFrame& frame, const Obb& a, const Obb& b) {
    const bool from_a = frame.is_a_slower;
    const RelativeMotion& motion = from_a ? frame.from_a : frame.from_b;
    const Obb &x = from_a ? a : b, &y = from_a ? b : a;
    BoxPair pair(frame, motion, x, y);
    const Vec3 near = near_direction(x, y, motion.between() + y.center);
    const double length = norm(near);
    if (length > 0x1p-300) {
        pair.try_axis((1 / length) * near);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        pair.try_axis(x.axes[k]);
        pair.try_axis(y.axes[k]);
    }
    BoxBound bound = pair.bound();
    const double shrink = 1 - 2 * frame.skew; // axes of boxes may be longer than 1
    bound.low *= shrink;
    bound.gap *= shrink;
    return bound;
}

// Fixed in the body that a face belongs to its normal stays across the face; the direction of the
// nearest points is fixed in either. The moving product of two edges stays across both.
double bound_triangles(const IntervalFrame& frame, const PlacedTriangles& placed,
                       const TriangleDistance& near) {
    const Triangle &a = placed.a.points, &b = placed.b.points;
    const TrianglePair seen_from_a(frame, frame.from_a, a, b),
        seen_from_b(frame, frame.from_b, b, a);
    const Vec3 way = near.point_b - near.point_a;
    double low = std::max({seen_from_a.along(way), seen_from_b.along(way),
                           seen_from_a.along(normal_of(a)), seen_from_b.along(normal_of(b))});
    if (near.features.kind == NearFeatures::Kind::kEdges) {
        const std::size_t i = near.features.part_a, j = near.features.part_b;
        const Vec3 edge_a = a[(i + 1) % 3] - a[i], edge_b = b[(j + 1) % 3] - b[j];
        low = std::max(low, seen_from_a.along(cross(edge_a, edge_b)));
        const bool from_a = frame.is_a_slower;
        low =
            std::max(low, from_a ? bound_edges(frame.from_a, frame.half, {a, edge_a}, {b, edge_b})
                                 : bound_edges(frame.from_b, frame.half, {b, edge_b}, {a, edge_a}));
    }
    // A unit vector computed here is one up to 4 units of roundoff.
    const double sizes = placed.a.size + placed.b.size;
    const double error = kTerms * (frame.relative * sizes + frame.absolute);
    return std::max(0.0, (1 - 0x1p-48) * low - error);
}

} // namespace obb
