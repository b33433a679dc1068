"""Threads that share lazy trees, and calls that are made again and again: nothing wrong, no leak.

`bench/load.py` asks a million of the same questions, and looks at the memory held.
"""

from __future__ import annotations

import gc
import sys
import weakref
from itertools import pairwise
from typing import TYPE_CHECKING

import pytest
from asking.load_questions import KINDS, PLACES, Trees, ask, refuse, run

import obbcli
from obbcli import Accuracy, Body, Motion, Scene

if TYPE_CHECKING:
    from collections.abc import Callable

WARM_UP, CALLS, TRIES = 2, 8, 3


def test_eight_threads_are_told_what_one_is(tmp_path):
    load = run(tmp_path, 1500, 8, triangles=200, fresh=100)

    assert load.mismatches == []
    assert load.count >= 1500
    assert list(load.samples) == [tenth / 10 for tenth in range(1, 11)]


def test_an_answer_that_differs_is_noticed(tmp_path, monkeypatch):
    told = iter(range(10**6))
    monkeypatch.setattr("asking.load_questions.ask", lambda *_: next(told))

    load = run(tmp_path, 100, 2, triangles=20)

    assert load.mismatches


CALLS_BY_NAME: dict[str, Callable[[Trees, int], object]] = {
    **{kind: lambda trees, k, kind=kind: ask(kind, k, trees) for kind in KINDS},
    "refused": lambda trees, k: refuse(k, trees, trees.paths[0].parent),
    "contacts": lambda trees, k: list(
        obbcli.contacts(
            trees.shared[k % 3], Body(trees.shared[0], motion=Motion((1, 0, 0))), limit=3
        )
    ),
    "contacts that nobody takes": lambda trees, k: next(
        obbcli.contacts(trees.shared[k % 3], trees.shared[0])
    ),
    "blocks that nobody takes": lambda trees, k: next(
        obbcli.triangle_pair_blocks(trees.shared[k % 3], trees.shared[0], 2)
    ),
    "sampled": lambda trees, k: obbcli.first_contact(
        trees.shared[k % 3],
        Body(trees.shared[0], motion=Motion((9, 0, 0), (0, 0, 1))),
        accuracy=Accuracy(method="sampled", steps=3),
    ),
    "scene": lambda trees, _: list(
        Scene({str(n): Body(t, motion=Motion((n, 0, 0))) for n, t in enumerate(trees.shared)})
        .first_contacts()
    ),
    "sweep": lambda trees, k: obbcli.sweep(
        trees.shared[k % 3], trees.shared[0], [Motion((1, 0, 0)), Motion((0, 1, 0), (0, 0, 1))]
    ),
    "renewed": lambda trees, _: trees.renew(),
    "solid": lambda trees, k: obbcli.collide(trees.shared[k % 3], trees.shared[2], solid=True),
}  # fmt: skip


@pytest.mark.parametrize("name", CALLS_BY_NAME)
def test_calls_leave_no_objects_behind(name, tmp_path):
    trees = Trees(tmp_path, 100)
    call = CALLS_BY_NAME[name]

    def blocks_after(rounds: int) -> int:
        for _ in range(rounds):
            for number in range(PLACES):
                call(trees, number)
        gc.collect()
        return sys.getallocatedblocks()

    counts = [blocks_after(WARM_UP), *(blocks_after(CALLS) for _ in range(TRIES))]

    # Less than one block a call: what is left behind each time would be more, and each time.
    growths = [after - before for before, after in pairwise(counts)]
    assert min(growths) < CALLS * PLACES / 2, growths


def test_trees_go_when_nobody_uses_them(tmp_path):
    trees = Trees(tmp_path, 100)
    opened = obbcli.ObbTree.open(trees.paths[0])
    query = obbcli.Query(opened, Body(trees.shared[1], motion=Motion((1, 0, 0), (0, 0, 1))))
    query.advance(10)
    gone = [weakref.ref(tree) for tree in (opened, trees.shared[1])]

    del opened, query
    trees.renew()
    gc.collect()

    assert [reference() for reference in gone] == [None, None]
