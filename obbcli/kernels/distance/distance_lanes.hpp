// Lower bounds on distances, four pairs at once: of boxes for pruning, of triangles so that few are
// measured.
#pragma once

#include "descent/box_tests.hpp"
#include "shapes/lanes.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

#include <array>

namespace obb {

// Of four pairs of boxes: squares of lower bounds on their distance, as distance_square(), and the
// squares of how far apart their centers are.
struct BoxGaps {
    std::array<double, 4> squares;
    std::array<double, 4> center_squares;
};

// Two boxes of A, then two of B, as place_boxes() leaves them; gap k is that of A's k % 2 and B's
// kSecond[k].
inline constexpr std::array<std::size_t, 4> kSecond{0, 1, 1, 0};
[[nodiscard]] BoxGaps box_gaps(const BasicObb<Four>& boxes, const RoundingBound& bound);

// Four pairs of triangles with coordinates of at most about 1, each rounded by at most 2^-1000.
using TriangleLanes = std::array<const Triangle*, 4>;
using Gaps = std::array<double, 4>;

// Proven lower bounds: between the bounding boxes and along both normals.
[[nodiscard]] Gaps quick_gaps(const TriangleLanes& a, const TriangleLanes& b);
// Along the direction between the nearest points of edges. With the normals that is about the
// distance, for a corner is nearest a face along the face's normal.
[[nodiscard]] Gaps edge_gaps(const TriangleLanes& a, const TriangleLanes& b);

} // namespace obb
