// The separating axes of a pair of shapes: their names, and what one of them says about time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace obb {

enum class AxisKind : std::uint8_t {
    kNone,
    kFaceA,    // normal of face `a` of A
    kFaceB,    // normal of face `b` of B
    kEdgeEdge, // edge `a` of A x edge `b` of B
    kPlane,    // all edges are parallel to one plane: its normal
    kEdgeA,    // ... that normal x edge `a` of A
    kEdgeB,    // ... that normal x edge `b` of B
    kLine,     // all edges are parallel to one line: its direction
    kAcross,   // ... coordinate axis `a` x that direction
    kPoint     // no edges at all: coordinate axis `a`
};

struct AxisId {
    AxisKind kind = AxisKind::kNone;
    std::uint8_t a = 0;
    std::uint8_t b = 0;

    friend constexpr bool operator==(const AxisId&, const AxisId&) = default;
};

inline constexpr std::size_t kAxisCount = 15;
inline constexpr std::uint32_t kAllAxes = (1u << kAxisCount) - 1;

// A place for each face and edge-edge axis: A's faces, B's faces, then A's edges by B's.
[[nodiscard]] constexpr std::size_t axis_index(AxisId id) {
    return id.kind == AxisKind::kFaceA   ? id.a
           : id.kind == AxisKind::kFaceB ? 3u + id.b
                                         : 6u + 3u * id.a + id.b;
}

// Of axes in a plane, those that are known not to separate, a bit each above kAllAxes: A's edges,
// then B's. A set without these bits has them all.
[[nodiscard]] constexpr std::uint32_t settled_in_plane(std::size_t edge) {
    return 1U << (kAxisCount + edge);
}

// What a projection on L says in doubles: the shapes' projections meet at time t if and only if
// low <= speed * t <= high, where for every t in [0, duration] the true low - speed * t and
// high - speed * t are within `error` of these. L itself need not be known any better.
struct AxisBound {
    double low, high, speed, error;
};

} // namespace obb
