#include "overlap/column_body.hpp"

#include "numbers/scale.hpp"
#include "shapes/extremes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

namespace obb {

namespace {

void include(Bounds& bounds, const Bounds& more) {
    for (std::size_t k = 0; k < 3; ++k) {
        bounds.low[k] = smaller(bounds.low[k], more.low[k]);
        bounds.high[k] = larger(bounds.high[k], more.high[k]);
    }
}

[[nodiscard]] Bounds bounds_of(const Triangle& t) {
    Bounds bounds{t[0], t[0]};
    include(bounds, {t[1], t[1]});
    include(bounds, {t[2], t[2]});
    return bounds;
}

[[nodiscard]] bool is_within(const Bounds& inner, const Bounds& outer) {
    bool is_inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
        is_inside = is_inside && inner.low[k] >= outer.low[k] && inner.high[k] <= outer.high[k];
    }
    return is_inside;
}

} // namespace

int ColumnBody::exponent_for(const TreeView& tree, const Pose& pose) {
    // A translation of zero has no length to count.
    const double shift = norm_inf(pose.translation);
    const int exponent =
        shift > 0 ? std::max(tree.scale_exponent, exponent_of(shift)) : tree.scale_exponent;
    if (exponent > 1020 && !pose.is_identity()) {
        throw std::domain_error("posed coordinates would exceed the range of double (about 1e307)");
    }
    return exponent;
}

ColumnBody::ColumnBody(const TreeView& tree, const Pose& pose, int exponent)
    : body_(tree, pose), exponent_(exponent) {
    body_.set_frame(pose.rotation, scaled(pose.translation, -exponent), exponent);
}

Triangle ColumnBody::triangle(std::uint32_t position) const {
    Triangle t = body_.triangle({position, position + 1, 0, 0});
    for (Vec3& p : t) {
        p = scaled(p, -exponent_);
    }
    return t;
}

// No coordinate or translation exceeds 1 here: 2^-46 is 128 units of roundoff, and 8 covers the
// box's own defect of a few ulps, the posing of its centre and axes, and the rounding of the posed
// vertices. What is 2^-900 of the scene vanishes.
Bounds ColumnBody::around(const NodeRef& ref) const {
    constexpr double kMargin = 0x1p-46 * 8.0 + 0x1p-900;
    if (ref.is_triangle()) {
        return bounds_of(triangle(ref.begin));
    }
    const Obb box = body_.box(tree().node(ref));
    Bounds bounds{};
    for (std::size_t k = 0; k < 3; ++k) {
        double sum = kMargin;
        for (std::size_t i = 0; i < 3; ++i) {
            sum += box.half_extents[i] * std::fabs(box.axes[i][k]);
        }
        bounds.low[k] = box.center[k] - sum;
        bounds.high[k] = box.center[k] + sum;
    }
    return bounds;
}

// Looks into nodes that go beyond what was found so far. Along large flat faces these are all, as
// boxes have a margin: after so many looks the boxes themselves have to do.
Bounds ColumnBody::extent() const {
    constexpr std::size_t kLooks = 1 << 13;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Bounds found{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    std::vector<NodeRef> stack{tree().root()};
    for (std::size_t looks = 0; !stack.empty(); ++looks) {
        const NodeRef ref = stack.back();
        stack.pop_back();
        const Bounds bounds = around(ref);
        if (is_within(bounds, found)) {
            continue;
        }
        if (ref.is_triangle() || looks > kLooks) {
            include(found, bounds);
            continue;
        }
        const auto parts = parts_of(tree(), ref);
        stack.insert(stack.end(), {parts[1], parts[0]});
    }
    return found;
}

std::array<NodeRef, 2> parts_of(const TreeView& tree, const NodeRef& ref) {
    tree.prepare(ref);
    const Node& node = tree.node(ref);
    if (!TreeView::is_leaf(node)) {
        return tree.children(ref, node);
    }
    const std::uint32_t middle = ref.begin + ref.triangle_count() / 2;
    return {{{ref.begin, middle, ref.slot, ref.depth}, {middle, ref.end, ref.slot, ref.depth}}};
}

} // namespace obb
