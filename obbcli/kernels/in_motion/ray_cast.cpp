#include "in_motion/ray_cast.hpp"

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

// Of two boxes whose sizes differ by no more than this both are opened.
constexpr double kAlike = 0.5;
// Triangles of a leaf, which may hold a whole mesh, that are looked at in one pop.
constexpr std::uint32_t kTrianglesAPop = 64;
// Pops without an earlier contact after which the front runner is solved ahead of its time: where
// many pairs touch at one time, its planes tell.
constexpr std::uint64_t kPatience = 32;
// Pops after which a question counts as a long one: then the earliest boxes go first.
constexpr std::uint64_t kLong = 8192;
// How far from the middle of its coordinates a pair may be, of its size.
constexpr double kFarthest = 0x1p90;
// Beyond what box_entries() rounds: of sums of times.
constexpr double kDown = 1 - 0x1p-52, kUp = 1 + 0x1p-52;

} // namespace

RayCast::Parts RayCast::parts_of(const MovingTree& body, const NodeRef& ref, bool is_opened) {
    if (is_opened) {
        return {body.tree().children(ref, body.tree().node(ref)), 2};
    }
    return {{ref, ref}, 1};
}

bool RayCast::suits(const MovingPair& pair) {
    const double place = std::max(norm_1(pair.a().screw().pivot), norm_1(pair.b().screw().pivot));
    return pair.is_translation() && pair.scaled_length(place) <= kFarthest;
}

RayCast::RayCast(const MovingPair& pair, const RayCastOptions& options)
    : options_(options), duration_(pair.duration()),
      motion_{pair.closing_velocity(), pair.duration()},
      relative_(2 * pair.frame(0, 0).relative + 8 * (pair.a().skew() + pair.b().skew())),
      frontier_(options.each_pair), patience_(kPatience), waits_(kPatience) {
    const int exponent = -pair.length_exponent(), half = exponent / 2;
    vertex_scales_ = {power_of_two(half), power_of_two(exponent - half)};
    const TreeView &a = pair.a().tree(), &b = pair.b().tree();
    frontier_.push({0, duration_, a.root(), b.root()});
}

double RayCast::next_time() const {
    const double first = frontier_.next_time();
    return candidates_.empty() ? first : std::min(first, candidates_.front().low);
}

bool RayCast::advance(MovingPair& pair, std::uint64_t max_pops, double until) {
    pair.set_time(0); // boxes stand where they are at first, and their distance changes
    SliceClock clock;
    while (max_pops > 0 && !clock.is_over()) {
        if (ties_.is_looking()) {
            const TiePlanes::Verdict verdict = ties_.look_on(pair, clock);
            if (verdict == TiePlanes::Verdict::kLooking) {
                break;
            }
            take_tie(pair, verdict);
            continue;
        }
        if (has_ended() || is_ready() || lower_bound_ > until) {
            break;
        }
        --max_pops;
        ++counts_.pops;
        if (is_candidate_due()) {
            solve(pair);
        } else {
            visit(pair, frontier_.pop());
        }
        if (counts_.pops > kLong && !frontier_.is_queue()) {
            frontier_.become_queue();
        }
    }
    return has_ended();
}

bool RayCast::has_ended() {
    if (is_finished_ || ties_.is_looking()) {
        return is_finished_;
    }
    while (!frontier_.is_empty() && exact_ && !frontier_.is_next_before(latest_)) {
        static_cast<void>(frontier_.pop());
    }
    const double next = next_time();
    lower_bound_ = std::min({next, duration_, exact_ ? exact_->low : duration_});
    is_finished_ = exact_ ? options_.any_contact || next >= exact_->high
                          : frontier_.is_empty() && candidates_.empty();
    return is_finished_;
}

std::optional<Contact> RayCast::take() {
    return is_ready() ? std::optional(found_.pop()) : std::nullopt;
}

void RayCast::visit(MovingPair& pair, const Entry& entry) {
    if (!(entry.time < latest_)) {
        return;
    }
    if (std::uint64_t{entry.a.triangle_count()} * entry.b.triangle_count() <= kCrowd) {
        meet(pair, entry);
        return;
    }
    looked_at_ = entry;
    take_tie(pair, ties_.may_tie(entry.refs(), counts_.pops)
                       ? ties_.look(pair, entry.refs(), counts_.pops)
                       : TiePlanes::Verdict::kUnknown);
}

// Goes on with the pair that was looked at, as the planes of the earliest contact say.
void RayCast::take_tie(MovingPair& pair, TiePlanes::Verdict verdict) {
    if (verdict == TiePlanes::Verdict::kUnknown) {
        part(pair, *looked_at_);
    } else if (verdict == TiePlanes::Verdict::kAllIsLater) {
        frontier_.clear();
        candidates_.clear();
    }
}

// The larger box is opened, or both where they are about as large. A leaf is opened alone.
void RayCast::part(MovingPair& pair, const Entry& entry) {
    const bool open_a = !entry.a.is_triangle(), open_b = !entry.b.is_triangle();
    const double size_a = MovingPair::size_of(pair.a(), entry.a);
    const double size_b = MovingPair::size_of(pair.b(), entry.b);
    const auto is_leaf = [](const MovingTree& body, const NodeRef& ref) {
        return TreeView::is_leaf(body.tree().node(ref));
    };
    // Written so that of sizes that are no numbers, in a damaged tree, both are opened.
    const bool opens_a = open_a && (!open_b || !(size_a < kAlike * size_b));
    const bool opens_b = open_b && (!open_a || !(size_b < kAlike * size_a));
    const bool leaf_a = opens_a && is_leaf(pair.a(), entry.a);
    const bool leaf_b = opens_b && is_leaf(pair.b(), entry.b);
    if (leaf_a && (!opens_b || leaf_b)) {
        open_leaf(pair, entry, true);
    } else if (leaf_b && !opens_a) {
        open_leaf(pair, entry, false);
    } else {
        open(pair, entry, opens_a && !leaf_a, opens_b && !leaf_b);
    }
}

void RayCast::open(MovingPair& pair, const Entry& entry, bool opens_a, bool opens_b) {
    push_meeting(pair, entry, parts_of(pair.a(), entry.a, opens_a),
                 parts_of(pair.b(), entry.b, opens_b));
}

// Pushes the leaf's next triangles, two at a time, above the rest of the leaf.
void RayCast::open_leaf(MovingPair& pair, const Entry& entry, bool opens_a) {
    const NodeRef& leaf = opens_a ? entry.a : entry.b;
    const NodeRef& other = opens_a ? entry.b : entry.a;
    (opens_a ? pair.a() : pair.b()).tree().prepare(leaf);
    const std::uint32_t begin = leaf.begin + entry.next;
    const std::uint32_t end = begin + std::min(kTrianglesAPop, leaf.end - begin);
    if (end < leaf.end) {
        Entry rest = entry;
        rest.next = end - leaf.begin;
        frontier_.push(rest);
    }
    for (std::uint32_t i = begin; i < end; i += 2) {
        const std::uint32_t last = std::min(i + 1, end - 1);
        const Parts triangles{{TreeView::triangle_ref(leaf, i), TreeView::triangle_ref(leaf, last)},
                              std::size_t{last} - i + 1};
        const Parts whole{{other, other}, 1};
        push_meeting(pair, entry, opens_a ? triangles : whole, opens_a ? whole : triangles);
    }
}

BoxEntries RayCast::entries_of(MovingPair& pair, const Entry& entry, const Parts& a,
                               const Parts& b) const {
    pair.place(a.refs, b.refs);
    const MovingFrame now = pair.box_frame(entry.time);
    return box_entries(pair.boxes(), {now.between, now.closing_velocity,
                                      kUp * (entry.end - entry.time), relative_, now.absolute});
}

// When a pair may touch, of which the boxes say so much; nothing where it cannot, or not before the
// earliest contact known.
std::optional<RayEntry> RayCast::narrowed(const Entry& entry, double first, double last) const {
    const double time = std::max(entry.time, kDown * (entry.time + first));
    if (first > last || time > entry.end || !(time < latest_)) {
        return std::nullopt;
    }
    return Entry{time, std::min(entry.end, kUp * (entry.time + last)), entry.a, entry.b};
}

// Pushes the pairs of parts whose boxes may meet before the earliest contact known, the first to
// meet on top. All pairs of boxes are tested at once.
void RayCast::push_meeting(MovingPair& pair, const Entry& entry, const Parts& a, const Parts& b) {
    Entry whole = entry;
    whole.end = std::min(entry.end, latest_);
    const BoxEntries found = entries_of(pair, whole, a, b);
    std::array<Entry, 4> near;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.count; ++i) {
        for (std::size_t j = 0; j < b.count; ++j) {
            ++counts_.box_tests;
            whole.a = a.refs[i];
            whole.b = b.refs[j];
            const std::optional<Entry> part =
                narrowed(whole, found.entry[2 * i + j], found.exit[2 * i + j]);
            if (!part) {
                continue;
            }
            std::size_t at = count++;
            for (; at > 0 && near[at - 1].time < part->time; --at) {
                near[at] = near[at - 1];
            }
            near[at] = *part;
        }
    }
    for (std::size_t k = 0; k < count; ++k) {
        frontier_.push(near[k]);
    }
}

} // namespace obb
