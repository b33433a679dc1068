#include "build/tree_build.hpp"

#include "work/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace obb {

namespace {

// The power of two that brings the largest coordinate into [1/2, 1).
int scale_exponent_of(std::span<const Vec3> vertices) {
    double largest = 0;
    for (const Vec3& v : vertices) {
        const double size = norm_inf(v);
        largest = largest < size ? size : largest;
    }
    return exponent_of(largest);
}

} // namespace

TreeBuilder::TreeBuilder(std::span<const Vec3> vertices, std::span<const Corners> corners,
                         const BuildOptions& options, bool on_demand, unsigned threads)
    : options_(options), mesh_(vertices, corners, scale_exponent_of(vertices)),
      is_on_demand_(on_demand), threads_(std::max(1U, threads)) {
    const auto count = static_cast<std::uint32_t>(corners.size());
    slots_.corners = ZeroedArray<Corners>(count);
    slots_.ids = ZeroedArray<std::uint32_t>(count);
    if (count < 2) {
        slots_.settle(mesh_, 0, 0);
        return;
    }
    slots_.nodes = ZeroedArray<Node>(count - 1);
    if (is_on_demand_) {
        ready_ = ZeroedArray<std::uint8_t>(count - 1);
        on_demand_ = {ready_.data(), this, [](void* self, const NodeRef& ref) {
                          static_cast<TreeBuilder*>(self)->prepare(ref);
                      }};
    }
    make_root();
}

void TreeBuilder::make_root() {
    const NodeRef root{0, static_cast<std::uint32_t>(slots_.ids.size()), 0, 0};
    if (is_small(root)) {
        std::iota(slots_.ids.data(), slots_.ids.data() + root.end, 0U);
        SmallRanges small(mesh_, options_, slots_, root.end);
        small.load(root);
        small.fit_loaded(mesh_.triangle(0)[0]);
    } else {
        large_ = std::make_unique<LargeRanges>(mesh_, options_, slots_, root.end);
        large_->make_root(threads_);
    }
    note_box(root);
    if (options_.is_leaf(root)) {
        for (std::uint32_t i = 0; i < root.end; ++i) {
            slots_.settle(mesh_, i, i);
        }
        large_.reset();
    } else {
        pending_.push_back(root);
    }
}

TreeView TreeBuilder::view() const {
    return {mesh_.vertices,       slots_.corners.span(),
            slots_.ids.span(),    slots_.nodes.span(),
            mesh_.scale_exponent, on_demand_.ready != nullptr ? &on_demand_ : nullptr,
            mesh_.corners};
}

// Whoever loses the race for the lock finds the node ready. The flag is written last: from then on
// the range is only read, or the children's parts of it are split.
void TreeBuilder::prepare(const NodeRef& ref) {
    const std::lock_guard lock(locks_[ref.slot % kLockCount]);
    if (on_demand_.is_ready(ref.slot)) {
        return;
    }
    split_one(ref);
    for (const NodeRef& child : parted(ref, slots_.nodes[ref.slot].split)) {
        if (!child.is_triangle()) {
            note_box(child);
        }
    }
    work_done_ += ref.triangle_count();
    __atomic_store_n(&ready_[ref.slot], std::uint8_t{1}, __ATOMIC_RELEASE);
    if (--unsplit_count_ == 0) {
        large_.reset(); // no node needs it any more
    }
}

void TreeBuilder::note_box(const NodeRef& ref) {
    ++node_count_;
    if (!is_on_demand_) {
        return;
    }
    if (options_.is_leaf(ref)) {
        __atomic_store_n(&ready_[ref.slot], std::uint8_t{1}, __ATOMIC_RELEASE);
    } else {
        ++unsplit_count_;
    }
}

// Makes the children of a node, and no more.
void TreeBuilder::split_one(const NodeRef& ref) {
    if (is_small(ref)) {
        SmallRanges small(mesh_, options_, slots_, ref.triangle_count());
        small.load(ref);
        small.split_loaded();
        return;
    }
    large_->split(ref, threads_);
    const Node& node = slots_.nodes[ref.slot];
    for (const NodeRef& child : parted(ref, node.split)) {
        if (is_small(child)) {
            SmallRanges small(mesh_, options_, slots_, child.triangle_count());
            small.load(child);
            small.fit_child(node.center);
        }
    }
}

bool TreeBuilder::advance(std::uint64_t work) {
    const std::uint64_t stop = work_done_ + work;
    if (is_on_demand_) {
        return grow(stop);
    }
    split_largest(stop);
    work_until(stop);
    if (pending_.empty()) {
        large_.reset();
    }
    return pending_.empty();
}

// Visits the nodes of a tree that others may be asking.
bool TreeBuilder::grow(std::uint64_t stop) {
    const TreeView tree = view();
    while (!pending_.empty() && work_done_ < stop) {
        const NodeRef ref = pending_.back();
        pending_.reserve(pending_.size() + 1); // nothing may be lost where memory ends
        const auto children = tree.children(ref, slots_.nodes[ref.slot]);
        pending_.pop_back();
        for (const NodeRef& child : children) {
            if (!child.is_triangle() && !options_.is_leaf(child)) {
                pending_.push_back(child);
            }
        }
    }
    return pending_.empty();
}

// Ranges so large that all threads had better work on one of them together.
void TreeBuilder::split_largest(std::uint64_t stop) {
    constexpr std::size_t kFew = 1U << 16U;
    const std::size_t large = std::max(kFew, slots_.ids.size() / (8 * threads_));
    const auto by_size = [](const NodeRef& a, const NodeRef& b) {
        return a.triangle_count() < b.triangle_count();
    };
    SmallRanges small(mesh_, options_, slots_, SmallRanges::kMost);
    while (work_done_ < stop) {
        const auto largest = std::max_element(pending_.begin(), pending_.end(), by_size);
        if (largest == pending_.end() || largest->triangle_count() < large) {
            return;
        }
        const NodeRef ref = *largest;
        *largest = pending_.back();
        pending_.pop_back();
        split_large(small, ref, threads_, pending_);
    }
}

// Makes a node's children, and all that is below the small ones.
void TreeBuilder::split_large(SmallRanges& small, const NodeRef& ref, unsigned threads,
                              std::vector<NodeRef>& left_to_do) {
    node_count_ += large_->split(ref, threads);
    const Node& node = slots_.nodes[ref.slot];
    for (const NodeRef& child : parted(ref, node.split)) {
        if (!is_small(child)) {
            if (!options_.is_leaf(child)) {
                left_to_do.push_back(child);
            }
            continue;
        }
        small.load(child);
        small.fit_child(node.center);
        build_small(small, child);
    }
    work_done_ += ref.triangle_count();
}

void TreeBuilder::build_small(SmallRanges& small, const NodeRef& ref) {
    if (!ref.is_triangle()) {
        small.build_loaded();
        node_count_ += small.take_box_count();
        work_done_ +=
            ref.triangle_count() * static_cast<std::uint64_t>(std::bit_width(ref.triangle_count()));
    }
}

// Each thread takes a range and everything below it.
void TreeBuilder::work_until(std::uint64_t stop) {
    const auto take = [&](NodeRef& ref) {
        const std::lock_guard lock(pending_lock_);
        if (pending_.empty() || work_done_ >= stop) {
            return false;
        }
        ref = pending_.back();
        pending_.pop_back();
        return true;
    };
    const auto work = [&](std::size_t) {
        SmallRanges small(mesh_, options_, slots_, SmallRanges::kMost);
        std::vector<NodeRef> own;
        NodeRef ref{};
        while (take(ref)) {
            own.push_back(ref);
            while (!own.empty() && work_done_ < stop) {
                ref = own.back();
                own.pop_back();
                if (is_small(ref)) { // of a small mesh, the root
                    small.load(ref);
                    build_small(small, ref);
                } else {
                    split_large(small, ref, 1, own);
                }
            }
        }
        const std::lock_guard lock(pending_lock_);
        pending_.insert(pending_.end(), own.begin(), own.end());
        return true;
    };
    const std::size_t threads = std::min<std::size_t>(threads_, pending_.size());
    do_parts(threads, threads_, work, [] {});
}

// A balanced tree moves every triangle once a level.
double TreeBuilder::progress() const {
    const auto count = static_cast<double>(slots_.ids.size());
    const double total = std::log2(count + 1.0) * count;
    return pending_.empty() ? 1.0 : std::min(0.99, static_cast<double>(work_done_) / total);
}

std::size_t TreeBuilder::byte_count() const {
    constexpr std::size_t kMovingBytes = LargeRanges::kBytesATriangle;
    const std::size_t settled = sizeof(Corners) + sizeof(std::uint32_t);
    const bool is_moving = unsplit_count_ > 0 && slots_.ids.size() > SmallRanges::kMost;
    return node_count_ * sizeof(Node) + ready_.size() +
           slots_.ids.size() * (settled + (is_moving ? kMovingBytes : 0));
}

// Slots follow one another in depth-first order, so moving the boxes together keeps a left child
// behind its parent.
std::vector<Node> TreeBuilder::without_gaps() const {
    std::vector<Node> compact;
    std::vector<std::pair<NodeRef, std::uint32_t>> walk; // a node, and the parent whose right it is
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    const TreeView tree = view();
    compact.reserve(node_count_);
    if (slots_.nodes.size() > 0) {
        walk.push_back({tree.root(), kNone});
    }
    while (!walk.empty()) {
        const auto [ref, parent] = walk.back();
        walk.pop_back();
        const auto slot = static_cast<std::uint32_t>(compact.size());
        if (parent != kNone) {
            compact[parent].right = slot;
        }
        compact.push_back(slots_.nodes[ref.slot]);
        if (TreeView::is_leaf(compact.back())) {
            continue;
        }
        const auto [left, right] = tree.children(ref, slots_.nodes[ref.slot]);
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
