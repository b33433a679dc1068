// Many pairs of moving bodies, asked about at the same time, across the border.
#include "bindings/at_rest.hpp"
#include "bindings/module.hpp"

#include "in_motion/steady_query.hpp"
#include "work/parallel.hpp"

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <tuple>
#include <utility>

using namespace nb::literals;

namespace {

// What became of a pair.
enum class PairState : std::uint8_t {
    kNotAsked, // no time was left for it
    kApart,    // proven, for the whole duration
    kAnswered, // otherwise: its queries are handed over
    kOpen,     // there is more to do: its queries are handed over
    kRefused,  // numbers beyond the range of double, or a damaged tree: to be asked about alone
};

// A tree at its pose, and its motion, of A and of B.
using Bodies = std::tuple<PlacedRef, const obb::Screw*, PlacedRef, const obb::Screw*>;

obb::SteadyBody moving(const Placed& placed, const obb::Screw& screw) {
    return {&placed.tree->view, placed.pose, screw};
}

// Gives each pair its first slice. The states and queries do not depend on the number of threads.
class FirstSlices {
  public:
    FirstSlices(const std::vector<Bodies>& pairs, const obb::ContactQueryOptions& options)
        : pairs_(pairs), options_(options), states_(pairs.size(), PairState::kNotAsked),
          queries_(pairs.size()), counts_(pairs.size()) {}

    void run(unsigned threads) {
        // Pairs that take less time than to start a thread are done first, by this one.
        constexpr double kAlone = 2e-4; // s
        const SignalWatch watch;
        std::size_t done = 0;
        for (; done < pairs_.size() && (threads < 2 || clock_.seconds() < kAlone); ++done) {
            ask(done);
            watch();
        }
        const auto part = [&](std::size_t k) {
            ask(done + k);
            return true;
        };
        obb::do_parts(pairs_.size() - done, threads, part, watch);
    }

    [[nodiscard]] const std::vector<PairState>& states() const { return states_; }
    // The query about a pair; null where it is not needed any more.
    [[nodiscard]] obb::SteadyQuery* query(std::size_t k) { return queries_[k].get(); }
    // What the pairs that are apart have cost.
    [[nodiscard]] obb::WalkCounts counts() const {
        obb::WalkCounts sum;
        for (const obb::WalkCounts& each : counts_) {
            sum += each;
        }
        return sum;
    }

  private:
    void ask(std::size_t k) {
        if (clock_.seconds() >= options_.limits.seconds) {
            return;
        }
        const auto& [a, screw_a, b, screw_b] = pairs_[k];
        try {
            auto query = std::make_unique<obb::SteadyQuery>(moving(*a, *screw_a),
                                                            moving(*b, *screw_b), options_);
            const bool is_finished = query->advance(options_.limits.max_pops);
            if (is_finished && !query->is_contact() && !query->has_given_up()) {
                states_[k] = PairState::kApart;
                counts_[k] = query->counts();
                return;
            }
            states_[k] = is_finished ? PairState::kAnswered : PairState::kOpen;
            queries_[k] = std::move(query);
        } catch (const std::domain_error&) {
            states_[k] = PairState::kRefused;
        } catch (const obb::TreeError&) {
            states_[k] = PairState::kRefused;
        }
    }

    const std::vector<Bodies>& pairs_;
    obb::ContactQueryOptions options_;
    Stopwatch clock_;
    std::vector<PairState> states_;
    std::vector<std::unique_ptr<obb::SteadyQuery>> queries_;
    std::vector<obb::WalkCounts> counts_; // of pairs that are apart
};

// A question about moving bodies that was begun here, and what keeps its trees alive.
struct HandedOver : obb::ContactQuery {
    nb::object a, b;
};

// The objects that Python knows of a query, which keep the trees alive.
nb::object as_python(obb::SteadyQuery& query, const Placed& a, const Placed& b) {
    AtRest at_start{a.owner, b.owner, brief_pops(*a.tree, *b.tree), std::move(query.at_start())};
    nb::object moving = nb::none();
    if (query.moving()) {
        moving = nb::cast(HandedOver{std::move(*query.moving()), a.owner, b.owner});
    }
    return nb::make_tuple(nb::cast(std::move(at_start)), moving);
}

using Asked = std::tuple<nb::bytes, nb::list, Counts>;

Asked ask_pairs(const std::vector<Bodies>& pairs, const obb::Limits& limits, double duration,
                double time_tolerance, unsigned threads) {
    FirstSlices slices(pairs,
                       {.duration = duration, .time_tolerance = time_tolerance, .limits = limits});
    {
        const nb::gil_scoped_release release;
        slices.run(threads);
    }
    nb::list queries;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (obb::SteadyQuery* query = slices.query(k)) {
            queries.append(as_python(*query, *std::get<0>(pairs[k]), *std::get<2>(pairs[k])));
        }
    }
    const nb::bytes states(reinterpret_cast<const char*>(slices.states().data()), pairs.size());
    return {states, queries, counts_of(slices.counts())};
}

} // namespace

MovingAsked ask_moving(const Placed& a, const obb::Screw& screw_a, const Placed& b,
                       const obb::Screw& screw_b, const obb::ContactQueryOptions& options) {
    MovingAsked asked;
    obb::SteadyQuery query(moving(a, screw_a), moving(b, screw_b), options);
    const bool is_finished =
        query.advance(std::min(brief_pops(*a.tree, *b.tree), options.limits.max_pops));
    const bool is_apart = is_finished && !query.is_contact() && !query.has_given_up();
    const bool meets_at_start =
        options.any_contact && query.at_start().is_contact() && !query.at_start().is_by_boxes();
    asked.is_told = is_apart || meets_at_start;
    if (asked.is_told) {
        asked.found.is_complete = true;
        set_witness(asked.found, query.at_start().pairs());
        asked.found.counts = all_counts(query.counts(), *a.tree, *b.tree);
    } else {
        const nb::object queries = as_python(query, a, b);
        asked.queries = nb::make_tuple(queries[0], queries[1], is_finished);
    }
    return asked;
}

void bind_steady_pairs(nb::module_& m) {
    nb::class_<HandedOver, obb::ContactQuery>(m, "ContactQueryHandedOver");
    // What became of each pair, the queries of those of which more is to be known, and what the
    // others have cost. `limits` are those of a first slice.
    m.def("ask_pairs", &ask_pairs, "pairs"_a, "limits"_a, nb::kw_only(), "duration"_a,
          "time_tolerance"_a, "threads"_a);
}
