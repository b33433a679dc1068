#include "overlap/self_overlap.hpp"

#include "numbers/scale.hpp"
#include "overlap/shadow_term.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obb {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Columns through a box, or through all of the body, up to its top.
[[nodiscard]] ColumnFrame frame_within(const ColumnBody& body, const std::optional<Bounds>& within,
                                       int exponent) {
    const Bounds extent = body.extent();
    if (!within) {
        return frame_of(body, body, extent);
    }
    const Bounds box{scaled(within->low, -exponent), scaled(within->high, -exponent)};
    ColumnFrame frame = frame_of(body, body, common(extent, box));
    frame.window.height = extent.high[frame.axis] - frame.window.floor;
    return frame;
}

[[nodiscard]] double size_of(const ColumnWindow& w) {
    return (w.high[0] - w.low[0]) * (w.high[1] - w.low[1]) * w.height;
}

} // namespace

SelfOverlap::SelfOverlap(const TreeView& tree, const Pose& pose,
                         const std::optional<Bounds>& within)
    : exponent_(ColumnBody::exponent_for(tree, pose)), body_(tree, pose, exponent_),
      frame_(frame_within(body_, within, exponent_)), pairs_(body_, body_, frame_),
      volume_(size_of(frame_.window)), square_(size_of(frame_.window)) {}

bool SelfOverlap::advance(std::uint64_t max_pops) {
    is_complete_ = pairs_.advance(max_pops, [&](const Shadow& a, const Shadow& b, bool is_same) {
        const ShadowTerm term = term_of(a, b, frame_.window);
        if (term.error == 0) { // and so is the term
            return;
        }
        square_.add(term.volume, term.error, is_same ? 1 : 2);
        if (is_same) { // the column under one triangle, without its sign
            volume_.add(term.volume, term.error, a.sign);
        }
    });
    return is_complete_;
}

Bracket SelfOverlap::volume() const {
    if (frame_.is_empty) {
        return {0, 0};
    }
    return is_complete_ ? scaled_outwards(volume_.bracket(), 3 * exponent_)
                        : Bracket{-kInfinity, kInfinity};
}

Bracket SelfOverlap::excess() const {
    if (frame_.is_empty) {
        return {0, 0};
    }
    if (!is_complete_) {
        return {0, kInfinity};
    }
    const Bracket square = square_.bracket(), volume = magnitude(volume_.bracket());
    const Bracket found =
        scaled_outwards({square.low - volume.high, square.high - volume.low}, 3 * exponent_);
    return {std::max(found.low, 0.0), found.high};
}

} // namespace obb
