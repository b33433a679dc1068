// Between which heights does no surface come over a shadow? What an escape row needs.
#pragma once

#include "overlap/solid_surface.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace obb {

// An upright prism over a convex shadow: heights run along `up`, places are pairs of numbers along
// `across`. The three are of length 1 and at right angles, both to 16 u. The shadow is what of a
// rectangle, a range along each of `across`, is on the inner side of all `sides`.
struct Prism {
    // The places with v * place[0] + w * place[1] <= limit; (v, w) is at most 1 long, to 4 u.
    struct Side {
        double v, w, limit;
    };
    static constexpr std::size_t kMostSides = 8;

    Vec3 up;
    std::array<Vec3, 2> across;
    std::array<double, 2> low, high;
    std::array<Side, kMostSides> sides;
    std::size_t side_count = 0;
};

// No point of the surface over the shadow has a height between these two: the surface of the
// posed vertices, over the shadow grown by 64 u, with everything that rounds on the safe side.
struct HeightGap {
    double from, to;
    NodeRef under; // a triangle that is highest below, or one of a box that is
};

class HeightSearch {
  public:
    // The surface must outlive it.
    explicit HeightSearch(const SolidSurface& surface) : surface_(&surface) {}

    // The gaps between `floor` and `ceiling`, lowest first; heights up to `floor` and from
    // `ceiling` count as if the surface were there, and so does all below what begins below
    // `filled`: gaps are asked for above only. Boxes at most `thin` high are taken whole, and
    // so is what is left after `most` of them: gaps are then fewer or narrower, never wrong.
    [[nodiscard]] std::span<const HeightGap> find(const Prism& prism, double floor, double ceiling,
                                                  double thin, std::size_t most,
                                                  double filled = -HUGE_VAL);
    // Of the gaps found last, the highest that begins at a height or below.
    [[nodiscard]] NodeRef under(double height) const;

  private:
    struct Span {
        double low, high;
        NodeRef top{0, 1, 0, 0};
        double flatness = 0; // of that triangle: how much of its normal is upright
    };
    [[nodiscard]] static Span span_of(const Triangle& t, const Prism& prism);
    [[nodiscard]] static double flatness_of(const Triangle& t, const Vec3& up);
    [[nodiscard]] Span span_of(const Obb& box, const Prism& prism) const;
    [[nodiscard]] bool is_settled(const Span& span) const;
    void take(Span span);

    struct Open {
        NodeRef ref;
        Span span;
    };
    void push(const NodeRef& ref, const Prism& prism);
    void look_at(const NodeRef& ref, const Prism& prism);
    void open_up(const Open& open, const Prism& prism, double thin, bool is_whole);

    const SolidSurface* surface_;
    double filled_ = -HUGE_VAL;
    std::vector<Open> stack_;
    std::vector<Span> taken_; // apart from each other, ascending
    std::vector<HeightGap> gaps_;
};

} // namespace obb
