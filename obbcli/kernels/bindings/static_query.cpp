// Questions about bodies at rest across the border.
#include "bindings/at_rest.hpp"
#include "bindings/module.hpp"

#include "work/parallel.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <atomic>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

using namespace nb::literals;

namespace {

Owned<std::int64_t, -1, 2> rows_of(std::vector<obb::TrianglePair>&& pairs) {
    const std::size_t count = pairs.size();
    return owned<Owned<std::int64_t, -1, 2>>(std::move(pairs), {count, 2});
}

obb::StaticQueryOptions options_of(const obb::Limits& limits) { return {.boxes = limits.boxes}; }

void init_query(AtRest* self, const Placed& a, const Placed& b, const obb::Limits& limits) {
    new (self) AtRest{a.owner,
                      b.owner,
                      brief_pops(*a.tree, *b.tree),
                      {a.tree->view, a.pose, b.tree->view, b.pose, options_of(limits)}};
}

using Witness = std::optional<std::pair<std::int64_t, std::int64_t>>;

// The first pair found; none where nothing was, or where boxes met.
Witness witness_of(const obb::StaticQuery& query) {
    const auto found = query.pairs();
    return found.empty() ? Witness{} : Witness{{found[0].a, found[0].b}};
}

// Advances a query to its end or to a limit, in pops or seconds; true when its answer is complete.
// The clock is looked at from the end of the first few pops on: two looks take a third of what a
// question about bodies far from each other does. Throws what a signal's handler raised.
bool run(obb::StaticQuery& query, std::uint64_t brief, const obb::Limits& limits, double& seconds) {
    std::uint64_t max_pops = limits.max_pops;
    brief = std::min(brief, max_pops);
    if (query.advance(brief)) {
        return true;
    }
    const Stopwatch watch;
    bool is_complete = false;
    do {
        max_pops = limits.max_pops - query.counts().pops;
        {
            const nb::gil_scoped_release release;
            is_complete = query.advance(std::min(kPopsASlice, max_pops));
        }
        if (!is_complete && PyErr_CheckSignals() != 0) {
            throw nb::python_error();
        }
        seconds = watch.seconds();
    } while (!is_complete && query.counts().pops < limits.max_pops && seconds < limits.seconds);
    return is_complete;
}

nb::object collide(const Placed& a, const Placed& b, const obb::Limits& limits,
                   double load_seconds) {
    AtRestFound found = ask_at_rest(a, b, limits);
    found.load_seconds = load_seconds;
    return answer_of(found);
}

// More pairs than there is to be room for.
struct TooManyPairs {};

// Parts are several a thread, for they differ in size.
void advance_in_parts(obb::StaticQuery& query, unsigned threads, std::uint64_t most) {
    constexpr std::size_t kPartsAThread = 16;
    const nb::gil_scoped_release release;
    std::vector<obb::StaticQuery> parts = query.divide(kPartsAThread * threads);
    std::atomic<std::uint64_t> count = query.pairs().size();
    const SignalWatch watch;
    const auto advance_part = [&](std::size_t k) {
        const std::size_t before = parts[k].pairs().size();
        const bool is_done = parts[k].advance(kPopsASlice);
        if ((count += parts[k].pairs().size() - before) > most) {
            throw TooManyPairs();
        }
        return is_done;
    };
    obb::do_parts(parts.size(), threads, advance_part, watch);
    query.join(parts);
    if (query.pairs().size() > most) { // found before there were parts, and nothing since
        throw TooManyPairs();
    }
}

// Throws TooManyPairs; more than a slice finds does not come on top.
void advance_alone(obb::StaticQuery& query, std::uint64_t brief, std::uint64_t most) {
    while (!advance(query, brief, kPopsASlice) && query.pairs().size() <= most) {
        if (PyErr_CheckSignals() != 0) {
            throw nb::python_error();
        }
    }
    if (query.pairs().size() > most) {
        throw TooManyPairs();
    }
}

// The pairs, but none if there are more than `most`, and what they cost. Which ones a limit leaves
// depends on the order in which they are found: there, one thread works.
std::pair<std::optional<Owned<std::int64_t, -1, 2>>, Counts>
triangle_pairs(const Placed& a, const Placed& b, std::uint64_t limit, unsigned threads,
               std::uint64_t most) {
    // Below so many pops, threads cost more than they save: at 10,000, where one takes 1.7 ms, a
    // second on a busy machine took 0.1 ms more at best, and often a slice of the scheduler's.
    constexpr std::uint64_t kPopsAlone = kPopsASlice;
    constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();
    const obb::RootVerdict roots = obb::compare_roots(a.root, b.root);
    if (roots == obb::RootVerdict::kApart) {
        return {rows_of({}), {1, 0, 0, 0, 0}};
    }
    obb::StaticQueryOptions options;
    options.all_pairs = true;
    options.limit = limit;
    options.roots_may_meet = roots == obb::RootVerdict::kMayMeet;
    obb::StaticQuery query(a.tree->view, a.pose, b.tree->view, b.pose, options);
    const std::uint64_t brief = brief_pops(*a.tree, *b.tree);
    try {
        if (threads < 2 || limit != kNoLimit || advance(query, brief, kPopsAlone)) {
            advance_alone(query, brief, most);
        } else {
            advance_in_parts(query, threads, most);
        }
    } catch (const TooManyPairs&) {
        return {std::nullopt, counts_of(query.counts())};
    }
    return {rows_of(query.take_pairs()), counts_of(query.counts())};
}

} // namespace

AtRestFound ask_at_rest(const Placed& a, const Placed& b, const obb::Limits& limits) {
    AtRestFound found;
    obb::WalkCounts counts;
    counts.box_tests = 1; // that of the roots
    const obb::RootVerdict roots = obb::compare_roots(a.root, b.root);
    found.is_complete = roots == obb::RootVerdict::kApart;
    if (!found.is_complete) {
        obb::StaticQueryOptions options = options_of(limits);
        options.roots_may_meet = roots == obb::RootVerdict::kMayMeet;
        obb::StaticQuery query(a.tree->view, a.pose, b.tree->view, b.pose, options);
        found.is_complete = run(query, brief_pops(*a.tree, *b.tree), limits, found.seconds);
        found.is_by_boxes = query.is_by_boxes();
        found.error_bound = query.error_bound();
        set_witness(found, query.pairs());
        counts = query.counts();
    }
    found.counts = all_counts(counts, *a.tree, *b.tree);
    return found;
}

void bind_static_query(nb::module_& m) {
    // Arguments without names cost less.
    m.def("collide", &collide);
    m.def("triangle_pairs", &triangle_pairs);

    nb::class_<AtRest>(m, "StaticQuery")
        .def("__init__", &init_query)
        .def(
            "advance",
            [](AtRest& self, std::uint64_t max_pops) {
                return advance(self.query, self.brief, max_pops);
            },
            "max_pops"_a)
        .def_prop_ro("is_contact", [](const AtRest& self) { return self.query.is_contact(); })
        .def_prop_ro("is_by_boxes", [](const AtRest& self) { return self.query.is_by_boxes(); })
        .def_prop_ro("error_bound", [](const AtRest& self) { return self.query.error_bound(); })
        .def("witness", [](const AtRest& self) { return witness_of(self.query); })
        .def("counts", [](const AtRest& self) { return counts_of(self.query.counts()); });
}
