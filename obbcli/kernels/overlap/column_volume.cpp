#include "overlap/column_volume.hpp"

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obb {

ColumnVolume::ColumnVolume(const TreeView& a, const Pose& pose_a, const TreeView& b,
                           const Pose& pose_b)
    : exponent_(std::max(ColumnBody::exponent_for(a, pose_a), ColumnBody::exponent_for(b, pose_b))),
      a_(a, pose_a, exponent_), b_(b, pose_b, exponent_), window_(common(a_.extent(), b_.extent())),
      frame_(frame_of(a_, b_, window_)), pairs_(a_, b_, frame_), sums_(frame_) {}

bool ColumnVolume::advance(std::uint64_t max_pops) {
    is_complete_ = pairs_.advance(max_pops, [&](const Shadow& a, const Shadow& b, bool) {
        sums_.add(term_of(a, b, frame_.window));
    });
    return is_complete_;
}

Bracket ColumnVolume::bounds() const {
    if (frame_.is_empty) {
        return {0, 0};
    }
    const Vec3 sizes = window_.high - window_.low;
    const double most = sizes.x * sizes.y * sizes.z * (1 + 8 * kUnitRoundoff);
    Bracket found{0, most};
    if (is_complete_) {
        found = magnitude(sums_.volume());
    }
    found = scaled_outwards(found, 3 * exponent_);
    return {std::max(found.low, 0.0), found.high};
}

Bracket ColumnVolume::integral() const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (frame_.is_empty) {
        return {0, 0};
    }
    return is_complete_ ? scaled_outwards(sums_.volume(), 3 * exponent_)
                        : Bracket{-kInfinity, kInfinity};
}

std::optional<ColumnVolume::Centroid> ColumnVolume::centroid() const {
    const ColumnSums::Centroid found = sums_.centroid();
    if (!is_complete_ || frame_.is_empty || !found.is_known) {
        return std::nullopt;
    }
    return Centroid{scaled(found.point, exponent_), std::ldexp(found.error, exponent_)};
}

Bounds ColumnVolume::window() const {
    return {scaled(window_.low, exponent_), scaled(window_.high, exponent_)};
}

} // namespace obb
