#include "overlap/height_gaps.hpp"

#include "shapes/extremes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace obb {

namespace {

// No coordinate exceeds 2 here, u = 2^-53. Heights and places across are products of three terms,
// off by 3 u sqrt(3) 2 < 12 u, and posed corners by 2 u more. Where an edge leaves the shadow it is
// cut at t = (limit - a) / (b - a), of products a and b with a side that are off by 8 u more: the
// parts of the quotient are off by 36 u and 2 u, so that the place of the cut, t (b - a), is off by
// less than 48 u, whatever the edge's slope. The corner made there is off its edge by 8 u, and
// those of twelve cuts one after the other by less than 96 u, in place and height. A shadow grown
// by 256 u, 64 u of which are promised, and heights grown by 128 u are therefore safe.
constexpr double kAcross = 256 * kUnitRoundoff;
constexpr double kUp = 128 * kUnitRoundoff;

struct Corner {
    std::array<double, 2> across;
    double height;
};

// A triangle cut by twelve lines has at most fifteen corners.
struct Polygon {
    std::array<Corner, 16> corners;
    std::size_t count = 0;
};

// What of a polygon is on the inner side.
void cut(Polygon& polygon, const Prism::Side& side) {
    std::array<double, 16> places;
    bool is_cut = false;
    for (std::size_t k = 0; k < polygon.count; ++k) {
        const auto& across = polygon.corners[k].across;
        places[k] = side.v * across[0] + side.w * across[1];
        is_cut = is_cut || !(places[k] <= side.limit);
    }
    if (!is_cut) {
        return;
    }
    Polygon rest;
    for (std::size_t k = 0; k < polygon.count; ++k) {
        const std::size_t next = k + 1 < polygon.count ? k + 1 : 0;
        const Corner& p = polygon.corners[k];
        const Corner& q = polygon.corners[next];
        const double a = places[k], b = places[next];
        if (a <= side.limit && rest.count < rest.corners.size()) {
            rest.corners[rest.count++] = p;
        }
        if ((a <= side.limit) != (b <= side.limit) && rest.count < rest.corners.size()) {
            const double t = std::clamp((side.limit - a) / (b - a), 0.0, 1.0);
            Corner& r = rest.corners[rest.count++];
            for (std::size_t i = 0; i < 2; ++i) {
                r.across[i] = p.across[i] + t * (q.across[i] - p.across[i]);
            }
            r.height = p.height + t * (q.height - p.height);
        }
    }
    polygon = rest;
}

} // namespace

// Where in height the surface of a triangle may be over the shadow; low above high for nowhere.
HeightSearch::Span HeightSearch::span_of(const Triangle& t, const Prism& prism) {
    Polygon polygon;
    polygon.count = 3;
    Span whole{HUGE_VAL, -HUGE_VAL};
    for (std::size_t k = 0; k < 3; ++k) {
        Corner& c = polygon.corners[k];
        c = {{dot(prism.across[0], t[k]), dot(prism.across[1], t[k])}, dot(prism.up, t[k])};
    }
    cut(polygon, {1, 0, prism.high[0] + kAcross});
    cut(polygon, {-1, 0, kAcross - prism.low[0]});
    cut(polygon, {0, 1, prism.high[1] + kAcross});
    cut(polygon, {0, -1, kAcross - prism.low[1]});
    for (std::size_t k = 0; k < prism.side_count && polygon.count > 0; ++k) {
        const Prism::Side& side = prism.sides[k];
        cut(polygon, {side.v, side.w, side.limit + kAcross});
    }
    for (std::size_t k = 0; k < polygon.count; ++k) {
        whole.low = smaller(whole.low, polygon.corners[k].height - kUp);
        whole.high = larger(whole.high, polygon.corners[k].height + kUp);
    }
    return whole;
}

double HeightSearch::flatness_of(const Triangle& t, const Vec3& up) {
    const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
    const double length = norm(normal);
    return length > 0 ? std::fabs(dot(normal, up)) / length : 0;
}

// The same of what a box holds. A NaN is everywhere.
HeightSearch::Span HeightSearch::span_of(const Obb& box, const Prism& prism) const {
    const auto radius = [&](const Vec3& along) {
        double sum = surface_->blur() + kUp;
        for (std::size_t i = 0; i < 3; ++i) {
            sum += box.half_extents[i] * std::fabs(dot(along, box.axes[i]));
        }
        return sum;
    };
    for (std::size_t i = 0; i < 2; ++i) {
        const double place = dot(prism.across[i], box.center);
        const double reach = radius(prism.across[i]) + kAcross;
        if (place - reach > prism.high[i] || place + reach < prism.low[i]) {
            return {HUGE_VAL, -HUGE_VAL};
        }
    }
    for (std::size_t k = 0; k < prism.side_count; ++k) {
        const Prism::Side& side = prism.sides[k];
        const Vec3 along = side.v * prism.across[0] + side.w * prism.across[1];
        if (dot(along, box.center) - radius(along) - kAcross > side.limit) {
            return {HUGE_VAL, -HUGE_VAL};
        }
    }
    const double height = dot(prism.up, box.center), reach = radius(prism.up);
    if (!(reach < HUGE_VAL && std::fabs(height) < HUGE_VAL)) {
        return {-HUGE_VAL, HUGE_VAL};
    }
    return {height - reach, height + reach};
}

void HeightSearch::take(Span span) {
    if (span.low < filled_) {
        span.low = -HUGE_VAL;
    }
    const auto first = std::lower_bound(taken_.begin(), taken_.end(), span.low,
                                        [](const Span& s, double low) { return s.high < low; });
    auto last = first;
    for (; last != taken_.end() && last->low <= span.high; ++last) {
        span.low = smaller(span.low, last->low);
        // Where an edge is highest, the flatter triangle tells more.
        if (last->high > span.high + kUp ||
            (last->high >= span.high - kUp && last->flatness > span.flatness)) {
            span.top = last->top;
            span.flatness = last->flatness;
        }
        span.high = larger(span.high, last->high);
    }
    if (first == last) {
        taken_.insert(first, span);
    } else {
        *first = span;
        taken_.erase(first + 1, last);
    }
}

// Whether it is of no concern what is at these heights: nothing is, or something is taken to be.
bool HeightSearch::is_settled(const Span& span) const {
    if (span.low > span.high || span.high <= taken_.front().high) {
        return true;
    }
    const auto above = std::lower_bound(taken_.begin(), taken_.end(), span.low,
                                        [](const Span& s, double low) { return s.high < low; });
    return above != taken_.end() && above->low <= span.low && span.high <= above->high;
}

// What is highest comes first: with all below it filled, most of the rest is settled then.
std::span<const HeightGap> HeightSearch::find(const Prism& prism, double floor, double ceiling,
                                              double thin, std::size_t most, double filled) {
    taken_.clear();
    gaps_.clear();
    filled_ = filled;
    take({-HUGE_VAL, floor, {0, 1, 0, 0}, 0});
    take({ceiling, HUGE_VAL, {0, 1, 0, 0}, 0});
    stack_.clear();
    push(surface_->tree().root(), prism);
    for (std::size_t count = 0; !stack_.empty() && taken_.size() > 1; ++count) {
        const Open open = stack_.back();
        stack_.pop_back();
        if (!is_settled(open.span)) {
            open_up(open, prism, thin, count >= most);
        }
    }
    for (std::size_t k = 0; k + 1 < taken_.size(); ++k) {
        gaps_.push_back({taken_[k].high, taken_[k + 1].low, taken_[k].top});
    }
    return gaps_;
}

void HeightSearch::push(const NodeRef& ref, const Prism& prism) {
    if (ref.is_triangle()) {
        look_at(ref, prism);
        return;
    }
    const Span span = span_of(surface_->box(ref), prism);
    if (!is_settled(span)) {
        stack_.push_back({ref, span});
    }
}

void HeightSearch::look_at(const NodeRef& ref, const Prism& prism) {
    const Triangle t = surface_->triangle(ref);
    if (const Span span = span_of(t, prism); !is_settled(span)) {
        take({span.low, span.high, ref, flatness_of(t, prism.up)});
    }
}

void HeightSearch::open_up(const Open& open, const Prism& prism, double thin, bool is_whole) {
    const TreeView& tree = surface_->tree();
    const NodeRef& ref = open.ref;
    if (is_whole || open.span.high - open.span.low <= thin) {
        tree.prepare_triangles(ref, 1);
        take({open.span.low, open.span.high, {ref.begin, ref.begin + 1, ref.slot, ref.depth}, 1});
        return;
    }
    const Node& node = tree.node(ref);
    tree.prepare(ref);
    if (TreeView::is_leaf(node)) {
        for (std::uint32_t k = ref.begin; k < ref.end; ++k) {
            look_at(TreeView::triangle_ref(ref, k), prism);
        }
        return;
    }
    for (const NodeRef& child : tree.children(ref, node)) {
        push(child, prism);
    }
    if (const std::size_t size = stack_.size();
        size > 1 && stack_[size - 1].span.high < stack_[size - 2].span.high) {
        std::swap(stack_[size - 1], stack_[size - 2]);
    }
}

NodeRef HeightSearch::under(double height) const {
    NodeRef found{0, 1, 0, 0};
    for (const HeightGap& gap : gaps_) {
        found = gap.from <= height ? gap.under : found;
    }
    return found;
}

} // namespace obb
