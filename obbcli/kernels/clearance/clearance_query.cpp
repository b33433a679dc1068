#include "clearance/clearance_query.hpp"

#include "work/slice.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

// A search that takes more pops than this does pairs of so few triangles depth-first, or its queue
// would grow with the duration times the facets that pass each other.
constexpr std::uint64_t kPatience = 512;
constexpr std::uint32_t kSmall = 64;
// Time is halved rather than a box opened where boxes move by more than this many of their sizes.
constexpr double kFar = 2;
// A bar is no closer to the distance found than this many errors of a place: closer bounds cannot
// be had.
constexpr double kErrors = 16;
constexpr std::uint64_t kPopsADive = 2048;

} // namespace

ClearanceQuery::ClearanceQuery(const TreeView& a, const Pose& pose_a, const Screw& screw_a,
                               const TreeView& b, const Pose& pose_b, const Screw& screw_b,
                               const ClearanceOptions& options)
    : pair_(a, pose_a, screw_a, b, pose_b, screw_b, options.until, 0),
      slack_(pair_.scaled_length(options.slack)), given_high_(pair_.scaled_length(options.high)),
      share_(1 - options.tolerance) {
    whole_ = {pair_.scaled_time(options.from), pair_.scaled_time(options.until)};
    if (options.at_least) {
        at_least_ = pair_.scaled_length(*options.at_least);
    }
    const MovingFrame frame = pair_.frame(slack_, 0);
    const double sizes = pair_.scaled_length(pair_.a().farthest() + pair_.b().farthest());
    floor_ = kErrors * (frame.relative * sizes + frame.absolute);
    const IntervalFrame start(pair_, 0, 0, slack_);
    const bool is_still = start.from_a.speed({1, 2, 3}, 4) == 0;
    turning_ = is_still ? 0 : pair_.a().spin().speed() + pair_.b().spin().speed();
    for (const double time : {whole_.low, 0.5 * whole_.low + 0.5 * whole_.high, whole_.high}) {
        if (!is_contact_) {
            dive(time);
        }
    }
    if (!is_contact_) {
        const Item root{0, 0, 0, whole_, a.root(), b.root(), 0};
        const bool is_pair = root.a.is_triangle() && root.b.is_triangle();
        if (is_pair && !(0.5 * turning_ * (whole_.high - whole_.low) > kLongestTurn)) {
            open(root);
        } else {
            add(root);
        }
    }
}

// The nearest triangles of one moment, or nearly so: what is known of them keeps most of the rest
// from the queue.
void ClearanceQuery::dive(double time) {
    Queue queue;
    diving_ = &queue;
    add({0, 0, 0, {time, time}, pair_.a().tree().root(), pair_.b().tree().root(), 0});
    for (std::uint64_t k = 0; k < kPopsADive && !queue.is_empty(); ++k) {
        if (queue.next_time() >= known_high()) {
            break;
        }
        open(queue.pop());
        if (is_contact_) {
            break;
        }
    }
    diving_ = nullptr;
}

double ClearanceQuery::bar() const {
    const double high = known_high();
    const double wanted = std::min(share_ * high, high - floor_);
    return at_least_ ? std::min(wanted, *at_least_) : wanted;
}

bool ClearanceQuery::is_answered() const {
    return is_contact_ || (at_least_ && high_ < *at_least_);
}

bool ClearanceQuery::advance(std::uint64_t max_pops) {
    SliceClock clock;
    for (;;) {
        while (!stack_.empty() && is_settled(stack_.back().key)) {
            settle(stack_.back());
            stack_.pop_back();
        }
        while (!queue_.is_empty() && is_settled(queue_.next_time())) {
            settle(queue_.pop());
        }
        if (is_answered() || (stack_.empty() && queue_.is_empty())) {
            return true;
        }
        if (max_pops == 0 || clock.is_over()) {
            return false;
        }
        --max_pops;
        ++counts_.pops;
        if (stack_.empty()) {
            visit(queue_.pop());
        } else {
            const Item item = stack_.back();
            stack_.pop_back();
            visit(item);
        }
    }
}

void ClearanceQuery::visit(const Item& item) {
    if (halves(item)) {
        halve(item);
    } else {
        open(item);
    }
}

// Time alone is to blame where boxes are apart by the bar at the middle already.
bool ClearanceQuery::halves(const Item& item) const {
    if (item.next > 0) {
        return false;
    }
    if (item.a.is_triangle() && item.b.is_triangle()) {
        return true;
    }
    const double length = item.span.high - item.span.low;
    if (0.5 * turning_ * length > kLongestTurn) {
        return true;
    }
    const double size =
        std::max(MovingPair::size_of(pair_.a(), item.a), MovingPair::size_of(pair_.b(), item.b));
    return length > 0 && (item.gap >= bar() || item.travel > kFar * size);
}

IntervalFrame ClearanceQuery::frame_of(const TimeSpan& span) {
    const double middle = 0.5 * span.low + 0.5 * span.high;
    pair_.set_time(middle);
    const double half = std::max(span.high - middle, middle - span.low);
    return {pair_, middle, (1 + 0x1p-50) * half, slack_};
}

// Intervals that doubles cannot halve any more are left as they are.
void ClearanceQuery::halve(const Item& item) {
    const double middle = 0.5 * item.span.low + 0.5 * item.span.high;
    if (!(item.span.low < middle && middle < item.span.high)) {
        settle(item);
        return;
    }
    for (const bool is_first : {true, false}) {
        Item half = item;
        half.span = is_first ? TimeSpan{item.span.low, middle} : TimeSpan{middle, item.span.high};
        const double turn = 0.5 * turning_ * (half.span.high - half.span.low);
        if (turn > kLongestTurn) {
            add(half);
            continue;
        }
        const IntervalFrame frame = frame_of(half.span);
        add_children(half, frame, {item.a, item.a}, {item.b, item.b}, 1);
        if (is_contact_) {
            return;
        }
    }
}

void ClearanceQuery::add(const Item& item) {
    if (diving_ != nullptr) {
        if (!(item.a.is_triangle() && item.b.is_triangle())) {
            diving_->push(item, item.key, item.next > 0 ? 0 : item.a.depth + item.b.depth);
        }
    } else if (is_contact_) {
        return;
    } else if (is_settled(item.key)) {
        settle(item);
    } else if (counts_.pops > kPatience &&
               item.a.triangle_count() + item.b.triangle_count() <= kSmall) {
        stack_.push_back(item);
    } else {
        queue_.push(item, item.key, item.next > 0 ? 0 : item.a.depth + item.b.depth);
    }
}

void ClearanceQuery::settle(const Item& item) {
    if (diving_ != nullptr) {
        return;
    }
    settled_ = std::min(settled_, item.key);
    const double limit = known_high();
    if (item.key <= limit) {
        spans_.add(item.span, item.key);
        if (spans_.is_due()) {
            spans_.thin_out(limit);
        }
    }
}

double ClearanceQuery::least_open() const {
    double low = std::min(settled_, queue_.next_time());
    for (const Item& item : stack_) {
        low = std::min(low, item.key);
    }
    return low;
}

double ClearanceQuery::low() const {
    const double low = std::min(least_open(), high_);
    return pair_.mesh_length(std::max(low, 0.0));
}

double ClearanceQuery::high() const { return pair_.mesh_length(high_); }

std::optional<ClearanceWitness> ClearanceQuery::witness() const { return witness_; }

std::vector<TimeSpan> ClearanceQuery::when(double limit) const {
    TimeSpans spans = spans_;
    const double scaled_limit = pair_.scaled_length(limit);
    for (const Item& item : stack_) {
        spans.add(item.span, item.key);
    }
    queue_.for_each([&](const Item& item) { spans.add(item.span, item.key); });
    std::vector<TimeSpan> result = spans.below(scaled_limit);
    for (TimeSpan& span : result) {
        span = {pair_.seconds(span.low), pair_.seconds(span.high)};
    }
    return result;
}

} // namespace obb
