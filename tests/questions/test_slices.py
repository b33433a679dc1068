"""How much is done between two looks at clock and signals, whatever leaves and triangles take."""

from __future__ import annotations

import pytest
from meshes.hostile import HOSTILE

from obbcli import Accuracy, Body, Mesh, Motion, ObbTree, Pose, Query, distance, first_contact
from obbcli.questions.distance import measure
from obbcli.questions.pair_question import PairQuestion

POPS = 4
# Of a leaf so many triangles are looked at in one pop.
A_POP = 64


def leafy(leaf_size: int) -> tuple[ObbTree, ObbTree]:
    """Return nested spheres, each a single leaf where that holds so many."""
    pair = HOSTILE["nested spheres"](2000)
    a, b = (ObbTree.build(Mesh(s.vertices, s.faces), leaf_size=leaf_size) for s in (pair.a, pair.b))
    return a, b


def test_distance_opens_leaves_of_whole_meshes_in_pieces():
    a, b = leafy(10_000)

    stats = distance(a, b, Accuracy(max_iterations=POPS)).stats

    assert stats.box_tests <= (POPS + 3) * A_POP  # three pops before the first distance is known


@pytest.mark.parametrize("spin", [(0.0, 0.0, 0.0), (0.5, 0.25, 2.0)])
def test_first_contact_opens_leaves_of_whole_meshes_in_pieces(spin):
    a, b = leafy(10_000)
    mover = Body(b, motion=Motion((0.03125, 0, 0.0625), spin))
    start = first_contact(a, mover, duration=0.0).stats

    stats = first_contact(a, mover, accuracy=Accuracy(max_iterations=start.pops + POPS)).stats

    assert stats.box_tests - start.box_tests <= POPS * A_POP


@pytest.mark.parametrize("spin", [(0.0, 0.0, 0.0), (0.5, 0.25, 2.0)])
def test_leaves_of_whole_meshes_change_no_answer(spin):
    pair = HOSTILE["nested spheres"](200)
    motion = Motion(pair.velocity, spin)
    found = []
    for size in (1, 10_000):
        a, b = (ObbTree.build(Mesh(s.vertices, s.faces), leaf_size=size) for s in (pair.a, pair.b))
        contact = first_contact(a, Body(b, motion=motion))
        found.append((distance(a, b).bounds, contact.status, contact.time_bounds))

    (low, high), status, bounds = found[0]
    assert found[1][1] is status
    assert found[1][0] == pytest.approx((low, high), rel=2**-48)
    assert found[1][2] == pytest.approx(bounds, abs=2e-9)


def test_distance_counts_the_pops_that_it_takes():
    pair = HOSTILE["bowl and spike"](300)
    a, b = (Mesh(s.vertices, s.faces) for s in (pair.a, pair.b))
    asked = PairQuestion.of(a, Body(b, Pose(translation=pair.apart)), 0.0)
    answer, is_complete = measure(asked)
    pops = answer.stats.pops
    assert is_complete
    assert pops > 2 * A_POP

    for limit in (1, A_POP, pops - 1, pops):
        cut, is_complete = measure(asked._replace(accuracy=Accuracy(max_iterations=limit)))
        assert (cut.stats.pops, is_complete) == (limit, limit == pops)
        assert cut.bounds[0] <= answer.bounds[0]


def test_ties_of_growing_trees_are_proven_as_those_of_whole_ones():
    pair = HOSTILE["grids"](5000)
    mesh = Mesh(pair.a.vertices, pair.a.faces)
    answers = []
    for lazy in (True, False):
        tree = ObbTree.build(mesh, lazy=lazy)
        answers.append(distance(tree, Body(tree, Pose(translation=pair.apart))))

    grown, whole = answers
    assert grown.bounds == whole.bounds
    assert grown.stats[:4] == whole.stats[:4]
    assert grown.stats.pops < 1000


def test_a_slice_ends_by_the_clock_where_pops_take_long():
    # Exact first contacts take microseconds each: a slice of pops would take a second.
    pair = HOSTILE["crossing"](300)
    mesh = Mesh(pair.a.vertices, pair.a.faces)
    query = Query(mesh, Body(mesh, Pose(translation=pair.apart), Motion(pair.velocity)))

    query.advance(seconds=0.0)
    while query.lower_bound == 0.0:
        query.advance(seconds=0.0)
    before = query.counts[3]
    query.advance(seconds=0.0)

    assert query.counts[3] - before < 16_384
