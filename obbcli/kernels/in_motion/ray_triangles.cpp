// What a ray cast does where it has come down to triangles.
#include "in_motion/ray_cast.hpp"
#include "primitives/pair_query.hpp"

#include <algorithm>
#include <utility>

namespace obb {

namespace {

// Contacts that come earlier by less than this share of their time are no sign that still earlier
// ones come soon: faces that all but tie have thousands of them.
constexpr double kTie = 0x1p-20;

} // namespace

// Tests all triangles under one node against all under the other.
void RayCast::meet(MovingPair& pair, const Entry& entry) {
    std::array<Triangle, kCrowd> on_a, on_b;
    const auto place = [&](const MovingTree& body, const NodeRef& ref, auto& triangles) {
        body.tree().prepare_triangles(ref, ref.triangle_count());
        for (std::uint32_t k = 0; k < ref.triangle_count(); ++k) {
            Triangle t = body.posed_triangle({ref.begin + k, ref.begin + k + 1, 0, 0});
            for (Vec3& v : t) {
                v = vertex_scales_[1] * (vertex_scales_[0] * v);
            }
            triangles[k] = t;
        }
    };
    place(pair.a(), entry.a, on_a);
    place(pair.b(), entry.b, on_b);
    std::array<PairRef, kCrowd> refs;
    std::array<const Triangle*, kCrowd> a, b;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < entry.a.triangle_count(); ++i) {
        for (std::uint32_t j = 0; j < entry.b.triangle_count(); ++j) {
            refs[count] = {TreeView::triangle_ref(entry.a, entry.a.begin + i),
                           TreeView::triangle_ref(entry.b, entry.b.begin + j)};
            a[count] = &on_a[i];
            b[count] = &on_b[j];
            ++count;
        }
    }
    counts_.triangle_tests += count;
    meet_pairs(pair, entry, std::span(refs).first(count), std::span(a).first(count),
               std::span(b).first(count));
}

// Four pairs at a time: by their faces, and what these leave by their edges.
void RayCast::meet_pairs(MovingPair& pair, const Entry& entry, std::span<const PairRef> refs,
                         std::span<const Triangle* const> a, std::span<const Triangle* const> b) {
    struct Left {
        std::size_t pair;
        AxisTimes times;
    };
    std::array<Left, kCrowd> left;
    std::size_t count = 0;
    const auto four_of = [&](std::size_t begin, std::size_t end, const auto& place) {
        FourPairs four;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t at = place(std::min(begin + k, end - 1));
            four.a[k] = a[at];
            four.b[k] = b[at];
        }
        return four;
    };
    const auto may_come_first = [&](const AxisTimes& times) {
        return !(times.entry_low > times.exit_high) && times.entry_low < latest_;
    };
    for (std::size_t begin = 0; begin < refs.size(); begin += 4) {
        FourTimes times = FourTimes::of(motion_);
        times.entry_low.fill(entry.time);
        times.exit_high.fill(entry.end);
        narrow_by_faces(four_of(begin, refs.size(), [](std::size_t k) { return k; }), motion_,
                        times);
        for (std::size_t k = 0; k < 4 && begin + k < refs.size(); ++k) {
            if (may_come_first(times.lane(k))) {
                left[count++] = {begin + k, times.lane(k)};
            }
        }
    }
    for (std::size_t begin = 0; begin < count; begin += 4) {
        FourTimes times;
        for (std::size_t k = 0; k < 4; ++k) {
            times.set(k, left[std::min(begin + k, count - 1)].times);
        }
        narrow_by_edges(four_of(begin, count, [&](std::size_t k) { return left[k].pair; }), motion_,
                        times);
        for (std::size_t k = 0; k < 4 && begin + k < count; ++k) {
            const AxisTimes found = times.lane(k);
            if (may_come_first(found)) {
                const PairRef& refs_of = refs[left[begin + k].pair];
                const bool is_sure = found.entry_high <= found.exit_low;
                if (!is_sure) {
                    add_unsure(pair, {found.entry_low, found.exit_high, refs_of.a, refs_of.b});
                    continue;
                }
                const Candidate candidate{found.entry_low, refs_of.a, refs_of.b};
                add(candidate);
                if (!options_.each_pair && found.entry_high < latest_) {
                    const bool is_tie = latest_ * (1 - kTie) < found.entry_high;
                    latest_ = found.entry_high;
                    front_runner_ = candidate;
                    waits_ = is_tie ? waits_ : counts_.pops + patience_;
                }
            }
        }
    }
}

// Triangles of which the axes say little, as degenerate ones: boxes around them may say more, and
// take far less than exact arithmetic.
void RayCast::add_unsure(MovingPair& pair, const Entry& entry) {
    const BoxEntries found =
        entries_of(pair, entry, {{entry.a, entry.a}, 1}, {{entry.b, entry.b}, 1});
    ++counts_.box_tests;
    if (Entry part; narrow(entry, found.entry[0], found.exit[0], part)) {
        add({part.time, entry.a, entry.b});
    }
}

void RayCast::add(const Candidate& candidate) {
    candidates_.push_back(candidate);
    std::push_heap(candidates_.begin(), candidates_.end());
}

// Exact arithmetic takes as long as hundreds of boxes, so it waits until nothing can come before a
// pair.
bool RayCast::is_next_due() const {
    return !candidates_.empty() && candidates_.front().low <= next_time();
}

// Ahead of its time the front runner is due where any contact will do, and where so many pops have
// found nothing much earlier that a tie is to be feared.
bool RayCast::is_candidate_due() const {
    return is_next_due() || (options_.any_contact && front_runner_) ||
           (!options_.each_pair && !candidates_.empty() && counts_.pops > waits_);
}

RayCast::Candidate RayCast::take_candidate() {
    if (front_runner_ && !is_next_due()) {
        return *std::exchange(front_runner_, std::nullopt);
    }
    std::pop_heap(candidates_.begin(), candidates_.end());
    const Candidate candidate = candidates_.back();
    candidates_.pop_back();
    return candidate;
}

// Eberly 2008 §4.2.2.
void RayCast::solve(const MovingPair& pair) {
    const Candidate candidate = take_candidate();
    patience_ *= 2;
    waits_ = counts_.pops + patience_;
    const bool is_known =
        exact_ && exact_->a.begin == candidate.a.begin && exact_->b.begin == candidate.b.begin;
    if (is_known || (!options_.each_pair && ties_.are_later(pair, {candidate.a, candidate.b}))) {
        return;
    }
    ++counts_.exact_triangle_tests;
    const LinearMotion motion = pair.linear_motion();
    const std::optional<PairContact> found = obb::first_contact(
        pair.a().posed_triangle(candidate.a), pair.b().posed_triangle(candidate.b), motion);
    if (!found) {
        // Of faces along each other doubles tell little, and floats less: the earliest first.
        is_close_ = true;
        frontier_.become_queue();
        return;
    }
    const double high = pair.scaled_time(std::min(found->time_above, motion.duration));
    const double low = pair.scaled_time(found->time_below);
    keep(pair, candidate,
         {low, high, Evidence::kIntersecting, candidate.a, candidate.b, 0, 0, 0, 0}, found->touch);
}

// The earliest contact so far; with `each_pair` one of many. The times of two may round up to the
// same double although one comes before it: what is proven to be free of contact ends there.
void RayCast::keep(const MovingPair& pair, const Candidate& candidate, const Contact& contact,
                   const Touch& touch) {
    if (options_.each_pair) {
        Contact named = contact;
        named.triangle_a = pair.a().id(contact.a);
        named.triangle_b = pair.b().id(contact.b);
        found_.add(named);
        return;
    }
    const auto bracket = [](const Contact& c) { return std::pair(c.high, c.low); };
    const bool is_first = !exact_ || bracket(contact) < bracket(*exact_);
    // Other planes of the same time may show more.
    const bool ties = !is_first && contact.high == exact_->high && !ties_.are_promising();
    if (is_first) {
        exact_ = contact;
        latest_ = std::min(latest_, contact.high);
    }
    if (is_first || ties) {
        ties_.set(pair, {candidate.a, candidate.b}, touch, counts_.pops);
    }
}

} // namespace obb
