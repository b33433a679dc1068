// The closed surface of one posed body in the frame of an overlap query: what searches for points
// and boxes go down.
#pragma once

#include "descent/posed_tree.hpp"
#include "overlap/overlap_frame.hpp"
#include "shapes/obb.hpp"
#include "shapes/triangle.hpp"

#include <cstdint>
#include <vector>

namespace obb {

class SolidSurface {
  public:
    // The tree must outlive it.
    SolidSurface(const TreeView& tree, const Pose& pose, const OverlapFrame& frame);

    [[nodiscard]] const OverlapFrame& frame() const { return frame_; }
    [[nodiscard]] const TreeView& tree() const { return body_.tree(); }

    // A box in the frame, at most 1 + 2 skew() long axes. What it holds, the posed vertices rounded
    // to double, may stick out of it by blur() along any axis of the frame or of the box.
    [[nodiscard]] Obb box(const Node& node) const { return body_.box(node); }
    // The same of a node that is no triangle, and how far it reaches from its centre along the axes
    // of the frame, blur included; valid until the next one is asked for. Searches come by the same
    // boxes again and again, and to turn one takes longer than to look at it: those looked at last
    // are kept.
    struct PlacedBox {
        Obb box;
        Vec3 reach;
    };
    [[nodiscard]] const PlacedBox& placed(const NodeRef& ref) const {
        Kept& kept = kept_[ref.slot % kept_.size()];
        if (kept.slot != ref.slot) {
            kept.placed = place(tree().node(ref)); // before the slot: it may throw
            kept.slot = ref.slot;
        }
        return kept.placed;
    }
    [[nodiscard]] const Obb& box(const NodeRef& ref) const { return placed(ref).box; }
    [[nodiscard]] double blur() const { return blur_; }
    // How far the pose's matrix is from orthonormal, and rounding.
    [[nodiscard]] double skew() const { return skew_; }

    // Corners in the frame, each within kPlaceError / 2 of the posed vertex.
    [[nodiscard]] Triangle triangle(const NodeRef& ref) const;
    // The posed vertices themselves.
    [[nodiscard]] Triangle world_triangle(const NodeRef& ref) const { return body_.triangle(ref); }
    // As PosedTree::place_triangles(), in the frame.
    void place_triangles(std::uint32_t begin, std::uint32_t count, FourTriangles& placed) const;
    [[nodiscard]] std::uint32_t id(const NodeRef& ref) const { return body_.id(ref); }

  private:
    static constexpr std::uint32_t kMostKept = 2048;
    static constexpr std::uint32_t kNoSlot = 0xffffffff;
    struct Kept {
        PlacedBox placed;
        std::uint32_t slot = kNoSlot;
    };
    [[nodiscard]] PlacedBox place(const Node& node) const;

    PosedTree body_;
    OverlapFrame frame_;
    double blur_ = 0;
    double skew_ = 0;
    mutable std::vector<Kept> kept_; // of one query, which one thread at a time goes on with
};

} // namespace obb
