#include "distance/triangle_blocks.hpp"

#include "numbers/lane_moves.hpp"
#include "numbers/lane_vectors.hpp"

#include <bit>
#include <cstdint>
#include <limits>

namespace obb {

namespace {

// What a gap between projections may be off by. Let u = 2^-24, and rho the sum of the reaches of
// the two blocks, in which no coordinate from the block's origin is larger, and of the largest
// coordinate of the way W between the origins. Coordinates and those of W round by u.
// - Along an axis: three numbers that round by u, and two sums by u of at most rho: 3 u rho; all
//   axes together, as a vector, sqrt(3) of it. Squares, sums and root by 4 u of at most
//   sqrt(3) rho. Together 12.2 u rho.
// - Along a normal n of length about 1, whatever its direction: a product with a corner or with W
//   rounds by 3 u and the corner by u, of at most sqrt(3) times its largest coordinate: 6.93 u rho
//   for all three. Two sums by u of at most sqrt(3) rho, 3.5 u rho. The length of n is off by 5 u,
//   and so is the gap, 8.7 u rho. Together 19.2 u rho.
// The bound is 24 u rho; what is left covers its own rounding, that of rho and products of errors.
//
// Products that underflow lose 2^-150 each, and coordinates may: a few dozen stay below 2^-120. A
// gap along an axis below 2^-60 is taken for none, so that squares have all digits. A normal whose
// square is below 2^-100, of corners scaled to at most 1, is none.
constexpr float kMargin = 24 * 0x1p-24F;
constexpr float kUnderflow = 0x1p-120F;
constexpr float kLeastGap = 0x1p-60F;
constexpr float kLeastSquare = 0x1p-100F;

// The lanes of a block.
using Ones = Lanes<float, 4, 16>;
using Wides = Lanes<double, 4, 16>;

template <typename Real>
OBB_INLINE Real lowest(const Real& a, const Real& b, const Real& c) {
    return lower(lower(a, b), c);
}
template <typename Real>
OBB_INLINE Real highest(const Real& a, const Real& b, const Real& c) {
    return upper(upper(a, b), c);
}

OBB_INLINE Ones rounded_lanes(const Wides& from) {
    return Ones::at(std::array<float, 4>{static_cast<float>(from[0]), static_cast<float>(from[1]),
                                         static_cast<float>(from[2]), static_cast<float>(from[3])}
                        .data());
}
OBB_INLINE void store(const Ones& lanes, TriangleBlock::Row& row) {
    lanes.store(row.data());
    shuffled<2, 3, 0, 1>(lanes).store(row.data() + 4);
}

// The power of two at most a number that is not negative; 0 of subnormal ones.
[[nodiscard]] double power_below(double number) {
    constexpr std::uint64_t kExponent = 0x7ff0000000000000;
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(number) & kExponent);
}

// Of corners whose coordinates are at most so large.
OBB_INLINE Lanes3<Ones> normal_of(const LaneTriangles<Wides>& t, double farthest) {
    const double unit = 2 * power_below(farthest);
    const Wides scale(unit > 0 ? 1 / unit : 0);
    LaneTriangles<Ones> corners;
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) {
            corners[k][i] = rounded_lanes(scale * t[k][i]);
        }
    }
    const Lanes3<Ones> n =
        outer(difference(corners[1], corners[0]), difference(corners[2], corners[0]));
    const Ones square = inner(n, n);
    const auto is_known = square > Ones(kLeastSquare);
    const Ones factor =
        select(is_known, Ones(1.0F) / root_of(select(is_known, square, Ones(1.0F))), Ones{});
    return {factor * n[0], factor * n[1], factor * n[2]};
}

// A block in lanes of eight: of A its triangles twice, of B also as their rows have them.
template <typename Real>
struct Facts {
    LaneTriangles<Real> corners;
    Lanes3<Real> normal, low_corner, high_corner;
    Real low_along, high_along;
};
template <typename Real, typename Load>
OBB_INLINE Facts<Real> facts_of(const TriangleBlock& block, const Load& load) {
    const auto three = [&](const std::array<TriangleBlock::Row, 3>& rows)
                           __attribute__((always_inline)) {
                               return Lanes3<Real>{load(rows[0]), load(rows[1]), load(rows[2])};
                           };
    return {{three(block.rounded[0]), three(block.rounded[1]), three(block.rounded[2])},
            three(block.normal),
            three(block.low_corner),
            three(block.high_corner),
            load(block.low_along),
            load(block.high_along)};
}

// Each triangle's neighbour in its pair.
template <typename Real>
OBB_INLINE Real neighbours(const Real& lanes) {
    return shuffled<1, 0, 3, 2>(lanes);
}
template <typename Real>
OBB_INLINE Lanes3<Real> neighbours(const Lanes3<Real>& v) {
    return {neighbours(v[0]), neighbours(v[1]), neighbours(v[2])};
}
template <typename Real>
OBB_INLINE Facts<Real> neighbours(const Facts<Real>& f) {
    return {{neighbours(f.corners[0]), neighbours(f.corners[1]), neighbours(f.corners[2])},
            neighbours(f.normal),
            neighbours(f.low_corner),
            neighbours(f.high_corner),
            neighbours(f.low_along),
            neighbours(f.high_along)};
}

// Of B at a way from A.
template <typename Real>
OBB_INLINE Real gap_between(const Facts<Real>& a, const Facts<Real>& b, const Lanes3<Real>& way,
                            const Real& margin) {
    Real square{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Real gap = upper((b.low_corner[i] - a.high_corner[i]) + way[i],
                               (a.low_corner[i] - b.high_corner[i]) - way[i]);
        const Real counted = select(gap > Real(kLeastGap), gap, Real{});
        square += counted * counted;
    }
    const auto along = [&](const Facts<Real>& own,
                           const Facts<Real>& other) __attribute__((always_inline)) {
        const Real k0 = inner(own.normal, other.corners[0]);
        const Real k1 = inner(own.normal, other.corners[1]);
        const Real k2 = inner(own.normal, other.corners[2]);
        const Real away = inner(own.normal, way);
        const bool is_a = &own == &a;
        const Real above = lowest(k0, k1, k2) - own.high_along;
        const Real below = own.low_along - highest(k0, k1, k2);
        return is_a ? upper(above + away, below - away) : upper(above - away, below + away);
    };
    return upper(upper(along(a, b), along(b, a)), root_of(square)) - margin;
}

template <std::size_t kBytes>
OBB_INLINE void measure(const TriangleBlock& a, const TriangleBlock& b, float limit,
                        BlockGaps& gaps) {
    using Real = Floats<kBytes>;
    const Vec3 between = b.origin - a.origin;
    const auto x = static_cast<float>(between.x), y = static_cast<float>(between.y),
               z = static_cast<float>(between.z);
    const auto rho = a.reach + b.reach + static_cast<float>(norm_inf(between));
    const Lanes3<Real> way{Real(x), Real(y), Real(z)};
    const Real margin(kMargin * rho + kUnderflow);
    const auto of_a =
        facts_of<Real>(a, [](const TriangleBlock::Row& row) __attribute__((always_inline)) {
            return loaded<float, 8, kBytes>(
                [&](std::size_t) __attribute__((always_inline)) { return row.data(); });
        });
    const auto of_b =
        facts_of<Real>(b, [](const TriangleBlock::Row& row)
                              __attribute__((always_inline)) { return Real::at(row.data()); });
    const Real first = gap_between<Real>(of_a, of_b, way, margin);
    const Real second = gap_between<Real>(of_a, neighbours(of_b), way, margin);
    first.store(gaps.lows.data());
    second.store(gaps.lows.data() + 8);
    const auto beyond_first = first > Real(limit), beyond_second = second > Real(limit);
    gaps.margin = kMargin * rho + kUnderflow;
    gaps.open = ~(bits_of<Real>(beyond_first) | bits_of<Real>(beyond_second) << 8U) & 0xffffU;
    const Real none(std::numeric_limits<float>::infinity());
    gaps.least_of_others =
        lowest_of(lower(select(beyond_first, first, none), select(beyond_second, second, none)));
}

} // namespace

void TriangleBlock::describe(const ScaleFactors& factors) {
    const Wides first(factors[0]), second(factors[1]);
    LaneTriangles<Wides> t;
    origin = factors[1] * (factors[0] * lane(corners, 0)[0]);
    Wides far{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Wides start(origin[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            t[k][i] = second * (first * Wides::at(corners[k][i].data())) - start;
            far = upper(magnitude(t[k][i]), far);
        }
    }
    const double farthest = highest_of(far);
    reach = static_cast<float>(farthest * (1 + 0x1p-22));
    const Lanes3<Ones> n = normal_of(t, farthest);
    LaneTriangles<Ones> own;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            own[k][i] = rounded_lanes(t[k][i]);
            store(own[k][i], rounded[k][i]);
        }
        store(n[i], normal[i]);
        store(lowest(own[0][i], own[1][i], own[2][i]), low_corner[i]);
        store(highest(own[0][i], own[1][i], own[2][i]), high_corner[i]);
    }
    const Ones k0 = inner(n, own[0]), k1 = inner(n, own[1]), k2 = inner(n, own[2]);
    store(lowest(k0, k1, k2), low_along);
    store(highest(k0, k1, k2), high_along);
}

const TriangleBlock& TriangleBlocks::placed(const PosedTree& body, const NodeRef& ref,
                                            const ScaleFactors& factors) {
    TriangleBlock& block = blocks_[ref.begin / 2 % blocks_.size()];
    if (block.count != ref.triangle_count() || block.begin != ref.begin) {
        block.count = 0; // until it is done, which a damaged tree may prevent
        body.tree().prepare_triangles(ref, ref.triangle_count());
        body.place_triangles(ref.begin, ref.triangle_count(), block.corners);
        block.describe(factors);
        block.begin = ref.begin;
        block.count = ref.triangle_count();
    }
    return block;
}

void measure_block(const TriangleBlock& a, const TriangleBlock& b, float limit, BlockGaps& gaps) {
    in_registers([&]<std::size_t kBytes>() { measure<kBytes>(a, b, limit, gaps); });
}

} // namespace obb
