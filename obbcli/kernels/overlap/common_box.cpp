#include "overlap/common_box.hpp"

#include "fit/fit.hpp"
#include "overlap/triangles_in_box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace obb {

namespace {

struct Interval {
    double low, high;
};

// The range of a surface, and with it of the solid, along a direction of length 1. What sticks out
// of the box by the blur along each of its axes does so by less than twice the blur along any
// other. The pad covers rounding, and that products with axes which are orthonormal to a few u are
// not quite the local coordinates of a CellBox.
[[nodiscard]] Interval extent_along(const SolidSurface& surface, const Vec3& direction) {
    const NodeRef root = surface.tree().root();
    double reach = 2 * surface.blur() + kCellPad;
    if (root.is_triangle()) {
        const Triangle t = surface.triangle(root);
        const auto [low, high] =
            std::minmax({dot(direction, t[0]), dot(direction, t[1]), dot(direction, t[2])});
        return {low - reach, high + reach};
    }
    const Obb box = surface.box(root);
    const double middle = dot(direction, box.center);
    for (std::size_t i = 0; i < 3; ++i) {
        reach += box.half_extents[i] * std::fabs(dot(direction, box.axes[i]));
    }
    return {middle - reach, middle + reach};
}

// The common box in given axes.
[[nodiscard]] std::optional<CellBox> box_in(const std::array<Vec3, 3>& axes, const SolidSurface& a,
                                            const SolidSurface& b) {
    CellBox box{axes, {}, {}};
    for (std::size_t j = 0; j < 3; ++j) {
        const Interval of_a = extent_along(a, axes[j]), of_b = extent_along(b, axes[j]);
        box.low[j] = std::max(of_a.low, of_b.low);
        box.high[j] = std::min(of_a.high, of_b.high);
        if (!(box.low[j] <= box.high[j])) {
            return std::nullopt;
        }
    }
    return box;
}

// Adds area n n^T of the surface in a box, by a triangle from each of up to a few hundred parts.
class NormalSum {
  public:
    explicit NormalSum(const Obb& box) : box_(box) {}

    void add(const SolidSurface& surface) {
        constexpr std::size_t kParts = 256;
        const TreeView& tree = surface.tree();
        std::vector<NodeRef> parts{tree.root()}, halves;
        for (bool is_split = true; is_split;) {
            is_split = false;
            halves.clear();
            for (const NodeRef& ref : parts) {
                if (parts.size() >= kParts || ref.is_triangle() ||
                    TreeView::is_leaf(tree.node(ref)) || !is_near(surface, ref)) {
                    halves.push_back(ref);
                    continue;
                }
                const auto children = tree.children(ref, tree.node(ref));
                halves.insert(halves.end(), {children[0], children[1]});
                is_split = true;
            }
            parts.swap(halves);
        }
        for (const NodeRef& part : parts) {
            if (is_near(surface, part)) {
                tree.prepare_triangles(part, 1);
                take(surface.triangle({part.begin, part.begin + 1, part.slot, part.depth}),
                     part.triangle_count());
            }
        }
    }

    [[nodiscard]] const Moments& moments() const { return moments_; }

    // Axes along which as much of the surface as can be lies flat: one normal, and another one made
    // perpendicular to it.
    [[nodiscard]] std::array<Vec3, 3> peaks() const {
        std::array<Vec3, 3> axes = CellBox{}.axes;
        axes[0] = best([](const Vec3& n) { return n; }, axes[0]);
        const auto upright = [&](const Vec3& n) { return n - dot(n, axes[0]) * axes[0]; };
        const Vec3 a = abs(axes[0]);
        const Vec3 any = a.x <= a.y && a.x <= a.z ? Vec3{1, 0, 0}
                         : a.y <= a.z             ? Vec3{0, 1, 0}
                                                  : Vec3{0, 0, 1};
        axes[1] = best(upright, unit_or(upright(any), any));
        axes[2] = cross(axes[0], axes[1]);
        return axes;
    }

  private:
    [[nodiscard]] bool is_near(const SolidSurface& surface, const NodeRef& ref) const {
        constexpr double kPad = 0x1p-30; // no proof depends on it
        if (ref.is_triangle()) {
            return may_meet(box_, surface.triangle(ref), kPad);
        }
        const Obb box = surface.box(ref);
        const Vec3 d = box.center - box_.center;
        double reach = kPad, size = norm(box_.half_extents);
        for (std::size_t i = 0; i < 3; ++i) {
            reach += box.half_extents[i] * norm(box.axes[i]);
        }
        return norm(d) <= reach + size;
    }

    // Of some of the normals, changed, the direction that most of the surface has about for normal.
    template <typename Change>
    [[nodiscard]] Vec3 best(const Change& change, const Vec3& otherwise) const {
        constexpr std::size_t kTried = 48;
        const std::size_t step = normals_.size() / kTried + 1;
        Vec3 found = otherwise;
        double most = 0;
        for (std::size_t i = 0; i < normals_.size(); i += step) {
            const Vec3 changed = change(normals_[i].unit);
            if (!(norm(changed) > 0.5)) {
                continue;
            }
            const Vec3 tried = unit_or(changed, otherwise);
            double sum = 0;
            for (std::size_t k = 0; k < normals_.size(); k += step) {
                const double c = dot(tried, normals_[k].unit), c2 = c * c, c4 = c2 * c2;
                sum += normals_[k].weight * c4 * c4 * c4;
            }
            if (sum > most) {
                most = sum;
                found = tried;
            }
        }
        return found;
    }

    void take(const Triangle& t, double count) {
        const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
        const double length = norm(n);
        if (!(length > 0) || !std::isfinite(length)) {
            return;
        }
        const Vec3 unit = (1 / length) * n;
        const double weight = length * count;
        moments_.weight += weight;
        normals_.push_back({unit, weight});
        std::size_t k = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = i; j < 3; ++j) {
                moments_.second[k++] += weight * unit[i] * unit[j];
            }
        }
    }

    struct Normal {
        Vec3 unit;
        double weight;
    };

    Obb box_;
    Moments moments_{};
    std::vector<Normal> normals_;
};

} // namespace

std::optional<CellBox> common_box(const SolidSurface& a, const SolidSurface& b) {
    const std::optional<CellBox> upright = box_in(CellBox{}.axes, a, b);
    if (!upright) {
        return std::nullopt;
    }
    NormalSum sum(upright->obb());
    sum.add(a);
    sum.add(b);
    if (!(sum.moments().weight > 0)) {
        return upright;
    }
    constexpr double kPreferred = 1.25; // times as large will do
    const std::optional<CellBox> by_peaks = box_in(sum.peaks(), a, b);
    const std::optional<CellBox> by_moments = box_in(principal_axes(sum.moments()), a, b);
    if (!by_peaks || !by_moments) {
        return std::nullopt;
    }
    return by_peaks->volume() <= kPreferred * by_moments->volume() ? by_peaks : by_moments;
}

} // namespace obb
