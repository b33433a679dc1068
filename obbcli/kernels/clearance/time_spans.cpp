#include "clearance/time_spans.hpp"

#include <algorithm>

namespace obb {

std::vector<TimeSpan> TimeSpans::below(double limit) const {
    std::vector<TimeSpan> kept;
    for (const Keyed& keyed : spans_) {
        if (keyed.key <= limit) {
            kept.push_back(keyed.span);
        }
    }
    std::sort(kept.begin(), kept.end(),
              [](const TimeSpan& x, const TimeSpan& y) { return x.low < y.low; });
    std::vector<TimeSpan> joined;
    for (const TimeSpan& span : kept) {
        if (!joined.empty() && span.low <= joined.back().high) {
            joined.back().high = std::max(joined.back().high, span.high);
        } else {
            joined.push_back(span);
        }
    }
    return joined;
}

// Spans of equal keys are joined where they overlap, so that many pairs that stay near at the same
// time do not add up: a key is taken down to that of its neighbour.
void TimeSpans::thin_out(double limit) {
    std::erase_if(spans_, [&](const Keyed& keyed) { return keyed.key > limit; });
    std::sort(spans_.begin(), spans_.end(),
              [](const Keyed& x, const Keyed& y) { return x.span.low < y.span.low; });
    std::vector<Keyed> joined;
    for (const Keyed& keyed : spans_) {
        if (!joined.empty() && keyed.span.high <= joined.back().span.high) {
            joined.back().key = std::min(joined.back().key, keyed.key);
        } else {
            joined.push_back(keyed);
        }
    }
    spans_ = std::move(joined);
    most_ = std::max<std::size_t>(4096, 2 * spans_.size());
    is_due_ = false;
}

} // namespace obb
