#include "primitives/moving_lanes.hpp"

#include "numbers/registers.hpp"

#include <limits>

namespace obb {

namespace {

// As in sat_triangle_triangle.hpp, whose bounds these are.
constexpr double kError = 16 * kUnitRoundoff;
constexpr double kForever = std::numeric_limits<double>::infinity();

template <typename Reals>
using Point = std::array<Reals, 3>;

template <typename Reals>
OBB_INLINE Point<Reals> less(const Point<Reals>& a, const Point<Reals>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <typename Reals>
OBB_INLINE Reals product(const Point<Reals>& a, const Point<Reals>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <typename Reals>
OBB_INLINE Point<Reals> across(const Point<Reals>& a, const Point<Reals>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <typename Reals>
OBB_INLINE Reals size_of(const Point<Reals>& a) {
    return magnitude(a[0]) + magnitude(a[1]) + magnitude(a[2]);
}
template <typename Reals>
OBB_INLINE Reals lowest(const Reals& a, const Reals& b, const Reals& c) {
    return lower(lower(a, b), c);
}
template <typename Reals>
OBB_INLINE Reals highest(const Reals& a, const Reals& b, const Reals& c) {
    return upper(upper(a, b), c);
}

template <typename Reals>
OBB_INLINE LaneTriangles<Reals> gathered(const std::array<const Triangle*, 4>& from) {
    LaneTriangles<Reals> t;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const Vec3& p = (*from[lane])[i];
            t[i][0].set(lane, p.x);
            t[i][1].set(lane, p.y);
            t[i][2].set(lane, p.z);
        }
    }
    return t;
}

// What narrows the times axis by axis, as MovingSat does.
template <typename Reals>
class LaneSat {
  public:
    OBB_INLINE LaneSat(const ClosingMotion& motion, const FourTimes& times)
        : duration_(motion.duration), entry_low_(Reals::at(times.entry_low.data())),
          entry_high_(Reals::at(times.entry_high.data())),
          exit_low_(Reals::at(times.exit_low.data())),
          exit_high_(Reals::at(times.exit_high.data())) {}

    // axis_times().
    OBB_INLINE void add(const Reals& low, const Reals& high, const Reals& speed,
                        const Reals& error) {
        const Reals size = magnitude(speed);
        const auto is_still = size <= Reals(kUnderflow);
        const auto is_ahead = speed > Reals(0.0);
        const Reals pace = Reals(1.0) / size;
        const Reals entry = select(is_ahead, low, Reals(0.0) - high) * pace;
        const Reals exit = select(is_ahead, high, Reals(0.0) - low) * pace;
        const Reals slack = Reals(1.5) * error * pace + Reals(8 * kUnitRoundoff) * duration_;
        Reals entry_low = entry - slack, entry_high = entry + slack;
        Reals exit_low = exit - slack, exit_high = exit + slack;
        if (is_still.is_any()) {
            const Reals reach = error + duration_ * size;
            const Reals never(kForever), ever(-kForever);
            const auto is_apart = (low > reach) | (high < Reals(0.0) - reach);
            const auto is_within = (low < Reals(0.0) - reach) & (high > reach);
            entry_low = select(is_still, select(is_apart, never, ever), entry_low);
            exit_high = select(is_still, select(is_apart, ever, never), exit_high);
            entry_high = select(is_still, select(is_within, ever, never), entry_high);
            exit_low = select(is_still, select(is_within, never, ever), exit_low);
        }
        keep(entry_low, entry_high, exit_low, exit_high);
    }
    // The same, but for pairs of which the axis says nothing.
    OBB_INLINE void add_but(const typename Reals::Mask& is_left_out, const Reals& low,
                            const Reals& high, const Reals& speed, const Reals& error) {
        const LaneSat before = *this;
        add(low, high, speed, error);
        entry_low_ = select(is_left_out, before.entry_low_, entry_low_);
        entry_high_ = select(is_left_out, before.entry_high_, entry_high_);
        exit_low_ = select(is_left_out, before.exit_low_, exit_low_);
        exit_high_ = select(is_left_out, before.exit_high_, exit_high_);
    }

    OBB_INLINE void store(FourTimes& times) const {
        entry_low_.store(times.entry_low.data());
        entry_high_.store(times.entry_high.data());
        exit_low_.store(times.exit_low.data());
        exit_high_.store(times.exit_high.data());
    }

  private:
    OBB_INLINE void keep(const Reals& entry_low, const Reals& entry_high, const Reals& exit_low,
                         const Reals& exit_high) {
        entry_low_ = upper(entry_low, entry_low_);
        entry_high_ = upper(entry_high, entry_high_);
        exit_low_ = lower(exit_low, exit_low_);
        exit_high_ = lower(exit_high, exit_high_);
    }

    Reals duration_, entry_low_, entry_high_, exit_low_, exit_high_;
};

// What all axes need. Legend as in sat_triangle_triangle.hpp.
template <typename Reals>
struct LanePair {
    LaneTriangles<Reals> a, b;
    Point<Reals> w;
    std::array<Point<Reals>, 3> e, f;
    std::array<Reals, 3> e_size, f_size;
    Point<Reals> n, m;
    Reals unit;

    static OBB_INLINE LanePair of(const FourPairs& pairs, const ClosingMotion& motion) {
        LanePair p;
        p.a = gathered<Reals>(pairs.a);
        p.b = gathered<Reals>(pairs.b);
        p.w = {Reals(motion.velocity.x), Reals(motion.velocity.y), Reals(motion.velocity.z)};
        for (std::size_t k = 0; k < 3; ++k) {
            p.e[k] = less(p.a[(k + 1) % 3], p.a[k]);
            p.f[k] = less(p.b[(k + 1) % 3], p.b[k]);
            p.e_size[k] = size_of(p.e[k]);
            p.f_size[k] = size_of(p.f[k]);
        }
        const Reals reach = size_of(less(p.b[0], p.a[0])) +
                            highest(p.e_size[0], p.e_size[1], p.e_size[2]) +
                            highest(p.f_size[0], p.f_size[1], p.f_size[2]);
        p.unit = Reals(kError) * (reach + Reals(motion.duration * norm_1(motion.velocity)));
        p.n = across(p.e[0], p.e[1]);
        p.m = across(p.f[0], p.f[1]);
        return p;
    }
};

template <std::size_t kBytes>
OBB_INLINE void by_faces(const FourPairs& pairs, const ClosingMotion& motion, FourTimes& times) {
    using Reals = Doubles<kBytes>;
    const auto p = LanePair<Reals>::of(pairs, motion);
    LaneSat<Reals> sat(motion, times);
    const Point<Reals> d = less(p.b[0], p.a[0]);
    const Reals none(0.0), underflow(kUnderflow);
    {
        const Reals q = product(p.n, d);
        const Reals q1 = q + product(p.n, p.f[0]), q2 = q - product(p.n, p.f[2]);
        const Reals error = Reals(3.0) * p.unit * (p.e_size[0] * p.e_size[1]) + underflow;
        sat.add(none - highest(q, q1, q2), none - lowest(q, q1, q2), product(p.n, p.w), error);
    }
    const Reals q = product(p.m, d);
    const Reals m0 = product(p.m, p.e[0]), m2 = none - product(p.m, p.e[2]);
    const Reals error = Reals(3.0) * p.unit * (p.f_size[0] * p.f_size[1]) + underflow;
    sat.add(lowest(none, m0, m2) - q, highest(none, m0, m2) - q, product(p.m, p.w), error);
    sat.store(times);
}

// is_surely_parallel(), of products that are zero.
template <typename Reals>
OBB_INLINE typename Reals::Mask are_parallel(const Point<Reals>& axis, const Point<Reals>& u,
                                             const Point<Reals>& v) {
    const Reals none(0.0);
    const auto is_zero = [&](const Reals& x) { return (x <= none) & (x >= none); };
    const auto vanish = [&](const Reals& x, const Reals& y) { return is_zero(x) | is_zero(y); };
    const auto is_null = is_zero(axis[0]) & is_zero(axis[1]) & is_zero(axis[2]);
    if (!is_null.is_any()) {
        return is_null;
    }
    return is_null & vanish(u[0], v[1]) & vanish(u[1], v[0]) & vanish(u[1], v[2]) &
           vanish(u[2], v[1]) & vanish(u[2], v[0]) & vanish(u[0], v[2]);
}

template <std::size_t kBytes>
OBB_INLINE void by_edges(const FourPairs& pairs, const ClosingMotion& motion, FourTimes& times) {
    using Reals = Doubles<kBytes>;
    const auto p = LanePair<Reals>::of(pairs, motion);
    LaneSat<Reals> sat(motion, times);
    const Reals none(0.0);
    const Reals n_size = Reals(kError) * (p.e_size[0] * p.e_size[1]);
    const Reals m_size = Reals(kError) * (p.f_size[0] * p.f_size[1]);
    std::array<Reals, 3> nf, me;
    for (std::size_t k = 0; k < 3; ++k) {
        nf[k] = none - product(p.n, p.f[k]);
        me[k] = product(p.m, p.e[k]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const Point<Reals> axis = across(p.e[i], p.f[j]);
            const Reals q = product(axis, less(p.b[j], p.a[i]));
            const Reals high_a = upper(none, nf[j]), low_a = lower(none, nf[j]);
            const Reals high_b = q + upper(none, me[i]), low_b = q + lower(none, me[i]);
            const Reals error = p.f_size[j] * (p.e_size[i] * p.unit + n_size) +
                                p.e_size[i] * m_size + Reals(kUnderflow);
            sat.add_but(are_parallel(axis, p.e[i], p.f[j]), low_a - high_b, high_a - low_b,
                        product(axis, p.w), error);
        }
    }
    sat.store(times);
}

} // namespace

void narrow_by_faces(const FourPairs& pairs, const ClosingMotion& motion, FourTimes& times) {
    in_registers([&]<std::size_t kBytes>() { by_faces<kBytes>(pairs, motion, times); });
}

void narrow_by_edges(const FourPairs& pairs, const ClosingMotion& motion, FourTimes& times) {
    in_registers([&]<std::size_t kBytes>() { by_edges<kBytes>(pairs, motion, times); });
}

} // namespace obb
