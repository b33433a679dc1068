// Planes that tell ties: translations after which thousands of pairs touch at the same time, as
// faces do that land on each other, or triangles that a mesh holds many times. The plane of a
// contact shows of all vertices under two nodes that none touches earlier.
#pragma once

#include "descent/recent_vertices.hpp"
#include "descent/tie_search.hpp"
#include "in_motion/contact_plane.hpp"
#include "in_motion/moving_pair.hpp"
#include "work/slice.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace obb {

class TiePlanes {
  public:
    // What a look at two nodes says: not yet anything; nothing; that nothing under the pair touches
    // earlier than the contact that the planes are of; that nothing of both bodies does.
    enum class Verdict : std::uint8_t { kLooking, kUnknown, kPairIsLater, kAllIsLater };

    // Takes the planes of a contact of two triangles. They are used from 64 pops on: few questions
    // get that far.
    void set(const MovingPair& pair, const PairRef& refs, const Touch& touch, std::uint64_t pops);
    void clear() { planes_.clear(); }
    // Whether there are planes that have not yet been looked at in vain.
    [[nodiscard]] bool are_promising() const { return !planes_.empty() && !crowd_.has_failed(); }

    // Whether a look at a pair of nodes is due.
    [[nodiscard]] bool may_tie(const PairRef& refs, std::uint64_t pops) const;
    // Begins to look at a pair, after so many pops. The bodies as a whole are looked at first: a
    // plane that holds for them ends a search.
    [[nodiscard]] Verdict look(const MovingPair& pair, const PairRef& refs, std::uint64_t pops);
    // Goes on with vertices one by one, in slices: both nodes may hold whole meshes.
    [[nodiscard]] Verdict look_on(const MovingPair& pair, SliceClock& clock);
    [[nodiscard]] bool is_looking() const { return wait_ != nullptr; }

    // After a look at the bodies as a whole that found vertices beyond a plane: triangles with
    // those that are farthest beyond it, of A and of B. What touches earlier than the contact is
    // likely to have one of them. Told once.
    struct Ahead {
        std::array<std::optional<NodeRef>, 2> triangles;
    };
    [[nodiscard]] Ahead take_ahead() { return std::exchange(ahead_, Ahead{}); }

    // Whether two triangles surely touch no earlier than the contact.
    [[nodiscard]] bool are_later(const MovingPair& pair, const PairRef& refs) const;

  private:
    // A plane that parts what touches at the time of the contact, and, in the query's units from
    // the bodies' pivots, up to where A reaches along it and from where on B.
    struct Tie {
        ContactPlane plane;
        Vec3 normal;
        double top_of_a, bottom_of_b;
    };
    // Nodes whose vertices are being compared with a plane, and the triangles that come next.
    struct Wait {
        TieWait<PairRef> nodes;
        std::size_t plane;
        std::array<std::uint32_t, 2> next; // triangles of A and of B
        bool is_all;                       // whether the nodes are the bodies as a whole
        bool holds = true;
        std::array<double, 2> farthest{}; // beyond the plane, from the pivots
        std::array<RecentVertices, 2> seen{};
    };

    [[nodiscard]] static bool are_sides(const MovingPair& pair, const PairRef& refs,
                                        const Tie& tie);
    [[nodiscard]] bool waits_for(const MovingPair& pair, const PairRef& candidate,
                                 const PairRef& refs, std::size_t plane);

    [[nodiscard]] std::optional<bool> compare(const MovingPair& pair, SliceClock& clock);

    bool all_hold(const MovingTree& body, std::uint32_t position, std::size_t side);

    std::vector<Tie> planes_;
    Ahead ahead_;
    std::uint64_t patience_ = 0; // pops up to which nothing is looked at
    std::uint64_t pause_ = 0;    // pops from one look in vain to the next
    TieCrowd crowd_;
    std::unique_ptr<Wait> wait_; // large, and seldom needed
};

} // namespace obb
