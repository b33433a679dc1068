// A tree of boxes over triangles, as plain arrays, and the walk from a node to its children.
#pragma once

#include "shapes/triangle.hpp"
#include "tree/node.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

namespace obb {

// What an array of a tree holds contradicts the others: a damaged file, never a caller's fault.
struct TreeError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

using Corners = std::array<std::uint32_t, 3>;

// A node is known by its range of triangles and the slot of its box. A range of one triangle has no
// box: the triangle is tested itself.
struct NodeRef {
    std::uint32_t begin;
    std::uint32_t end;
    std::uint32_t slot;
    std::uint32_t depth;

    [[nodiscard]] std::uint32_t triangle_count() const { return end - begin; }
    [[nodiscard]] bool is_triangle() const { return end - begin == 1; }
};

// Slot of a triangle that is known by its row of the mesh, whatever its place in the tree.
inline constexpr std::uint32_t kMeshRow = 0xffffffff;

// Of a node that has children which are not made yet; no range has its end there.
inline constexpr std::uint32_t kUnsplit = 0xffffffff;

// Some trees are made as they are used. Whoever goes down from a node asks for what stands right
// under it: the boxes of its children, or their triangles where they need no box. That is made
// once, by the first to ask, and only read from then on; others wait for it.
struct OnDemand {
    const std::uint8_t* ready; // a flag a slot, set when what stands under the node may be read
    void* owner;
    void (*prepare)(void* owner, const NodeRef& ref); // what it throws leaves the tree usable

    [[nodiscard]] bool is_ready(std::uint32_t slot) const {
        return __atomic_load_n(&ready[slot], __ATOMIC_ACQUIRE) != 0;
    }
};

// Boxes stand in depth-first order: the left child's box follows its parent's. A range of n
// triangles owns n - 1 slots whatever its shape, so a node's slot depends on its range alone and
// not on the order in which nodes are split. Every step narrows the range, so that links of a
// damaged file can neither cycle nor cross: a traversal ends, whatever they hold.
struct TreeView {
    std::span<const Vec3> vertices;
    std::span<const Corners> corners;            // of the triangles, in tree order
    std::span<const std::uint32_t> triangle_ids; // rows of the mesh file, in tree order
    std::span<const Node> nodes;
    int scale_exponent; // a length in the tree's unit times 2^scale_exponent is in mesh units
    const OnDemand* on_demand = nullptr; // of a tree that is all there: none
    std::span<const Corners> rows{};     // the mesh's own triangles, where the tree grows over them

    [[nodiscard]] std::uint32_t triangle_count() const {
        return static_cast<std::uint32_t>(corners.size());
    }
    [[nodiscard]] NodeRef root() const { return {0, triangle_count(), 0, 0}; }

    // The node with a box; only for ranges of more than one triangle.
    [[nodiscard]] const Node& node(const NodeRef& ref) const {
        if (ref.slot >= nodes.size()) {
            throw TreeError("a link leads beyond the boxes");
        }
        return nodes[ref.slot];
    }

    // Another thread may be splitting the node, which changes no leaf and makes none.
    [[nodiscard]] static bool is_leaf(const Node& node) {
        return __atomic_load_n(&node.split, __ATOMIC_RELAXED) == 0;
    }

    // Makes what stands right under a node ready to be read.
    void prepare(const NodeRef& ref) const {
        if (on_demand != nullptr && !on_demand->is_ready(ref.slot)) {
            on_demand->prepare(on_demand->owner, ref);
        }
    }

    // Makes the first triangles under a node ready to be read, for those who look at them without
    // having come down to them.
    void prepare_triangles(const NodeRef& ref, std::uint32_t count) const;
    void prepare_into(std::vector<NodeRef>& stack, const NodeRef& ref) const;

    // Of a node that is no leaf.
    [[nodiscard]] std::array<NodeRef, 2> children(const NodeRef& ref, const Node& node) const {
        prepare(ref);
        return links(ref, node);
    }

    // The same where it does not matter whether what stands under the node may be read.
    [[nodiscard]] static std::array<NodeRef, 2> links(const NodeRef& ref, const Node& node) {
        if (node.split <= ref.begin || node.split >= ref.end) {
            throw TreeError("a split lies outside its range");
        }
        if (node.right <= ref.slot) {
            throw TreeError("a link leads backwards");
        }
        return {child(ref, node, 0), child(ref, node, 1)};
    }

    // The same of links that were looked at: the first child, or the second.
    [[nodiscard]] static NodeRef child(const NodeRef& ref, const Node& node, std::size_t k) {
        return k == 0 ? NodeRef{ref.begin, node.split, ref.slot + 1, ref.depth + 1}
                      : NodeRef{node.split, ref.end, node.right, ref.depth + 1};
    }

    // One triangle of a leaf that holds several.
    [[nodiscard]] static NodeRef triangle_ref(const NodeRef& leaf, std::uint32_t position) {
        return {position, position + 1, leaf.slot, leaf.depth};
    }

    [[nodiscard]] std::array<const Vec3*, 3> corners_of(std::uint32_t position) const {
        const Corners& c = corners[position];
        if (c[0] >= vertices.size() || c[1] >= vertices.size() || c[2] >= vertices.size()) {
            throw TreeError("a triangle uses a vertex that is not there");
        }
        return {&vertices[c[0]], &vertices[c[1]], &vertices[c[2]]};
    }
    [[nodiscard]] Triangle triangle(std::uint32_t position) const {
        const auto [p, q, r] = corners_of(position);
        return {*p, *q, *r};
    }

    // A damaged link of a file leads a triangle to any slot, but a file has no rows.
    [[nodiscard]] bool is_mesh_row(const NodeRef& ref) const {
        return ref.slot == kMeshRow && !rows.empty();
    }
    // The same of a triangle that is known by its place in the tree, or by its row of the mesh.
    [[nodiscard]] Triangle triangle(const NodeRef& ref) const {
        if (is_mesh_row(ref)) {
            const Corners& c = rows[ref.begin];
            return {vertices[c[0]], vertices[c[1]], vertices[c[2]]};
        }
        return triangle(ref.begin);
    }
    [[nodiscard]] std::uint32_t row_of(const NodeRef& ref) const {
        return is_mesh_row(ref) ? ref.begin : triangle_ids[ref.begin];
    }
};

// Makes all triangles under a node ready to be read, as prepare_triangles() does, but in slices.
class Preparation {
  public:
    // The tree must outlive it.
    void begin(const TreeView& tree, const NodeRef& ref);

    // Goes on until the clock says that a slice is over; true when all is ready.
    template <typename Clock>
    [[nodiscard]] bool advance(Clock& clock) {
        while (!stack_.empty()) {
            if (clock.is_over()) {
                return false;
            }
            prepare_one();
        }
        return true;
    }

  private:
    void prepare_one();

    const TreeView* tree_ = nullptr;
    std::vector<NodeRef> stack_;
};

} // namespace obb
