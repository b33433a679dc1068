#include "tree_build.hpp"

#include "fit_hull.hpp"
#include "scale.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace obb {

namespace {

// The power of two that brings the largest coordinate into [1/2, 1).
int scale_exponent_of(std::span<const Vec3> vertices) {
    double largest = 0;
    for (const Vec3& v : vertices) {
        largest = std::fmax(largest, norm_inf(v));
    }
    return exponent_of(largest);
}

float rounded_up(double value) {
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) < value
               ? std::nextafter(nearest, std::numeric_limits<float>::infinity())
               : nearest;
}

Vec3 centroid(const Triangle& t) { return (1.0 / 3.0) * (t[0] + t[1] + t[2]); }

Triangle relative_to(const Triangle& t, Vec3 p) { return {t[0] - p, t[1] - p, t[2] - p}; }

// Indices of the axes, longest first; equal lengths keep their order.
std::array<std::size_t, 3> longest_first(Vec3 half_extents) {
    std::array<std::size_t, 3> order{0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
        return half_extents[i] > half_extents[k];
    });
    return order;
}

} // namespace

TreeBuilder::TreeBuilder(std::span<const Vec3> vertices, std::span<const Corners> corners,
                         const BuildOptions& options)
    : options_(options), vertices_(vertices), mesh_corners_(corners),
      scale_exponent_(scale_exponent_of(vertices)), corners_(corners.size()), ids_(corners.size()) {
    const auto count = static_cast<std::uint32_t>(corners.size());
    items_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            items_[i].corners[k] = scaled(vertices[corners[i][k]], -scale_exponent_);
        }
        items_[i].id = i;
    }
    const Range all{0, count};
    if (count < 2) {
        settle(all);
        return;
    }
    keys_.resize(count);
    nodes_ = ZeroedArray<Node>(count - 1);
    ready_ = ZeroedArray<std::uint8_t>(count - 1);
    on_demand_ = {ready_.data(), this, [](void* self, const NodeRef& ref) {
                      static_cast<TreeBuilder*>(self)->prepare(ref);
                  }};
    const NodeRef root{0, count, 0, 0};
    const Vec3 reference = items_[0].corners[0];
    fit_box(all, moments_of(all, reference), reference, nodes_[0]);
    add_node(root);
    pending_.push_back(root);
    forget_items();
}

// Of use to nobody any more once every node is split.
void TreeBuilder::forget_items() {
    if (unsplit_count_ == 0) {
        items_ = {};
        keys_ = {};
    }
}

TreeView TreeBuilder::view() const {
    return {vertices_,     corners_.span(), ids_.span(),
            nodes_.span(), scale_exponent_, nodes_.size() > 0 ? &on_demand_ : nullptr};
}

// Whoever loses the race for the lock finds the node ready. The flag is written last: from then on
// nobody touches the range but to read it, or to split the children's parts of it.
void TreeBuilder::prepare(const NodeRef& ref) {
    const std::lock_guard lock(locks_[ref.slot % kLockCount]);
    if (is_ready(ref.slot)) {
        return;
    }
    split_node(ref);
    work_done_ += ref.triangle_count();
    __atomic_store_n(&ready_[ref.slot], std::uint8_t{1}, __ATOMIC_RELEASE);
    if (--unsplit_count_ == 0) {
        forget_items();
    }
}

bool TreeBuilder::advance(std::uint64_t work) {
    const std::uint64_t stop = work_done_ + work;
    while (!pending_.empty() && work_done_ < stop) {
        const NodeRef ref = pending_.back();
        pending_.reserve(pending_.size() + 1); // nothing may be lost where memory ends
        if (is_leaf(ref)) {
            pending_.pop_back();
            continue;
        }
        const auto children = view().children(ref, nodes_[ref.slot]);
        pending_.pop_back();
        for (const NodeRef& child : children) {
            if (!child.is_triangle()) {
                pending_.push_back(child);
            }
        }
    }
    return pending_.empty();
}

// A balanced tree moves every triangle once a level.
double TreeBuilder::progress() const {
    const auto count = static_cast<double>(ids_.size());
    const double total = std::log2(count + 1.0) * count;
    return pending_.empty() ? 1.0 : std::min(0.99, static_cast<double>(work_done_) / total);
}

std::uint32_t TreeBuilder::node_count() const { return node_count_; }

std::size_t TreeBuilder::byte_count() const {
    return node_count() * sizeof(Node) + ready_.size() +
           ids_.size() * (sizeof(Corners) + sizeof(std::uint32_t)) +
           (unsplit_count_ == 0 ? 0 : ids_.size() * (sizeof(Item) + sizeof(double)));
}

bool TreeBuilder::is_leaf(const NodeRef& ref) const {
    return ref.triangle_count() <= options_.leaf_size || ref.depth >= options_.max_depth;
}

void TreeBuilder::split_node(const NodeRef& ref) {
    Node& node = nodes_[ref.slot];
    std::array<Moments, 2> moments;
    const std::uint32_t split = partition({ref.begin, ref.end}, node, node.center, moments);
    node.right = ref.slot + (split - ref.begin);
    __atomic_store_n(&node.split, split, __ATOMIC_RELAXED); // is_leaf() may be reading it
    const std::array<NodeRef, 2> children{{{ref.begin, split, ref.slot + 1, ref.depth + 1},
                                           {split, ref.end, node.right, ref.depth + 1}}};
    for (std::size_t side = 0; side < 2; ++side) {
        if (!children[side].is_triangle()) {
            const Range range{children[side].begin, children[side].end};
            fit_box(range, moments[side], node.center, nodes_[children[side].slot]);
        }
    }
    for (const NodeRef& child : children) { // counted once, also where memory ended before
        if (child.is_triangle()) {
            settle({child.begin, child.end});
        } else {
            add_node(child);
        }
    }
}

void TreeBuilder::add_node(const NodeRef& ref) {
    const Range range{ref.begin, ref.end};
    Node& node = nodes_[ref.slot];
    if (is_leaf(ref)) {
        settle(range);
        __atomic_store_n(&ready_[ref.slot], std::uint8_t{1}, __ATOMIC_RELEASE);
    } else {
        node.split = kUnsplit;
        ++unsplit_count_;
    }
    ++node_count_;
}

// Triangles that will not be moved again, for questions to read.
void TreeBuilder::settle(Range range) {
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        ids_[i] = items_[i].id;
        corners_[i] = mesh_corners_[items_[i].id];
    }
}

// Eberly 2008 §6.2. The center rule may put all centroids on one side; the next longest axes are
// tried then, and at last the median of the longest axis, which always parts them.
std::uint32_t TreeBuilder::partition(Range range, const Node& node, Vec3 reference,
                                     std::array<Moments, 2>& moments) {
    const auto axes = axes_of(node.rotation);
    const auto order = longest_first(half_extents_of(node));
    if (options_.split == Split::kCenter) {
        for (const std::size_t k : order) {
            compute_keys(range, axes[k]);
            const Threshold at_center{dot(axes[k], node.center), 0};
            const auto is_left = [&](double key) { return key < at_center.key; };
            const auto first = keys_.begin() + range.begin, last = keys_.begin() + range.end;
            if (std::any_of(first, last, is_left) && !std::all_of(first, last, is_left)) {
                return partition_at(range, at_center, reference, moments);
            }
        }
    }
    compute_keys(range, axes[order[0]]);
    return partition_at(range, median_threshold(range), reference, moments);
}

void TreeBuilder::compute_keys(Range range, Vec3 axis) {
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        keys_[i] = dot(axis, centroid(items_[i].corners));
    }
}

// Ties are broken by the triangle's id, so that half of the range lies on each side even where all
// keys are equal, and the same whatever order the triangles arrived in.
TreeBuilder::Threshold TreeBuilder::median_threshold(Range range) {
    std::vector<std::pair<double, std::uint32_t>> candidates;
    candidates.reserve(range.size());
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        candidates.emplace_back(keys_[i], items_[i].id);
    }
    const auto middle = candidates.begin() + static_cast<std::ptrdiff_t>(candidates.size() / 2);
    std::nth_element(candidates.begin(), middle, candidates.end());
    return {middle->first, middle->second};
}

std::uint32_t TreeBuilder::partition_at(Range range, const Threshold& threshold, Vec3 reference,
                                        std::array<Moments, 2>& moments) {
    const bool needs_moments = fits_by_moments(options_.fit);
    const auto is_left = [&](std::uint32_t i) {
        return threshold.is_above(keys_[i], items_[i].id);
    };
    const auto count_in = [&](std::size_t side, std::uint32_t i) {
        if (needs_moments) {
            moments[side].add(relative_to(items_[i].corners, reference), options_.fit);
        }
    };
    std::uint32_t left = range.begin, right = range.end;
    while (true) {
        for (; left < right && is_left(left); ++left) {
            count_in(0, left);
        }
        for (; left < right && !is_left(right - 1); --right) {
            count_in(1, right - 1);
        }
        if (left == right) {
            return left;
        }
        std::swap(items_[left], items_[right - 1]);
        std::swap(keys_[left], keys_[right - 1]);
    }
}

Moments TreeBuilder::moments_of(Range range, Vec3 reference) const {
    Moments moments;
    if (fits_by_moments(options_.fit)) {
        for (std::uint32_t i = range.begin; i < range.end; ++i) {
            moments.add(relative_to(items_[i].corners, reference), options_.fit);
        }
    }
    return moments;
}

std::vector<Vec3> TreeBuilder::corners_of(Range range) const {
    std::vector<Vec3> points;
    points.reserve(3 * static_cast<std::size_t>(range.size()));
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        points.insert(points.end(), items_[i].corners.begin(), items_[i].corners.end());
    }
    return points;
}

// The smallest box of the given orientation. Its half extents are those of the exact coordinates
// along the stored axes, plus what rounding may have lost: the projections (relative to the box's
// own size), the axes' defect of a few ulps, and the centre's last place.
void TreeBuilder::fit_box(Range range, const Moments& moments, Vec3 reference, Node& node) const {
    constexpr double kRelativeMargin = 0x1p-45;
    constexpr double kCenterMargin = 0x1p-50;
    constexpr double kUnderflowMargin = 0x1p-900; // products of the tiniest coordinates vanish

    Moments by_corners;
    const Moments* chosen = &moments;
    if (fits_by_moments(options_.fit) && moments.is_empty()) { // no area: points or segments
        for (std::uint32_t i = range.begin; i < range.end; ++i) {
            by_corners.add_corners(relative_to(items_[i].corners, reference));
        }
        chosen = &by_corners;
    }
    if (options_.fit == Fit::kHull || options_.fit == Fit::kMinVolume) {
        const bool is_root = range.size() == items_.size();
        node.rotation = hull_rotation(corners_of(range), options_.fit, is_root);
    } else {
        node.rotation = chosen->is_empty() ? std::array<float, 4>{1, 0, 0, 0}
                                           : quaternion_of(chosen->principal_axes());
    }

    const auto axes = axes_of(node.rotation);
    const Vec3 origin = items_[range.begin].corners[0];
    std::array<double, 3> low{0, 0, 0}, high{0, 0, 0};
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        for (const Vec3& corner : items_[i].corners) {
            const Vec3 p = corner - origin;
            for (std::size_t k = 0; k < 3; ++k) {
                const double y = dot(axes[k], p);
                low[k] = y < low[k] ? y : low[k];
                high[k] = y > high[k] ? y : high[k];
            }
        }
    }
    node.center = origin;
    double total = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        node.center = node.center + (0.5 * (low[k] + high[k])) * axes[k];
        total += 0.5 * (high[k] - low[k]);
    }
    const double margin =
        kRelativeMargin * total + kCenterMargin * norm_1(node.center) + kUnderflowMargin;
    for (std::size_t k = 0; k < 3; ++k) {
        node.half_extents[k] = rounded_up(0.5 * (high[k] - low[k]) + margin);
    }
    node.split = node.right = node.reserved = 0;
}

// Slots follow one another in depth-first order, so moving the boxes together keeps a left child
// behind its parent.
std::vector<Node> TreeBuilder::without_gaps() const {
    std::vector<Node> compact;
    std::vector<std::pair<NodeRef, std::uint32_t>> walk; // a node, and the parent whose right it is
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    const TreeView tree = view();
    compact.reserve(node_count());
    if (nodes_.size() > 0) {
        walk.push_back({tree.root(), kNone});
    }
    while (!walk.empty()) {
        const auto [ref, parent] = walk.back();
        walk.pop_back();
        const auto slot = static_cast<std::uint32_t>(compact.size());
        if (parent != kNone) {
            compact[parent].right = slot;
        }
        compact.push_back(nodes_[ref.slot]);
        if (TreeView::is_leaf(compact.back())) {
            continue;
        }
        const auto [left, right] = tree.children(ref, nodes_[ref.slot]);
        if (!right.is_triangle()) {
            walk.push_back({right, slot});
        }
        if (!left.is_triangle()) {
            walk.push_back({left, kNone});
        }
    }
    return compact;
}

} // namespace obb
