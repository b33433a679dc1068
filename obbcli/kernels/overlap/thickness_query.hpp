// How thick is the overlap of two closed solids: the diameter of the largest ball inside both.
#pragma once

#include "descent/bound_queue.hpp"
#include "overlap/bound_rows.hpp"
#include "overlap/cell_box.hpp"
#include "overlap/escape_row.hpp"
#include "overlap/matrix_game.hpp"
#include "overlap/nearest_triangle.hpp"
#include "overlap/solid_surface.hpp"
#include "overlap/triangles_in_box.hpp"
#include "overlap/winding_number.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace obb {

struct ThicknessOptions {
    double tolerance = 0.01;           // asked of the bracket's width, relative to its upper end
    std::optional<double> deeper_than; // only whether the thickness exceeds this, in mesh units
    double floor = 0;                  // a bracket of this width will do, in mesh units
    std::uint64_t max_cells = 200'000;
    // Where centres of balls are looked for, in the frame of both solids: all with the same axes.
    // None: wherever both can overlap.
    std::vector<CellBox> within{};
};

// A ball that lies in both solids.
struct DeepPoint {
    Vec3 world{0, 0, 0};
    double radius = 0;                            // in the frame's unit; 0 where there is none yet
    std::uint32_t triangle_a = 0, triangle_b = 0; // nearest to it
};

// What one body's surface is asked.
struct SolidProbe {
    explicit SolidProbe(const SolidSurface& of)
        : surface(&of), nearest(of), boxes(of), windings(of), escapes(of) {}

    const SolidSurface* surface;
    NearestSearch nearest;
    BoxSearch boxes;
    WindingSearch windings;
    EscapeSearch escapes;
    double outward = 1; // the side of its triangles on which an escape row was found last
    bool is_oriented = false;
};

// Branch and bound over boxes of points. A box is bounded by functions that no point of it can
// exceed (BoundRow), combined by a MatrixGame; its best point is looked at as it is. Both ends of
// the bracket hold at any moment: the lower one is that of a ball proven to lie in both solids, the
// upper one the largest bound of all boxes that wait, that were given up, or of which parts were
// cut off.
//
// With `deeper_than` = o boxes are given up as soon as no ball in them can be thicker than
// o + floor: the query ends with a ball thicker than o, or with an upper end of at most o + floor.
//
// Surfaces that pass within their own solid (solids that overlap themselves, internal faces) count
// as surfaces here: for such solids the lower end holds, and the upper one is that of the balls
// that no surface passes through.
class ThicknessQuery {
  public:
    // The trees must outlive it and be closed. Throws std::domain_error where posed coordinates
    // would leave the range of double.
    ThicknessQuery(const TreeView& a, const Pose& pose_a, const TreeView& b, const Pose& pose_b,
                   const ThicknessOptions& options);
    ThicknessQuery(const ThicknessQuery&) = delete; // it points into itself
    ThicknessQuery& operator=(const ThicknessQuery&) = delete;

    // Looks at no more than so many boxes; true when nothing is left to do, for it is answered or
    // has looked at max_cells. Where slices end makes no difference.
    bool advance(std::uint64_t max_cells);

    // In mesh units.
    [[nodiscard]] double low() const;
    [[nodiscard]] double high() const;
    // None while undecided.
    [[nodiscard]] std::optional<bool> is_deeper() const;
    [[nodiscard]] bool is_answered() const;
    [[nodiscard]] const DeepPoint& deepest() const { return best_; }
    [[nodiscard]] std::uint64_t cells() const { return cells_; }
    [[nodiscard]] std::uint64_t points() const { return points_; }
    [[nodiscard]] std::uint64_t rays() const;

  private:
    static constexpr std::size_t kInherited = 8, kRows = 20;
    static constexpr std::uint64_t kDoubtful = 32; // of so many cells one looks on both sides

    struct Cell {
        Vec3 low, high;
        double bound;
        std::uint32_t frame;
        std::uint8_t inside; // a bit for each solid that holds all of the cell
        std::uint8_t row_count;
        bool is_fitted;      // its frame is that of a row
        std::uint8_t stalls; // so many halvings before this one left the bound about as it was
        std::array<std::uint32_t, kInherited> rows;
    };
    // A row at work in the present cell.
    struct Held {
        std::uint32_t id;
        double weight = 0;
        Triangle triangle;
        MatrixGame::Values values{};
    };
    enum class Shrunk : std::uint8_t { kNot, kSmaller, kToNothing };
    // A direction in which a way out of a body is looked for.
    struct Way {
        std::size_t body;
        Vec3 up;
    };

    void begin(const std::vector<CellBox>& boxes, double bound);
    [[nodiscard]] double target() const;
    void visit(const Cell& cell);
    void look_at(const Cell& cell);
    void place_corners();
    [[nodiscard]] bool is_given_up();
    [[nodiscard]] bool is_outside();
    void split();
    void drop_idle(std::size_t most);

    void hold(std::uint32_t id);
    void add(const BoundRow& row);
    [[nodiscard]] Vec3 candidate() const;
    [[nodiscard]] bool add_rows();
    void try_point(const Vec3& world, const std::array<PointDistance, 2>& near);
    bool add_triangle(std::size_t body, const PointDistance& near);
    bool add_escape(std::size_t body, const Vec3& up, const NodeRef& triangle);
    [[nodiscard]] Vec3 side_for(const Vec3& up) const;
    [[nodiscard]] std::optional<CellBox> cut_box(const std::array<Vec3, 3>& axes, bool is_same);
    [[nodiscard]] Shrunk shrink();
    void turn();
    [[nodiscard]] Vec3 bends() const;
    [[nodiscard]] Vec3 rises() const;

    OverlapFrame frame_;
    std::array<SolidSurface, 2> surfaces_;
    std::array<SolidProbe, 2> probes_;
    double slack_ = 0;                 // relative, asked of nearest triangles
    double tolerance_ = 0, floor_ = 0; // of radii, in the frame's unit
    std::optional<double> wanted_;     // the radius asked about
    std::optional<double> limit_;      // and the one up to which boxes are given up
    std::uint64_t max_cells_ = 0;

    BoundQueue<Cell> queue_;
    std::uint32_t order_ = 0;
    RowStore rows_;
    std::vector<std::array<Vec3, 3>> frames_;

    DeepPoint best_;
    double given_up_ = 0; // the largest bound of what was given up or cut off
    std::uint64_t cells_ = 0, points_ = 0;

    // The present cell.
    CellBox box_;
    CellBox::Corners corners_{};
    double bound_ = 0;
    std::uint32_t box_frame_ = 0;
    std::uint8_t inside_ = 0, stalls_ = 0;
    bool is_fitted_ = false;
    std::vector<Held> held_;
    Vec3 point_{0, 0, 0}; // the candidate looked at last
    double lowest_ = 0;   // what an escape row says of it at least
    std::vector<Way> tried_, ways_;
    std::vector<NodeRef> hints_;
    std::vector<MatrixGame::Values> demands_;
    MatrixGame game_, ends_;
};

} // namespace obb
