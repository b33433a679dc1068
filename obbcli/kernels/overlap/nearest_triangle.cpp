#include "overlap/nearest_triangle.hpp"

#include "overlap/point_triangle.hpp"
#include "shapes/extremes.hpp"

#include <algorithm>
#include <cmath>

namespace obb {

namespace {

// Ranges of so many triangles are looked at without their boxes.
constexpr std::uint32_t kTogether = 4;

// For a point x = sum y_j axes_j of the box, |y_j| <= h_j, and p the point, both less the centre,
// |axis_i . (p - x)| >= |axis_i . p| - h_i - skew * (sum of h): products of axes differ from 0 and
// 1 by the skew at most. The sum of the squares of the left sides is at most (1 + 3 skew) times the
// square of |p - x|. What is in the box may stick out by the blur, which covers rounding too.
[[nodiscard]] double least_distance(const Obb& box, const Vec3& point, double blur, double skew) {
    const Vec3 d = point - box.center;
    const Vec3& h = box.half_extents;
    const double lost = blur + skew * (h.x + h.y + h.z);
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double gap = larger(std::fabs(dot(box.axes[i], d)) - h[i] - lost, 0.0);
        square += gap * gap;
    }
    return std::sqrt(square) * (1 - 2 * skew);
}

} // namespace

PointDistance NearestSearch::find(const Vec3& point, double slack, std::span<const NodeRef> hints,
                                  double enough) {
    begin(point, slack);
    for (const NodeRef& hint : hints) {
        measure_range(hint.begin, hint.end, hint.slot);
    }
    descend(surface_->tree().root(), enough);
    return best_;
}

PointDistance NearestSearch::find_under(const NodeRef& node, const Vec3& point, double slack) {
    begin(point, slack);
    descend(node, 0);
    return best_;
}

void NearestSearch::begin(const Vec3& point, double slack) {
    point_ = point;
    slack_ = slack;
    limit_ = low_ = HUGE_VAL;
    best_ = {};
}

void NearestSearch::descend(const NodeRef& from, double enough) {
    stack_.clear();
    push(from);
    while (!stack_.empty() && !(best_.high < enough)) {
        const Open open = stack_.back();
        stack_.pop_back();
        if (open.low >= limit_) {
            low_ = smaller(low_, open.low);
        } else {
            open_up(open.ref);
        }
    }
    const bool is_found = stack_.empty() && best_.high < HUGE_VAL; // not where all is NaN
    best_.low = is_found ? smaller(low_, best_.high) : 0;
}

void NearestSearch::open_up(const NodeRef& ref) {
    const TreeView& tree = surface_->tree();
    if (ref.triangle_count() <= kTogether) {
        tree.prepare_triangles(ref, ref.triangle_count());
        measure_range(ref.begin, ref.end, ref.slot);
        return;
    }
    const Node& node = tree.node(ref);
    tree.prepare(ref);
    if (TreeView::is_leaf(node)) {
        measure_range(ref.begin, ref.end, ref.slot);
        return;
    }
    const auto children = tree.children(ref, node);
    push(children[0]);
    push(children[1]);
    // The nearer of the two is next.
    if (const std::size_t top = stack_.size() - 1; stack_[top].low > stack_[top - 1].low) {
        std::swap(stack_[top], stack_[top - 1]);
    }
}

// A box that is a NaN anywhere has no least distance, which is never far enough.
void NearestSearch::push(const NodeRef& ref) {
    double low = 0;
    if (!ref.is_triangle()) {
        low = least_distance(surface_->box(ref), point_, surface_->blur(), surface_->skew());
    }
    stack_.push_back({ref, low});
}

void NearestSearch::measure_range(std::uint32_t begin, std::uint32_t end, std::uint32_t slot) {
    for (std::uint32_t first = begin; first < end; first += kTogether) {
        const std::uint32_t count = std::min(kTogether, end - first);
        triangle_tests_ += count;
        FourTriangles placed;
        surface_->place_triangles(first, count, placed);
        std::array<double, 4> lows, highs;
        std::array<std::array<double, 4>, 3> ways;
        in_registers([&]<std::size_t kBytes>() {
            using Real = Doubles<kBytes>;
            LaneTriangles<Real> corners;
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t k = 0; k < 3; ++k) {
                    corners[i][k] = Real::at(placed[i][k].data()) - Real(point_[k]);
                }
            }
            const LaneFeet<Real> feet = lane_feet(corners);
            feet.low.store(lows.data());
            feet.high.store(highs.data());
            for (std::size_t k = 0; k < 3; ++k) {
                feet.way[k].store(ways[k].data());
            }
        });
        for (std::uint32_t k = 0; k < count; ++k) {
            low_ = smaller(low_, lows[k]);
            if (highs[k] < best_.high) {
                best_.high = highs[k];
                best_.triangle = {first + k, first + k + 1, slot, 0};
                best_.foot = point_ + Vec3{ways[0][k], ways[1][k], ways[2][k]};
                limit_ = highs[k] * (1 - slack_);
            }
        }
    }
}

} // namespace obb
