#include "tree/tree_check.hpp"

#include "numbers/scale.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

std::string at(const char* fault, const NodeRef& ref) {
    return std::string(fault) + " (box " + std::to_string(ref.slot) + ", triangles " +
           std::to_string(ref.begin) + " to " + std::to_string(ref.end) + ")";
}

bool is_sound(const Node& node) {
    bool sound = is_finite(node.center) && node.reserved == 0;
    for (const float extent : node.half_extents) {
        sound = sound && std::isfinite(extent) && extent >= 0;
    }
    float length = 0;
    for (const float q : node.rotation) {
        length += q * q;
    }
    // Shorter or longer quaternions lose digits in axes_of().
    return sound && length > 0.25f && length < 64.0f;
}

bool is_finite(const Triangle& triangle) {
    return std::ranges::all_of(triangle, [](Vec3 v) { return is_finite(v); });
}

// |A_i . (x - c)| with its rounding error and the axes' defect of a few ulps added.
bool contains(const Node& node, const Triangle& triangle, int scale_exponent) {
    constexpr double kMargin = 0x1p-47;
    const auto axes = axes_of(node.rotation);
    const Vec3 h = half_extents_of(node);
    for (const Vec3& vertex : triangle) {
        const Vec3 p = scaled(vertex, -scale_exponent) - node.center;
        for (std::size_t k = 0; k < 3; ++k) {
            if (!(std::fabs(dot(axes[k], p)) + kMargin * norm_1(p) <= h[k])) {
                return false;
            }
        }
    }
    return true;
}

std::optional<std::string> check_ids(const TreeView& tree) {
    std::vector<bool> seen(tree.triangle_count(), false);
    for (const std::uint32_t id : tree.triangle_ids) {
        if (id >= seen.size() || seen[id]) {
            return "triangle id " + std::to_string(id) + " is out of range or stands twice";
        }
        seen[id] = true;
    }
    return std::nullopt;
}

} // namespace

std::optional<std::string> tree_check(const TreeView& tree, std::uint32_t leaf_size,
                                      std::uint32_t max_depth) try {
    if (tree.triangle_count() == 0 || tree.triangle_ids.size() != tree.corners.size()) {
        return "the arrays do not belong together";
    }
    if (auto fault = check_ids(tree)) {
        return fault;
    }
    std::vector<NodeRef> stack;
    if (tree.triangle_count() > 1) {
        stack.push_back(tree.root());
    } else if (!is_finite(tree.triangle(0))) { // which no box holds
        return "a vertex is not made of usable numbers";
    }
    std::uint32_t next_slot = 0;
    while (!stack.empty()) {
        const NodeRef ref = stack.back();
        stack.pop_back();
        if (ref.slot != next_slot++) {
            return at("a box is not where depth-first order has it", ref);
        }
        const Node& node = tree.node(ref);
        if (!is_sound(node)) {
            return at("a box is not made of usable numbers", ref);
        }
        for (std::uint32_t i = ref.begin; i < ref.end; ++i) {
            if (!contains(node, tree.triangle(i), tree.scale_exponent)) {
                return at("a box does not contain its triangles", ref);
            }
        }
        const bool must_be_leaf = ref.triangle_count() <= leaf_size || ref.depth >= max_depth;
        if (TreeView::is_leaf(node) != must_be_leaf) {
            return at("a leaf contradicts the leaf size or the depth limit", ref);
        }
        if (TreeView::is_leaf(node)) {
            continue;
        }
        const auto [left, right] = tree.children(ref, node);
        for (const NodeRef& child : {right, left}) {
            if (!child.is_triangle()) {
                stack.push_back(child);
            }
        }
    }
    if (next_slot != tree.nodes.size()) {
        return "there are more boxes than the tree reaches";
    }
    return std::nullopt;
} catch (const TreeError& fault) {
    return std::string(fault.what());
}

std::vector<Level> tree_levels(const TreeView& tree) {
    std::vector<Level> levels;
    std::vector<NodeRef> stack{tree.root()};
    while (!stack.empty()) {
        const NodeRef ref = stack.back();
        stack.pop_back();
        if (ref.depth >= levels.size()) {
            levels.resize(ref.depth + 1);
        }
        Level& level = levels[ref.depth];
        if (ref.is_triangle()) {
            ++level.leaf_count;
            continue;
        }
        const Node& node = tree.node(ref);
        const Vec3 h = half_extents_of(node);
        ++level.box_count;
        level.volume += 8.0 * h.x * h.y * h.z;
        if (TreeView::is_leaf(node)) {
            ++level.leaf_count;
            continue;
        }
        for (const NodeRef& child : tree.children(ref, node)) {
            stack.push_back(child);
        }
    }
    return levels;
}

} // namespace obb
