// Pieces of a surface that hold what branch and bound over it asks about: boxes of the tree, its
// triangles, parts of triangles.
#pragma once

#include "overlap/solid_surface.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace obb {

// The convex hull of eight points; those of a triangle are its corners over and over.
using CellCorners = std::array<Vec3, 8>;

// A node of the tree, or a part of a triangle by the weights of the triangle's corners at its own.
struct SurfaceCell {
    NodeRef ref{};
    std::array<Vec3, 3> weights{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

    [[nodiscard]] bool is_box() const { return !ref.is_triangle(); }
};

// How far corners are off, as lengths of the frame. Those of a box hold the posed vertices for all
// that rounds; a corner of a part is a sum of three products with weights that sum to 1, off by 4 u
// a coordinate, and the posed corners by kPlaceError besides.
inline constexpr double kPieceError = 16 * kUnitRoundoff;

// What of the surface the hull holds, up to kPieceError.
[[nodiscard]] CellCorners corners_of(const SolidSurface& surface, const SurfaceCell& cell);

// The box that the corners of a box are those of.
[[nodiscard]] Obb grown_box(const SolidSurface& surface, const SurfaceCell& cell);

// The two halves of a part, or what is right under the node. Weights are halved exactly until parts
// are 2^-50 of the triangle: a part as small as that, which has the last digit, has no halves.
void split_cell(const SolidSurface& surface, const SurfaceCell& cell,
                std::vector<SurfaceCell>& parts);

} // namespace obb
