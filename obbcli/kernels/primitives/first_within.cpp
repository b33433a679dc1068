#include "primitives/first_within.hpp"

#include "primitives/exact_approach.hpp"

#include <algorithm>

namespace obb {
namespace {

[[nodiscard]] bool is_still(const LinearMotion& m) {
    return m.duration == 0 || m.velocity_a == m.velocity_b;
}

template <std::size_t N>
[[nodiscard]] std::array<WideVec<N>, 3> wide_corners(const Triangle& t, const Vec3& origin,
                                                     int unit) {
    const WideVec<N> from = to_wide<N>(origin, unit);
    return {to_wide<N>(t[0], unit) - from, to_wide<N>(t[1], unit) - from,
            to_wide<N>(t[2], unit) - from};
}

// Calls `solve` with the question in integers of the narrowest width that holds it.
template <typename Solve>
auto with_exact_input(const Triangle& a, const Triangle& b, const LinearMotion& m, double clearance,
                      Solve&& solve) {
    DigitRange lengths, speeds;
    for (const Triangle* t : {&a, &b}) {
        for (const Vec3& p : *t) {
            lengths.include(p);
        }
    }
    lengths.include(to_dyadic(clearance));
    const bool moves = !is_still(m);
    if (moves) {
        speeds.include(m.velocity_a);
        speeds.include(m.velocity_b);
    }
    const double duration = moves ? m.duration : 0;
    const int time_exponent = moves ? lengths.low - speeds.low : 0;
    // A time has four times the limbs, so that the duration always fits.
    const int shift = std::abs(to_dyadic(duration).exponent - time_exponent);
    const int bits = std::max({lengths.bits(), speeds.bits(), moves ? shift / 4 + 16 : 0});
    return with_width(bits, [&](auto width) {
        constexpr std::size_t kWidth = decltype(width)::value;
        ExactApproachInput<kWidth> input;
        input.a = wide_corners<kWidth>(a, a[0], lengths.low);
        input.b = wide_corners<kWidth>(b, a[0], lengths.low);
        input.clearance = to_wide<kWidth>(clearance, lengths.low);
        input.duration = rational_time<kWidth>(duration, time_exponent).value();
        input.time_exponent = time_exponent;
        if (moves) {
            input.velocity = to_wide<kWidth>(m.velocity_b, speeds.low) -
                             to_wide<kWidth>(m.velocity_a, speeds.low);
        }
        return solve(input);
    });
}

} // namespace

std::optional<Approach> first_within(const Triangle& a, const Triangle& b,
                                     const LinearMotion& motion, double clearance) {
    return with_exact_input(a, b, motion, clearance, [](const auto& input) {
        std::optional<Approach> first;
        ExactApproach(input).visit_starts(
            [&](const ApproachStart& start, AxisId axis, std::uint8_t i, std::uint8_t j) {
                if (!first) {
                    first = Approach{start.below, start.above, start.is_within, {}};
                }
                first->is_within =
                    start.above < first->time_above
                        ? start.is_within
                        : first->is_within || (start.above == first->time_above && start.is_within);
                first->time_below = std::min(first->time_below, start.below);
                first->time_above = std::min(first->time_above, start.above);
                const bool is_axis = start.by_gap && axis.kind != AxisKind::kNone;
                if (is_axis && start.below <= first->time_below) {
                    first->touch.axis = axis;
                    first->touch.feature_a.points = static_cast<std::uint8_t>(1U << i);
                    first->touch.feature_b.points = static_cast<std::uint8_t>(1U << j);
                }
            });
        return first;
    });
}

} // namespace obb
