#include "scene/swept_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace obb {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A long way is cut, or its box would hold much that the body never comes near: into at most so
// many parts, each as long as so many boxes.
constexpr double kMostParts = 64;
constexpr double kBoxesAPart = 4;
constexpr std::uint32_t kLeafSize = 4;
constexpr std::uint32_t kMixed = std::numeric_limits<std::uint32_t>::max();

// Space and time.
struct Box4 {
    std::array<double, 4> low{kInfinity, kInfinity, kInfinity, kInfinity};
    std::array<double, 4> high{-kInfinity, -kInfinity, -kInfinity, -kInfinity};

    void include(const Box4& other) {
        for (std::size_t k = 0; k < 4; ++k) {
            low[k] = std::min(low[k], other.low[k]);
            high[k] = std::max(high[k], other.high[k]);
        }
    }

    [[nodiscard]] bool is_near(const Box4& other, double reach) const {
        for (std::size_t k = 0; k < 3; ++k) {
            if (low[k] - reach > other.high[k] || other.low[k] - reach > high[k]) {
                return false;
            }
        }
        return low[3] <= other.high[3] && other.low[3] <= high[3];
    }
};

// Part of the way of a box, and all that it passes through.
struct Part {
    Box4 swept;
    std::array<double, 4> middle; // of what is finite
    std::uint32_t box;
};

struct Node {
    Box4 swept;
    std::uint32_t begin, end;     // of parts
    std::uint32_t left = 0;       // the right one follows; 0 for a leaf
    std::uint32_t group = kMixed; // of all bodies in it
    bool is_static = false;       // all bodies in it
};

class Sweep {
  public:
    Sweep(std::span<const SweptBox> boxes, const SweptBodies& bodies, double reach)
        : bodies_(bodies), reach_(reach) {
        boxes_.reserve(boxes.size());
        for (const SweptBox& box : boxes) {
            boxes_.push_back(usable(box));
        }
        cut();
    }

    std::vector<NearPair> pairs() {
        if (parts_.empty()) {
            return {};
        }
        build();
        traverse();
        // Of the same two bodies the earliest.
        const auto by_pair = [](const NearPair& p) { return std::tuple(p.a, p.b, p.time); };
        std::ranges::sort(pairs_, {}, by_pair);
        const auto is_same = [](const NearPair& p, const NearPair& q) {
            return p.a == q.a && p.b == q.b;
        };
        pairs_.erase(std::unique(pairs_.begin(), pairs_.end(), is_same), pairs_.end());
        std::ranges::sort(pairs_, {},
                          [](const NearPair& p) { return std::tuple(p.time, p.a, p.b); });
        return std::move(pairs_);
    }

  private:
    // Parts of equal length, shorter where ways are long for the boxes of this scene.
    void cut() {
        double total = 0;
        for (const SweptBox& box : boxes_) {
            const double width = norm_inf(box.high - box.low);
            total += std::isfinite(width) ? width : 0;
        }
        const double usual = total / static_cast<double>(std::max<std::size_t>(boxes_.size(), 1));
        for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
            const SweptBox& box = boxes_[i];
            const double duration = box.end - box.start;
            const double way = norm_inf(box.velocity) * duration;
            const double width = std::max(norm_inf(box.high - box.low), usual);
            const double wanted = width > 0 ? std::ceil(way / (kBoxesAPart * width)) : kMostParts;
            const double count = way > 0 ? std::clamp(wanted, 1.0, kMostParts) : 1.0;
            double start = box.start;
            for (double k = 1; k <= count; ++k) {
                const double end = k == count ? box.end : box.start + duration * (k / count);
                parts_.push_back(part(i, start, end));
                start = end;
            }
        }
    }

    [[nodiscard]] Part part(std::uint32_t number, double start, double end) const {
        const SweptBox& box = boxes_[number];
        Part part{{}, {}, number};
        for (std::size_t k = 0; k < 3; ++k) {
            const double first = box.velocity[k] * (start - box.start);
            const double last = box.velocity[k] * (end - box.start);
            // Of a body that may be anywhere, times can be infinite.
            const bool is_still = box.velocity[k] == 0;
            part.swept.low[k] = box.low[k] + (is_still ? 0 : std::min(first, last));
            part.swept.high[k] = box.high[k] + (is_still ? 0 : std::max(first, last));
        }
        part.swept.low[3] = start;
        part.swept.high[3] = end;
        for (std::size_t k = 0; k < 4; ++k) {
            const double middle = 0.5 * part.swept.low[k] + 0.5 * part.swept.high[k];
            part.middle[k] = std::isfinite(middle) ? middle : 0;
        }
        return part;
    }

    void build() {
        nodes_.push_back({{}, 0, static_cast<std::uint32_t>(parts_.size())});
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            summarise(nodes_[i]);
            const std::uint32_t begin = nodes_[i].begin, end = nodes_[i].end;
            if (end - begin <= kLeafSize) {
                continue;
            }
            const std::uint32_t middle = begin + (end - begin) / 2;
            const std::size_t axis = widest(nodes_[i]);
            std::nth_element(
                parts_.begin() + begin, parts_.begin() + middle, parts_.begin() + end,
                [&](const Part& p, const Part& q) { return p.middle[axis] < q.middle[axis]; });
            nodes_[i].left = static_cast<std::uint32_t>(nodes_.size());
            nodes_.push_back({{}, begin, middle});
            nodes_.push_back({{}, middle, end});
        }
    }

    void summarise(Node& node) const {
        node.group = group_of(parts_[node.begin]);
        node.is_static = true;
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
            node.swept.include(parts_[i].swept);
            node.group = group_of(parts_[i]) == node.group ? node.group : kMixed;
            node.is_static = node.is_static && is_static(parts_[i]);
        }
    }

    // The axis along which parts are furthest apart for their own widths; time is one of them.
    [[nodiscard]] std::size_t widest(const Node& node) const {
        std::size_t best = 0;
        double most = -1;
        for (std::size_t k = 0; k < 4; ++k) {
            double low = kInfinity, high = -kInfinity, widths = 0;
            for (std::uint32_t i = node.begin; i < node.end; ++i) {
                const Part& p = parts_[i];
                low = std::min(low, p.middle[k]);
                high = std::max(high, p.middle[k]);
                const double width = p.swept.high[k] - p.swept.low[k];
                widths += std::isfinite(width) ? width : 0;
            }
            const double spread = high - low;
            const double measure =
                spread > 0 ? spread / (spread / 1024 + widths / (node.end - node.begin)) : 0;
            if (measure > most) {
                most = measure;
                best = k;
            }
        }
        return best;
    }

    void traverse() {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
        while (!stack.empty()) {
            const auto [x, y] = stack.back();
            stack.pop_back();
            const Node &a = nodes_[x], &b = nodes_[y];
            if ((a.is_static && b.is_static) || is_ignored(a.group, b.group) ||
                !a.swept.is_near(b.swept, reach_)) {
                continue;
            }
            if (a.left == 0 && b.left == 0) {
                meet(a, b);
            } else if (x == y) {
                stack.insert(stack.end(),
                             {{a.left, a.left}, {a.left, a.left + 1}, {a.left + 1, a.left + 1}});
            } else if (b.left == 0 || (a.left != 0 && a.end - a.begin >= b.end - b.begin)) {
                stack.insert(stack.end(), {{a.left, y}, {a.left + 1, y}});
            } else {
                stack.insert(stack.end(), {{x, b.left}, {x, b.left + 1}});
            }
        }
    }

    // Two leaves, which may be one and the same.
    void meet(const Node& a, const Node& b) {
        for (std::uint32_t i = a.begin; i < a.end; ++i) {
            for (std::uint32_t j = std::max(b.begin, &a == &b ? i + 1 : 0); j < b.end; ++j) {
                meet(parts_[i], parts_[j]);
            }
        }
    }

    void meet(const Part& p, const Part& q) {
        const SweptBox &a = boxes_[p.box], &b = boxes_[q.box];
        if (a.body == b.body || (is_static(p) && is_static(q)) ||
            is_ignored(group_of(p), group_of(q)) || !p.swept.is_near(q.swept, reach_)) {
            return;
        }
        const double from = std::max(p.swept.low[3], q.swept.low[3]);
        const double to = std::min(p.swept.high[3], q.swept.high[3]);
        if (const auto time = time_near(a, b, from, to, reach_)) {
            pairs_.push_back({std::min(a.body, b.body), std::max(a.body, b.body), *time});
        }
    }

    [[nodiscard]] std::uint32_t group_of(const Part& part) const {
        return bodies_.groups[boxes_[part.box].body];
    }
    [[nodiscard]] bool is_static(const Part& part) const {
        return bodies_.is_static[boxes_[part.box].body] != 0;
    }
    [[nodiscard]] bool is_ignored(std::uint32_t a, std::uint32_t b) const {
        return a != kMixed && b != kMixed && bodies_.is_ignored[a * bodies_.group_count + b] != 0;
    }

    SweptBodies bodies_;
    double reach_;
    std::vector<SweptBox> boxes_;
    std::vector<Part> parts_;
    std::vector<Node> nodes_;
    std::vector<NearPair> pairs_;
};

} // namespace

std::vector<NearPair> swept_pairs(std::span<const SweptBox> boxes, const SweptBodies& bodies,
                                  double reach) {
    const std::size_t count = bodies.groups.size();
    const auto is_out = [&](std::uint32_t group) { return group >= bodies.group_count; };
    if (bodies.is_static.size() != count ||
        bodies.is_ignored.size() != bodies.group_count * bodies.group_count ||
        std::ranges::any_of(bodies.groups, is_out) ||
        std::ranges::any_of(boxes, [&](const SweptBox& box) { return box.body >= count; })) {
        throw std::invalid_argument("numbers of bodies or groups are out of range");
    }
    return Sweep(boxes, bodies, reach).pairs();
}

} // namespace obb
