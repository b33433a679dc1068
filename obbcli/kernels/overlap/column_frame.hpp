// Where columns stand: along which axis, and in what part of space.
#pragma once

#include "overlap/column_body.hpp"
#include "overlap/shadow.hpp"

#include <cstddef>

namespace obb {

struct ColumnFrame {
    std::size_t axis = 2;
    Vec3 origin{0, 0, 0}; // low corner of the window, as the moments count from it; x, y, z
    ColumnWindow window{};
    bool is_empty = true; // the window has no inside: there is nothing to measure

    // Whether what lies within some bounds may matter.
    [[nodiscard]] bool may_matter(const Bounds& bounds) const;
    [[nodiscard]] Shadow shadow(const Triangle& t) const;
};

// Of the part of space that two bodies have in common by their extents. For one body alone both are
// the same.
[[nodiscard]] ColumnFrame frame_of(const ColumnBody& a, const ColumnBody& b, const Bounds& window);

// What lies within both.
[[nodiscard]] Bounds common(const Bounds& a, const Bounds& b);

} // namespace obb
