// The pairs of triangles whose shadows along an axis may meet, found by going down two trees.
#pragma once

#include "descent/limits.hpp"
#include "overlap/column_body.hpp"
#include "overlap/column_frame.hpp"
#include "overlap/shadow.hpp"
#include "work/slice.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace obb {

// The shadows of a few triangles of a body, made once while they are looked at often.
class ShadowGroups {
  public:
    static constexpr std::uint32_t kMost = 16;

    ShadowGroups(const ColumnBody& body, const ColumnFrame& frame);

    // Of a node with at most so many triangles; valid until the next one is asked for.
    [[nodiscard]] std::span<const Shadow> of(const NodeRef& ref);

  private:
    static constexpr std::size_t kSlots = 128; // at most

    struct Group {
        std::uint32_t begin = 0, end = 0;
        std::array<Shadow, kMost> shadows;
    };

    const ColumnBody& body_;
    const ColumnFrame& frame_;
    std::vector<Group> groups_;
};

// Pairs of a triangle of one body and one of another; or, with a body and itself, every pair of its
// triangles once, and every triangle with itself.
class ShadowPairs {
  public:
    // Bodies and frame must outlive it.
    ShadowPairs(const ColumnBody& a, const ColumnBody& b, const ColumnFrame& frame);

    // Takes at most so many pairs of nodes off the stack and hands pairs of shadows to
    // use(shadow_a, shadow_b, is_same); true when there are no more. Nodes that are not needed are
    // not opened.
    template <typename Use>
    bool advance(std::uint64_t max_pops, const Use& use) {
        SliceClock clock;
        for (; !stack_.empty() && max_pops > 0 && !clock.is_over(); --max_pops) {
            const Pair pair = stack_.back();
            stack_.pop_back();
            ++counts_.pops;
            if (pair.a.ref.triangle_count() <= ShadowGroups::kMost &&
                pair.b.ref.triangle_count() <= ShadowGroups::kMost) {
                visit(pair, use);
            } else {
                part(pair);
            }
        }
        return stack_.empty();
    }

    [[nodiscard]] const WalkCounts& counts() const { return counts_; }

  private:
    struct Side {
        NodeRef ref;
        std::array<double, 2> low, high; // across the columns
    };
    struct Pair {
        Side a, b;
        bool is_same; // both are one node of one body
    };
    // The parts of a node that matter.
    struct Parts {
        std::array<Side, 2> sides;
        std::size_t count = 0;
    };

    template <typename Use>
    void visit(const Pair& pair, const Use& use) {
        const auto a = groups_a_.of(pair.a.ref), b = groups_b_.of(pair.b.ref);
        for (std::size_t i = 0; i < a.size(); ++i) {
            for (std::size_t k = pair.is_same ? i : 0; k < b.size(); ++k) {
                if (may_share(a[i], b[k])) {
                    ++counts_.triangle_tests;
                    use(a[i], b[k], pair.is_same && i == k);
                }
            }
        }
    }
    void part(const Pair& pair);
    void push(const Side& a, const Side& b);
    void add(Parts& parts, const ColumnBody& body, const NodeRef& ref) const;
    [[nodiscard]] Parts parts_of_side(const ColumnBody& body, const Side& side) const;

    const ColumnBody& a_;
    const ColumnBody& b_;
    const ColumnFrame& frame_;
    ShadowGroups groups_a_, groups_b_;
    std::vector<Pair> stack_;
    WalkCounts counts_;
};

} // namespace obb
