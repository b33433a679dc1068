#include "overlap/surface_cell.hpp"

#include "shapes/extremes.hpp"

#include <cmath>

namespace obb {

Obb grown_box(const SolidSurface& surface, const SurfaceCell& cell) {
    Obb box = surface.box(cell.ref);
    const double more = 2 * surface.blur();
    box.half_extents = box.half_extents + Vec3{more, more, more};
    return box;
}

CellCorners corners_of(const SolidSurface& surface, const SurfaceCell& cell) {
    CellCorners corners;
    if (cell.is_box()) {
        const Obb box = grown_box(surface, cell);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            corners[k] = box.center;
            for (std::size_t i = 0; i < 3; ++i) {
                const double way = (k >> i & 1U) != 0 ? box.half_extents[i] : -box.half_extents[i];
                corners[k] = corners[k] + way * box.axes[i];
            }
        }
        return corners;
    }
    const Triangle t = surface.triangle(cell.ref);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3& w = cell.weights[k % 3];
        corners[k] = w.x * t[0] + (w.y * t[1] + w.z * t[2]);
    }
    return corners;
}

void split_cell(const SolidSurface& surface, const SurfaceCell& cell,
                std::vector<SurfaceCell>& parts) {
    const TreeView& tree = surface.tree();
    if (cell.is_box()) {
        const Node& node = tree.node(cell.ref);
        tree.prepare(cell.ref);
        if (!TreeView::is_leaf(node)) {
            for (const NodeRef& child : tree.children(cell.ref, node)) {
                parts.push_back({child});
            }
            return;
        }
        // Leaves may hold whole meshes: of a large one, either half of its triangles is in its box.
        constexpr std::uint32_t kMostParts = 8;
        if (cell.ref.triangle_count() > kMostParts) {
            NodeRef half = cell.ref;
            half.end = half.begin + half.triangle_count() / 2;
            parts.push_back({half});
            parts.push_back({{half.end, cell.ref.end, half.slot, half.depth}});
            return;
        }
        for (std::uint32_t k = cell.ref.begin; k < cell.ref.end; ++k) {
            parts.push_back({TreeView::triangle_ref(cell.ref, k)});
        }
        return;
    }
    const CellCorners corners = corners_of(surface, cell);
    std::size_t longest = 0;
    double square = -1;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 edge = corners[(k + 1) % 3] - corners[k];
        if (const double its = dot(edge, edge); its > square) {
            square = its;
            longest = k;
        }
    }
    const Vec3& p = cell.weights[longest];
    const Vec3& q = cell.weights[(longest + 1) % 3];
    constexpr double kLast = 0x1p-50;
    if (!(norm_inf(p - q) > kLast)) {
        return;
    }
    const Vec3 middle = 0.5 * p + 0.5 * q;
    for (const std::size_t moved : {longest, (longest + 1) % 3}) {
        SurfaceCell half = cell;
        half.weights[moved] = middle;
        parts.push_back(half);
    }
}

} // namespace obb
