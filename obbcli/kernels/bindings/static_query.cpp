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

Owned<std::int64_t, -1, 2> take_pairs(obb::StaticQuery& query) {
    std::vector<obb::TrianglePair> pairs = query.take_pairs();
    const std::size_t count = pairs.size();
    return owned<Owned<std::int64_t, -1, 2>>(std::move(pairs), {count, 2});
}

void init_pose(
    obb::Pose* self,
    const nb::ndarray<const double, nb::numpy, nb::shape<3, 3>, nb::c_contig>& rotation,
    const nb::ndarray<const double, nb::numpy, nb::shape<3>, nb::c_contig>& translation) {
    new (self) obb::Pose;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            self->rotation.rows[i][k] = rotation(i, k);
        }
        self->translation[i] = translation(i);
    }
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

// Whether the question was answered, whether boxes met, how far apart these hold what they stand
// for, witness, seconds, counts and of either tree the boxes there are and may be
using Collision =
    std::tuple<bool, bool, double, Witness, double,
               std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t,
                          std::uint64_t, std::uint64_t, std::uint64_t>>;

Collision collide(const Placed& a, const Placed& b, const obb::Limits& limits) {
    const Stopwatch watch;
    obb::StaticQuery query(a.tree->view, a.pose, b.tree->view, b.pose, options_of(limits));
    const bool is_complete =
        run(query, brief_pops(*a.tree, *b.tree), limits.max_pops, watch, limits.seconds);
    const obb::WalkCounts& c = query.counts();
    return {is_complete,
            query.is_by_boxes(),
            query.error_bound(),
            witness_of(query),
            watch.seconds(),
            {c.box_tests, c.triangle_tests, c.exact_triangle_tests, c.pops, a.tree->node_count(),
             b.tree->node_count(), a.tree->possible_node_count, b.tree->possible_node_count}};
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
    obb::StaticQueryOptions options;
    options.all_pairs = true;
    options.limit = limit;
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
    return {take_pairs(query), counts_of(query.counts())};
}

} // namespace

void bind_static_query(nb::module_& m) {
    nb::class_<obb::Pose>(m, "Pose").def("__init__", &init_pose, "rotation"_a, "translation"_a);

    nb::class_<Placed>(m, "Placed")
        .def(
            "__init__",
            [](Placed* self, const TreeObject& tree, const obb::Pose& pose) {
                new (self) Placed{tree, nb::cast<const Tree*>(tree), pose};
            },
            "tree"_a, "pose"_a);

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
