// What a contact query does where the bodies move on a common screw: images of their triangles, in
// coordinates that the screw leaves alone, tell which may meet and when, and these alone are
// advanced.
#include "in_motion/contact_query.hpp"

#include <algorithm>
#include <limits>

namespace obb {

// Where boxes stand for triangles, images of triangles say nothing of them.
bool ContactQuery::is_screw_due() const {
    return counts_.box_tests >= screw_due_ && !pair_.is_translation() && !has_limits();
}

void ContactQuery::ask_screw() {
    screw_due_ = std::numeric_limits<std::uint64_t>::max();
    const double near = std::max({pair_.clearance(), distance_tolerance_, 0.0});
    if (const auto screw = common_screw(pair_, near)) {
        screw_ = std::make_unique<ScrewSearch>(*screw);
    }
}

// Once the images are made, they answer for all pairs of triangles from the time on before which
// the bodies are proven apart: what waited is dropped. A contact that is proven stays so.
bool ContactQuery::make_images(SliceClock& clock) {
    if (!screw_->make(pair_, lower_bound_, clock)) {
        return false;
    }
    if (screw_->has_failed()) { // then steps go on as if nobody had asked
        screw_.reset();
        return true;
    }
    queue_.clear();
    windows_ = {};
    stalled_ = StalledPairs(time_tolerance_);
    return true;
}

// When a pair that is apart before a time may first meet; nothing where it does not any more.
std::optional<double> ContactQuery::in_window(const Entry& entry, double time) const {
    if (!entry.images.is_there()) {
        return time;
    }
    const double meeting = screw_->meeting_time(entry.images, time);
    return std::isinf(meeting) ? std::nullopt : std::optional(meeting);
}

// Two triangles that images hand over are advanced like any others, but within their windows.
void ContactQuery::advance_images() {
    const std::uint64_t before = screw_->tests();
    const double last = proof_ ? proof_->time : pair_.duration();
    if (const auto met = screw_->advance(last)) {
        Entry entry{met->time, pair_.duration(), met->refs.a, met->refs.b};
        entry.images = met->images;
        push(entry);
    }
    counts_.image_tests += screw_->tests() - before;
}

} // namespace obb
