#include "in_motion/screw_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace obb {

namespace {

// Images of more would take more than some hundred megabytes.
constexpr std::size_t kMostTriangles = std::size_t{1} << 21;
constexpr std::size_t kMostImages = std::size_t{1} << 21;
// So many pairs of nodes near the axis, for each image, are a crowd.
constexpr std::size_t kCrowd = 4;

std::size_t triangle_count(const MovingPair& pair) {
    return std::size_t{pair.a().tree().triangle_count()} + pair.b().tree().triangle_count();
}

} // namespace

std::optional<RelativeScrew> common_screw(const MovingPair& pair, double near) {
    if (triangle_count(pair) > kMostTriangles) {
        return std::nullopt;
    }
    const MovingFrame start = pair.frame(0, 0);
    return relative_screw(
        {pair.a().spin().velocity(), pair.b().spin().velocity(), start.between,
         start.closing_velocity, pair.duration(), pair.scaled_length(pair.a().farthest()),
         pair.scaled_length(pair.b().farthest()), pair.scaled_length(pair.a().extent()),
         pair.scaled_length(pair.b().extent()), near});
}

bool ScrewSearch::make(const MovingPair& pair, double start, SliceClock& clock) {
    duration_ = pair.duration();
    while (stage_ != Stage::kMade && stage_ != Stage::kFailed) {
        const bool is_a = stage_ == Stage::kReadA || stage_ == Stage::kMakeA;
        const MovingTree& body = is_a ? pair.a() : pair.b();
        if (stage_ == Stage::kReadA || stage_ == Stage::kReadB) {
            if (!read(body, is_a ? Stage::kMakeA : Stage::kMakeB, clock)) {
                return false;
            }
            continue;
        }
        if (!make_images(body, is_a ? screw_.shift_a : screw_.shift_b,
                         pair.scaled_length(body.extent()), clock)) {
            return false;
        }
        if (made_.images.size() > kMostImages) {
            made_ = {};
            trees_ = {};
            stage_ = Stage::kFailed;
            return true;
        }
        trees_[is_a ? 0 : 1] = ImageTree(screw_, std::exchange(made_, {}).images);
        stage_ = Stage::kReadB;
        if (!is_a) {
            finish(start);
        }
    }
    return true;
}

// A tree that grows over its mesh has the mesh's triangles; one from a file has to be read.
bool ScrewSearch::read(const MovingTree& body, Stage next, SliceClock& clock) {
    const TreeView& tree = body.tree();
    const bool by_row = !tree.rows.empty();
    by_row_[next == Stage::kMakeA ? 0 : 1] = by_row;
    if (!is_reading_ && !by_row) {
        preparation_.begin(tree, tree.root());
        is_reading_ = true;
    }
    if (is_reading_ && !preparation_.advance(clock)) {
        return false;
    }
    is_reading_ = false;
    stage_ = next;
    return true;
}

bool ScrewSearch::make_images(const MovingTree& body, Vec3 shift, double extent,
                              SliceClock& clock) {
    const TreeView& tree = body.tree();
    const std::span<const Corners> triangles = tree.rows.empty() ? tree.corners : tree.rows;
    constexpr AxialPoint kUnknown{0, 0, 0, -1, 0};
    if (!made_.maker) {
        made_.points.assign(tree.vertices.size(), kUnknown);
        made_.images.reserve(triangles.size());
    }
    const auto point = [&](std::uint32_t vertex) {
        AxialPoint& p = made_.points[vertex];
        if (p.radius < 0) {
            p = axial_point(screw_, body.start_of(tree.vertices[vertex]), shift);
        }
        return p;
    };
    for (; made_.next < triangles.size() && made_.images.size() <= kMostImages; ++made_.next) {
        if (made_.next % 64 == 63 && clock.is_over()) {
            return false;
        }
        const Corners& c = triangles[made_.next];
        if (std::max({c[0], c[1], c[2]}) >= tree.vertices.size()) {
            throw TreeError("a triangle uses a vertex that is not there");
        }
        const std::array<AxialPoint, 3> corners{point(c[0]), point(c[1]), point(c[2])};
        if (!made_.maker) {
            made_.maker.emplace(screw_, corners[0].z, extent);
        }
        made_.maker->add(corners, made_.next, made_.images);
    }
    return true;
}

void ScrewSearch::finish(double start) {
    if (is_crowded(start)) {
        trees_ = {};
        stage_ = Stage::kFailed;
        return;
    }
    stage_ = Stage::kMade;
    for (const std::uint32_t a : trees_[0].roots()) {
        for (const std::uint32_t b : trees_[1].roots()) {
            push({start, a, b, 0}, duration_);
        }
    }
}

// Rings have no angles: where a screw slides, those of one body may meet all of the other that are
// at their radius, each pair at its own time. Steps are better than such a crowd, as where a cone
// of many facets comes down into a hole.
bool ScrewSearch::is_crowded(double start) {
    const std::size_t most = kCrowd * (trees_[0].image_count() + trees_[1].image_count());
    std::vector<Entry> stack;
    for (const std::uint32_t a : trees_[0].roots()) {
        for (const std::uint32_t b : trees_[1].roots()) {
            if (trees_[0].node(a).is_ring || trees_[1].node(b).is_ring) {
                stack.push_back({start, a, b, 0});
            }
        }
    }
    for (std::size_t looked_at = 0; !stack.empty(); ++looked_at) {
        if (looked_at > most) {
            return true;
        }
        Entry entry = stack.back();
        stack.pop_back();
        if (std::isinf(first_time(entry)) || is_last(entry)) {
            continue;
        }
        const std::array<Entry, 2> children = split(entry);
        stack.insert(stack.end(), children.begin(), children.end());
    }
    return false;
}

// Rounded so that no contact at `time` or later is left out; one multiplication.
double ScrewSearch::sigma_of(double time) const { return (1 - 0x1p-50) * (screw_.speed * time); }

double ScrewSearch::time_of(double sigma, double least) const {
    const double time = (1 - 0x1p-50) * (sigma / screw_.speed);
    return time > least ? std::min(time, duration_) : least;
}

double ScrewSearch::meeting_time(const ImagePair& images, double time) const {
    const double sigma =
        first_meeting(screw_, trees_[0].image(images.a), trees_[1].image(images.b), sigma_of(time));
    return std::isinf(sigma) ? sigma : time_of(sigma, time);
}

// Pairs of single images go by the bound of the images, so that they are handed over in order.
double ScrewSearch::first_time(const Entry& entry) {
    const ImageNode &a = trees_[0].node(entry.a), &b = trees_[1].node(entry.b);
    ++tests_;
    const double sigma = first_meeting(screw_, a, b, sigma_of(entry.time));
    if (std::isinf(sigma)) {
        return sigma;
    }
    const double time = time_of(sigma, entry.time);
    if (!is_last(entry)) {
        return time;
    }
    ++tests_;
    return meeting_time({a.begin, b.begin}, time);
}

bool ScrewSearch::is_last(const Entry& entry) const {
    return trees_[0].node(entry.a).is_image() && trees_[1].node(entry.b).is_image();
}

// The pairs that the larger node's children make.
std::array<ScrewSearch::Entry, 2> ScrewSearch::split(const Entry& entry) {
    const ImageNode &a = trees_[0].node(entry.a), &b = trees_[1].node(entry.b);
    const bool opens_a = b.is_image() || (!a.is_image() && a.size >= b.size);
    const std::uint32_t first = trees_[opens_a ? 0 : 1].split(opens_a ? entry.a : entry.b);
    std::array<Entry, 2> children{entry, entry};
    for (std::uint32_t k = 0; k < 2; ++k) {
        (opens_a ? children[k].a : children[k].b) = first + k;
        ++children[k].depth;
    }
    return children;
}

void ScrewSearch::push(Entry entry, double last) {
    entry.time = first_time(entry);
    if (!std::isinf(entry.time) && !(entry.time > last)) {
        queue_.push(entry, entry.time, entry.depth);
    }
}

std::optional<ScrewSearch::Met> ScrewSearch::advance(double last) {
    const Entry entry = queue_.pop();
    if (is_last(entry)) {
        return hand_over(entry);
    }
    for (const Entry& child : split(entry)) {
        push(child, last);
    }
    return std::nullopt;
}

// Two triangles of which one was cut would be advanced once for every pair of pieces: they are
// handed over once, with the earliest pair, and for good.
std::optional<ScrewSearch::Met> ScrewSearch::hand_over(const Entry& entry) {
    const std::uint32_t number_a = trees_[0].node(entry.a).begin,
                        number_b = trees_[1].node(entry.b).begin;
    const Image &a = trees_[0].image(number_a), &b = trees_[1].image(number_b);
    const auto ref = [&](std::size_t body, std::uint32_t triangle) {
        return NodeRef{triangle, triangle + 1, by_row_[body] ? kMeshRow : 0, 0};
    };
    Met met{entry.time, {ref(0, a.triangle), ref(1, b.triangle)}, {number_a, number_b}};
    if (a.is_piece || b.is_piece) {
        met.images = {};
        if (!cut_pairs_.insert(std::uint64_t{a.triangle} << 32U | b.triangle).second) {
            return std::nullopt;
        }
    }
    return met;
}

} // namespace obb
