// The shadow of one triangle cut down to that of another, with what rounding may have moved.
#pragma once

#include "overlap/shadow.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace obb {

// A closed polygon in the coordinates of a pair: from the first corner of the triangle that is cut.
struct ClippedShadow {
    static constexpr std::size_t kMost = 12;

    std::array<double, kMost> u, v;
    std::size_t count = 0;
    // Rounding changed at most so much of its area: times u D l, as explained below.
    double slack = 0;
    bool is_too_large = false; // more corners than there is room for; coordinates that are none
};

// Sutherland and Hodgman 1974, Reentrant polygon clipping: a polygon Q is cut by half-planes one
// after the other. What of it is proven, with u the unit roundoff, D the largest distance in play
// (two points of the two shadows are at most D apart, as the rectangles around them meet) and l the
// diameter of the triangle that is cut, within the window:
//
// - Coordinates. v - a is rounded once, so that corners move by at most u D. What a triangle gains
//   or loses lies within u D of its three edges: an area of at most 2 u D l an edge, 12 u D l for
//   both triangles.
// - One cut. Let L be the distance from the cutting line, negative outside, and suppose that its
//   values at the corners of Q are known to within e. New corners are put where the values as known
//   vanish, so that |L| <= e there (L is linear along an edge). Each run of corners outside is
//   replaced by a straight line: what is taken away is a closed polygon with L <= e all over, what
//   remains is one with L >= -e. With w the winding numbers of Q, those of the result are w where
//   L > e and 0 where L < -e, as a polygon does not wind about points outside its convex hull.
//   This needs neither that Q is convex nor that it is cut in two. In the strip between, winding
//   numbers are off by at most 3/4 n for n corners: polygons of m corners wind about no point more
//   than m / 2 times, and those taken away have at most 3/2 n corners together. The strip covers at
//   most 2 e l of what is left in the end.
//   An edge's value is a cross product of rounded differences: each of its two products is off by
//   3 u of itself, the difference by u of their sizes: |L| is known to 4.01 u D (Cauchy-Schwarz).
//   For the window's sides it is known to 2.01 u D, for they are rounded into these coordinates.
//   So a cut costs 2 * 4.01 * 3/4 n < 6.1 n, taken as 8 n, times u D l, and nothing where all
//   values exceed what they may be off by.
// - New corners. q + t (r - q), where t is off by 2.01 u of itself: the corner moves by at most
//   5.1 u D. That changes winding numbers by 1 within two triangles of this width: 5.1 u D l.
// - Errors of one cut that a later one takes away do not count, those that it keeps count once:
//   w_n - w_0 1_1 ... 1_n is the sum over k of (w_k - w_(k-1) 1_k) 1_(k+1) ... 1_n.
class ShadowClip {
  public:
    // What is kept of `subject`: the part in the shadow of `other` and in the window. Both have
    // shadows whose rectangles meet.
    ShadowClip(const Shadow& subject, const Shadow& other);

    // Whether the shadows are proven to share no area: a line along an edge parts them.
    [[nodiscard]] bool are_apart() const;
    // Cuts; not where they are apart.
    void cut(const ColumnWindow& window);

    [[nodiscard]] const ClippedShadow& kept() const { return kept_; }
    // u D, of which the proven errors are multiples.
    [[nodiscard]] double unit() const { return unit_; }

    // Corners in the coordinates of the pair.
    std::array<double, 3> subject_u, subject_v, other_u, other_v;

  private:
    struct Edge {
        double from_u, from_v, along_u, along_v;
        double doubt; // of which multiples bound what its values may be off by: u D of its length
    };
    [[nodiscard]] Edge edge_of(const Shadow& shadow, const std::array<double, 3>& u,
                               const std::array<double, 3>& v, std::size_t k) const;
    [[nodiscard]] bool is_beyond_edge(const Shadow& shadow, const std::array<double, 3>& u,
                                      const std::array<double, 3>& v, const Shadow& theirs,
                                      const std::array<double, 3>& their_u,
                                      const std::array<double, 3>& their_v) const;
    // Twice the area of the triangle over an edge: positive inside.
    [[nodiscard]] static double side(const Edge& e, double u, double v) {
        return e.along_u * (v - e.from_v) - e.along_v * (u - e.from_u);
    }
    void cut_along(const std::array<double, ClippedShadow::kMost>& sides, double doubt);
    void cut_at(double limit, bool is_u, bool is_low);

    const Shadow& subject_;
    const Shadow& other_;
    double unit_;
    ClippedShadow kept_;
};

} // namespace obb
