"""Surfaces at rest: yes or no over the pose classes, the same of a body that is put where it is
anew, and every pair of triangles that meet.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import peer_counts
from harness import OURS, Row, alternate
from oracles.mesh import mesh_pairs
from oracles.still import triangles_intersect
from peers import CONTESTANTS
from scenes.pairs import POSE_CLASSES, pairs

if TYPE_CHECKING:
    from collections.abc import Iterator

    from contestant import Query
    from scenes.pairs import Pair

TRUTH_TRIANGLES = 500
# Shorter than a scheduler's slice, so that on a busy machine most samples are whole.
SAMPLE_SECONDS = 0.0005
MOVED_CLASSES = ("far", "gap_1e-1", "penetrating", "plates")
ALL_PAIRS_CLASSES = ("penetrating", "deep", "random_11")


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a pose class, then a row a class with many pairs; every answer is checked."""
    check_against_truth()
    triangles = 10_000 if quick else 100_000
    rounds = 51 if quick else 101
    peer_tests = peer_counts.count(triangles)
    built: dict[tuple[str, int], object] = {}
    for pair in pairs(triangles):
        queries = _queries(pair, built)
        notes = check_answers(pair, {who: query.collides() for who, query in queries.items()})
        timings = alternate(
            {who: query.collides for who, query in queries.items()}, rounds, SAMPLE_SECONDS
        )
        notes[OURS] |= queries[OURS].counts()
        for who, tests in peer_tests.get(pair.name, {}).items():
            notes.setdefault(who, {})["box tests"] = tests
        yield Row("static", pair.name, len(pair.a.faces), timings, notes)
        if pair.name in MOVED_CLASSES:
            yield _moved_row(pair, queries, rounds)
    for name in ALL_PAIRS_CLASSES:
        yield _all_pairs_row(POSE_CLASSES[name](triangles), built, rounds // 5)


def check_against_truth() -> None:
    """Assert that ours finds exactly the pairs of triangles that rational arithmetic finds."""
    for pair in pairs(TRUTH_TRIANGLES):
        truth = mesh_pairs(pair.a.vertices, pair.a.faces, pair.posed_b, pair.b.faces)
        query = _queries(pair, {})[OURS]
        found = query.triangle_pairs()
        assert np.array_equal(found, np.array(truth, dtype=np.int64).reshape(-1, 2)), pair.name
        assert query.collides() == bool(truth), pair.name


def check_answers(pair: Pair, answers: dict[str, bool]) -> dict[str, dict[str, object]]:
    """Assert our answer, known by construction or else from python-fcl; return who says what."""
    wanted = answers["python-fcl"] if pair.touches is None else pair.touches
    assert answers[OURS] == wanted, pair.name
    notes: dict[str, dict[str, object]] = {OURS: {"touches": wanted}}
    return notes | {who: {"WRONG": said} for who, said in answers.items() if said != wanted}


def _queries(pair: Pair, built: dict[tuple[str, int], object]) -> dict[str, Query]:
    """Return everybody's question of a pair; `built` keeps the trees of surfaces seen before."""
    queries = {}
    for one in CONTESTANTS:
        models = []
        for surface in (pair.a, pair.b):
            key = (one.name, id(surface))
            if key not in built:
                built[key] = one.build(surface)
            models.append(built[key])
        queries[one.name] = one.query(models[0], models[1], pair)
    return queries


def _moved_row(pair: Pair, queries: dict[str, Query], rounds: int) -> Row:
    asked = {who: query.moved for who, query in queries.items() if query.moved is not None}
    notes = check_answers(pair, {who: ask() for who, ask in asked.items()})
    timings = alternate(asked, rounds, SAMPLE_SECONDS)
    return Row("moved body", pair.name, len(pair.a.faces), timings, notes)


def _all_pairs_row(pair: Pair, built: dict[tuple[str, int], object], rounds: int) -> Row:
    queries = _queries(pair, built)
    found = {who: set(map(tuple, q.triangle_pairs().tolist())) for who, q in queries.items()}
    notes: dict[str, dict[str, object]] = {OURS: {"pairs": len(found[OURS])}}
    corners_a, corners_b = pair.a.vertices[pair.a.faces], pair.posed_b[pair.b.faces]
    for who in set(found) - {OURS}:
        differing = found[OURS] ^ found[who]
        for i, j in differing:
            assert ((i, j) in found[OURS]) == triangles_intersect(corners_a[i], corners_b[j])
        if differing:
            notes[who] = {"WRONG pairs": len(differing)}
    timings = alternate({who: query.triangle_pairs for who, query in queries.items()}, rounds)
    return Row("all pairs", pair.name, len(pair.a.faces), timings, notes)
