// How deep the surface of one closed solid reaches into another: the greatest distance that a point
// of A's surface inside B has from B's surface. The same without the condition that it be inside is
// the one-sided Hausdorff distance of the surfaces.
#pragma once

#include "descent/bound_queue.hpp"
#include "overlap/escape_row.hpp"
#include "overlap/matrix_game.hpp"
#include "overlap/nearest_triangle.hpp"
#include "overlap/solid_surface.hpp"
#include "overlap/surface_cell.hpp"
#include "overlap/triangles_in_box.hpp"
#include "overlap/winding_number.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace obb {

struct ProtrusionOptions {
    double tolerance = 0.01;           // asked of the bracket's width, relative to its upper end
    std::optional<double> deeper_than; // only whether the depth exceeds this, in mesh units
    double floor = 0;                  // a bracket of this width will do, in mesh units
    std::uint64_t max_cells = 200'000;
    bool inside_only = true; // without: of all points of A's surface, inside B or not
};

// A point of A's surface, to rounding, and how far from B's it is at least.
struct ProtrudingPoint {
    Vec3 world{0, 0, 0};
    double depth = 0; // in the frame's unit; 0 where there is none yet
    std::uint32_t triangle_a = 0, triangle_b = 0;
};

// Branch and bound over what of A's surface lies in a box of its tree, then over its triangles and
// their halves. A cell is bounded by functions that no point of it can exceed: the distance from a
// triangle of B, and the way out of B along a direction (EscapeRow). Both ends of the bracket hold
// at any moment: the lower one is that of a point seen inside B, the upper one the largest bound of
// all cells that wait or were given up.
//
// With `deeper_than` = o cells are given up as soon as none of their points can be deeper than
// o + floor: the query ends with a point deeper than o, or with an upper end of at most o + floor.
class ProtrusionQuery {
  public:
    // The trees must outlive it; B must be closed. Throws std::domain_error where posed coordinates
    // would leave the range of double.
    ProtrusionQuery(const TreeView& a, const Pose& pose_a, const TreeView& b, const Pose& pose_b,
                    const ProtrusionOptions& options);
    ProtrusionQuery(const ProtrusionQuery&) = delete; // it points into itself
    ProtrusionQuery& operator=(const ProtrusionQuery&) = delete;

    // Looks at no more than so many cells; true when nothing is left to do, for it is answered or
    // has looked at max_cells. Where slices end makes no difference.
    bool advance(std::uint64_t max_cells);

    // In mesh units.
    [[nodiscard]] double low() const;
    [[nodiscard]] double high() const;
    // None while undecided.
    [[nodiscard]] std::optional<bool> is_deeper() const;
    [[nodiscard]] bool is_answered() const;
    [[nodiscard]] const ProtrudingPoint& deepest() const { return best_; }
    [[nodiscard]] std::uint64_t cells() const { return cells_; }
    [[nodiscard]] std::uint64_t points() const { return points_; }
    [[nodiscard]] std::uint64_t rays() const { return windings_.rays() + escapes_.rays(); }

  private:
    static constexpr std::size_t kInherited = 6, kRows = 12;
    using Values = MatrixGame::Values;

    // What bounds the depth of points; kept as long as a cell has it.
    struct Row {
        enum class Kind : std::uint8_t { kTriangle, kEscape, kCrossing };
        Kind kind = Kind::kTriangle;
        NodeRef triangle{};
        Triangle corners{};
        Vec3 up{0, 0, 0};
        double low = 0, high = 0; // heights
        std::uint32_t holders = 0;
    };
    struct Cell {
        SurfaceCell place;
        double bound;
        std::uint8_t row_count;
        bool is_inside; // all of it
        std::array<std::uint32_t, kInherited> rows;
    };
    // A row at work in the present cell.
    struct Held {
        std::uint32_t id;
        double weight;
        Values values;
    };

    [[nodiscard]] double target() const;
    void visit(const Cell& cell);
    void look_at();
    [[nodiscard]] bool is_given_up();
    void give_up(double bound);
    [[nodiscard]] Vec3 candidate() const;
    [[nodiscard]] bool add_rows();
    [[nodiscard]] bool look_inside(const Vec3& world, const Vec3& point, double clear);
    void try_point(const Vec3& world, const Vec3& asked, const PointDistance& near,
                   std::uint32_t triangle);
    void try_surface(const Vec3& point);
    bool add_triangle(const PointDistance& near);
    bool add_way(const Vec3& up, const NodeRef& triangle);
    [[nodiscard]] Vec3 own_normal() const;
    [[nodiscard]] Vec3 side_for(const Vec3& up) const;
    [[nodiscard]] CellCorners core(double within) const;
    void add(const Row& row);
    void hold(std::uint32_t id);
    void drop(std::uint32_t id);
    void drop_idle(std::size_t most);
    [[nodiscard]] Values values_of(const Row& row) const;
    void split();
    void push(const SurfaceCell& place);
    [[nodiscard]] bool is_far(const SurfaceCell& place) const;

    OverlapFrame frame_;
    SolidSurface a_, b_;
    NearestSearch nearest_a_, nearest_;
    BoxSearch boxes_;
    WindingSearch windings_;
    EscapeSearch escapes_;
    bool inside_only_ = true;
    double slack_ = 0;                 // relative, asked of nearest triangles
    double tolerance_ = 0, floor_ = 0; // of depths, in the frame's unit
    std::optional<double> wanted_;     // the depth asked about
    std::optional<double> limit_;      // and the one up to which cells are given up
    std::uint64_t max_cells_ = 0;
    std::optional<Obb> root_b_;

    BoundQueue<Cell> queue_;
    std::uint32_t order_ = 0;
    std::vector<Row> rows_;
    std::vector<std::uint32_t> free_rows_;

    ProtrudingPoint best_;
    double given_up_ = 0; // the largest bound of what was given up
    std::uint64_t cells_ = 0, points_ = 0;
    double outward_ = 1; // the side of B's triangles on which it was out last

    // The present cell.
    Cell cell_{};
    CellCorners corners_{};
    double bound_ = 0;
    bool is_over_ = false; // no point of it is inside
    std::vector<Held> held_;
    std::vector<Vec3> tried_;
    std::vector<NodeRef> hints_;
    std::vector<SurfaceCell> parts_;
    MatrixGame game_;
};

} // namespace obb
