#include "build/small_ranges.hpp"

#include "build/double_passes.hpp"
#include "fit/fit_hull.hpp"

#include <algorithm>
#include <utility>

namespace obb {

namespace {

constexpr std::uint32_t kWidth = kDoubles;

std::uint32_t whole_registers(std::uint32_t count) {
    return (count + kWidth - 1) / kWidth * kWidth;
}

} // namespace

// Blocks of three triangles, of which one parts from two, waste the most: five lanes.
SmallRanges::SmallRanges(const UnitMesh& mesh, const BuildOptions& options, TreeSlots& slots,
                         std::uint32_t most)
    : mesh_(&mesh), options_(&options), slots_(&slots),
      stride_(3 * std::size_t{whole_registers(most)} + 2 * kWidth),
      compact_(options.split == Split::kCompact ? most : 0) {
    for (Side* side : {&from_, &to_}) {
        side->coordinates.resize(9 * stride_);
        side->ids.resize(stride_);
    }
    keys_.resize(whole_registers(most));
    sorted_.resize(whole_registers(most));
    is_left_.resize(whole_registers(most));
}

void SmallRanges::load(const NodeRef& ref) {
    for (std::uint32_t i = 0; i < ref.triangle_count(); ++i) {
        const std::uint32_t id = slots_->ids[ref.begin + i];
        from_.ids[i] = id;
        const Triangle t = mesh_->triangle(id);
        for (std::size_t k = 0; k < 9; ++k) {
            from_.coordinates[k * stride_ + i] = t[k / 3][k % 3];
        }
    }
    pad(from_, 0, ref.triangle_count());
    loaded_ = {ref, 0};
    filled_ = 0;
}

void SmallRanges::pad(Side& side, std::uint32_t at, std::uint32_t count) const {
    for (std::uint32_t i = at + count; i % kWidth != 0; ++i) {
        for (std::size_t k = 0; k < 9; ++k) {
            side.coordinates[k * stride_ + i] = side.coordinates[k * stride_ + at];
        }
    }
}

void SmallRanges::add_moments(const Side& side, const Block& block, Vec3 reference, bool by_corners,
                              Moments& moments) const {
    const std::uint32_t count = block.ref.triangle_count();
    const double* first = column(side, 0) + block.at;
    in_registers([&]<std::size_t kBytes>() {
        MomentSums<Doubles<kBytes>> sums;
        for (std::uint32_t i = 0; i < count; i += kWidth) {
            sums.add(triangles_at<kBytes>(first + i, stride_, reference),
                     Doubles<kBytes>::first(count - i), by_corners);
        }
        sums.add_to(moments);
    });
}

Moments SmallRanges::moments_of(const Side& side, const Block& block, Vec3 reference) const {
    Moments moments;
    if (fits_by_moments(options_->fit)) {
        add_moments(side, block, reference, options_->fit == Fit::kPoints, moments);
        if (moments.is_empty()) { // no area: points or segments
            moments = {};
            add_moments(side, block, reference, true, moments);
        }
    }
    return moments;
}

void SmallRanges::fit_loaded(Vec3 reference) { fit(from_, {&loaded_, 1}, {&reference, 1}); }

void SmallRanges::fit_child(Vec3 reference) {
    if (!loaded_.ref.is_triangle()) {
        fit_loaded(reference);
    }
    if (loaded_.ref.is_triangle() || options_->is_leaf(loaded_.ref)) {
        settle(from_, loaded_);
    }
}

void SmallRanges::fit(const Side& side, std::span<const Block> blocks,
                      std::span<const Vec3> references) {
    for (std::size_t first = 0; first < blocks.size(); first += kOrientationsAtOnce) {
        std::array<Moments, kOrientationsAtOnce> moments;
        std::array<Orientation, kOrientationsAtOnce> orientations;
        const std::size_t count = std::min(kOrientationsAtOnce, blocks.size() - first);
        for (std::size_t k = 0; k < count; ++k) {
            moments[k] = moments_of(side, blocks[first + k], references[first + k]);
        }
        orient(moments, orientations);
        for (std::size_t k = 0; k < count && fits_by_hull(options_->fit); ++k) {
            orient_by_hull(side, blocks[first + k], orientations[k]);
        }
        for (std::size_t k = 0; k < count; ++k) {
            fit_box(side, blocks[first + k], orientations[k]);
        }
    }
}

void SmallRanges::orient_by_hull(const Side& side, const Block& block, Orientation& orientation) {
    std::vector<Vec3> points;
    points.reserve(3 * std::size_t{block.ref.triangle_count()});
    for (std::uint32_t i = 0; i < block.ref.triangle_count(); ++i) {
        const Triangle t = mesh_->triangle(side.ids[block.at + i]);
        points.insert(points.end(), t.begin(), t.end());
    }
    const bool is_root = block.ref.triangle_count() == slots_->ids.size();
    orientation.rotation = hull_rotation(points, options_->fit, is_root);
    orientation.axes = axes_of(orientation.rotation);
}

// The smallest box of the given orientation. Its half extents are those of the exact coordinates
// along the stored axes, and what rounding may have lost.
void SmallRanges::fit_box(const Side& side, const Block& block, const Orientation& orientation) {
    const auto& axes = orientation.axes;
    const Vec3 origin{column(side, 0)[block.at], column(side, 1)[block.at],
                      column(side, 2)[block.at]};
    const double* first = column(side, 0) + block.at;
    std::array<double, 3> least{}, most{};
    in_registers([&]<std::size_t kBytes>() {
        using Reals = Doubles<kBytes>;
        std::array<Reals, 3> low, high; // zeros: the origin is a corner
        for (std::uint32_t i = 0; i < block.ref.triangle_count(); i += kWidth) {
            for (const auto& p : triangles_at<kBytes>(first + i, stride_, origin)) {
                for (std::size_t k = 0; k < 3; ++k) {
                    const Reals y =
                        Reals(axes[k].x) * p[0] + Reals(axes[k].y) * p[1] + Reals(axes[k].z) * p[2];
                    low[k] = lower(low[k], y);
                    high[k] = upper(high[k], y);
                }
            }
        }
        for (std::size_t k = 0; k < 3; ++k) {
            least[k] = lowest_of(low[k]);
            most[k] = highest_of(high[k]);
        }
    });
    Node& node = slots_->nodes[block.ref.slot];
    Vec3 center = origin;
    std::array<double, 3> half;
    for (std::size_t k = 0; k < 3; ++k) {
        center = center + (0.5 * (least[k] + most[k])) * axes[k];
        half[k] = 0.5 * (most[k] - least[k]);
    }
    const double margin = rounding_margin(half[0] + half[1] + half[2], center);
    node.center = center;
    for (std::size_t k = 0; k < 3; ++k) {
        node.half_extents[k] = rounded_up(half[k] + margin);
    }
    node.rotation = orientation.rotation;
    node.split = options_->is_leaf(block.ref) ? 0 : kUnsplit;
    ++box_count_;
}

void SmallRanges::split_loaded() {
    const std::array<Block, 2> children = split(loaded_);
    const Vec3 center = slots_->nodes[loaded_.ref.slot].center;
    std::array<Block, 2> boxes;
    std::size_t count = 0;
    for (const Block& child : children) {
        if (child.ref.is_triangle() || options_->is_leaf(child.ref)) {
            settle(to_, child);
        } else {
            std::copy_n(to_.ids.begin() + child.at, child.ref.triangle_count(),
                        slots_->ids.data() + child.ref.begin);
        }
        if (!child.ref.is_triangle()) {
            boxes[count++] = child;
        }
    }
    const std::array<Vec3, 2> references{center, center};
    fit(to_, {boxes.data(), count}, {references.data(), count});
}

// Level by level: boxes of one level are fitted several at once.
void SmallRanges::build_loaded() {
    blocks_.assign(1, loaded_);
    while (!blocks_.empty()) {
        next_.clear();
        references_.clear();
        filled_ = 0;
        for (const Block& block : blocks_) {
            const Node& node = slots_->nodes[block.ref.slot];
            if (options_->is_leaf(block.ref)) {
                settle(from_, block);
                continue;
            }
            if (block.ref.triangle_count() == 2) {
                split_two(block);
                continue;
            }
            for (const Block& child : split(block)) {
                if (child.ref.is_triangle()) {
                    settle(to_, child);
                } else {
                    next_.push_back(child);
                    references_.push_back(node.center);
                }
            }
        }
        fit(to_, next_, references_);
        std::swap(from_, to_);
        std::swap(blocks_, next_);
    }
}

// One on each side, whichever.
void SmallRanges::split_two(const Block& block) {
    Node& node = slots_->nodes[block.ref.slot];
    __atomic_store_n(&node.right, block.ref.slot + 1, __ATOMIC_RELAXED); // as split() says
    __atomic_store_n(&node.split, block.ref.begin + 1, __ATOMIC_RELAXED);
    settle(from_, block);
}

// Moves the triangles of a block to those of its children. Eberly 2008 §6.2.
std::array<SmallRanges::Block, 2> SmallRanges::split(const Block& block) {
    Node& node = slots_->nodes[block.ref.slot];
    const std::uint32_t split = block.ref.begin + part(block, node);
    const std::array<NodeRef, 2> refs = parted(block.ref, split);
    const std::uint32_t second = filled_ + whole_registers(refs[0].triangle_count());
    const std::array<Block, 2> children{{{refs[0], filled_}, {refs[1], second}}};
    filled_ = second + whole_registers(refs[1].triangle_count());
    move(block, children);
    // fetch_children() and is_leaf() may be reading them.
    __atomic_store_n(&node.right, refs[1].slot, __ATOMIC_RELAXED);
    __atomic_store_n(&node.split, split, __ATOMIC_RELAXED);
    return children;
}

void SmallRanges::move(const Block& block, const std::array<Block, 2>& children) {
    std::uint32_t left = children[0].at, right = children[1].at;
    for (std::uint32_t i = 0; i < block.ref.triangle_count(); ++i) {
        const std::uint32_t place = is_left_[i] != 0 ? left : right;
        left += is_left_[i];
        right += 1U - is_left_[i];
        const double* source = from_.coordinates.data() + block.at + i;
        double* target = to_.coordinates.data() + place;
        for (std::size_t k = 0; k < 9; ++k) {
            target[k * stride_] = source[k * stride_];
        }
        to_.ids[place] = from_.ids[block.at + i];
    }
    for (const Block& child : children) {
        pad(to_, child.at, child.ref.triangle_count());
    }
}

void SmallRanges::settle(const Side& side, const Block& block) {
    for (std::uint32_t i = 0; i < block.ref.triangle_count(); ++i) {
        slots_->settle(*mesh_, block.ref.begin + i, side.ids[block.at + i]);
    }
}

std::uint32_t SmallRanges::take_box_count() { return std::exchange(box_count_, 0); }

} // namespace obb
