"""Answers are the same for any number of threads; faults and signals end the work of all."""

from __future__ import annotations

import os
import struct
import threading
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from asking.heard_signals import HeardError, ask_until_heard
from meshes.nasty import needles, soup
from oracles.tree_files import FIXED
from scenes import pairs as scenes

import obbcli
from obbcli import Body, Mesh, ObbTree, Pose
from obbcli.errors import ObbError, TreeFileError
from obbcli.primitives import Obb, Triangle, first_contact, intersects
from obbcli.threads import thread_count, usable_cores

if TYPE_CHECKING:
    from pathlib import Path


def bodies_of(name: str, triangles: int, *, lazy: bool) -> tuple[Body, Body]:
    pair = scenes.POSE_CLASSES[name](triangles)
    a, b = (
        ObbTree.build(Mesh(surface.vertices, surface.faces), lazy=lazy)
        for surface in (pair.a, pair.b)
    )
    return Body(a), Body(b, Pose(pair.rotation, pair.translation))


@pytest.mark.parametrize("lazy", [False, True])
def test_triangle_pairs_do_not_depend_on_threads(lazy: bool) -> None:
    a, b = bodies_of("stacked", 40_000, lazy=False)
    alone = obbcli.triangle_pairs(a, b, threads=1)

    for threads in (2, 3, 8):
        pair = bodies_of("stacked", 40_000, lazy=lazy)
        found = obbcli.triangle_pairs(*pair, threads=threads)

        assert found.tobytes() == alone.tobytes()


def test_many_pairs_do_not_depend_on_threads() -> None:
    a, b = (ObbTree.build(Mesh(*soup(2000, seed))) for seed in (1, 2))
    alone = obbcli.triangle_pairs(a, b, threads=1)
    some = obbcli.triangle_pairs(a, b, 777, threads=1)

    assert len(alone) > 5000
    assert len(some) == 777
    for threads in (2, 5, None):
        assert obbcli.triangle_pairs(a, b, threads=threads).tobytes() == alone.tobytes()
        assert obbcli.triangle_pairs(a, b, 777, threads=threads).tobytes() == some.tobytes()


@pytest.mark.parametrize("position", [0, 100, 200, 300, 399])
def test_damage_that_a_thread_meets_is_reported(position: int, tmp_path: Path) -> None:
    path = tmp_path / "crowd.obbt"
    whole = ObbTree.build(Mesh(*needles(400)))
    whole.save(path)
    damaged = bytearray(path.read_bytes())
    corners = FIXED.unpack_from(damaged)[2] + 64 * whole.node_count
    struct.pack_into("<I", damaged, corners + 12 * position, 2**31)
    crowd = ObbTree.from_bytes(bytes(damaged), verify=False)

    for threads in (1, 4):
        with pytest.raises(TreeFileError, match="vertex that is not there"):
            obbcli.triangle_pairs(crowd, crowd, threads=threads)


@pytest.mark.parametrize("threads", [1, 4])
def test_signals_end_the_work_of_all_threads(threads: int) -> None:
    # Nobody waits for the answers.
    crowd = ObbTree.build(Mesh(*needles(6000)))
    triangles = Triangle(np.random.default_rng(1).normal(size=(500_000, 3, 3)))
    box = Obb(np.zeros(3), np.eye(3), np.ones(3))
    running = threading.active_count()
    for ask in (
        lambda: obbcli.triangle_pairs(crowd, crowd, threads=threads),
        lambda: first_contact(box, triangles, 0, (1.0, 2.0, 3.0), 1.0, threads=threads),
    ):
        with pytest.raises(HeardError):
            ask_until_heard(ask)

    assert threading.active_count() == running


@pytest.mark.parametrize("count", [1, 511, 512, 513, 5000, 20_001])
def test_answers_of_arrays_do_not_depend_on_threads(count: int) -> None:
    triangles = Triangle(np.random.default_rng(2).normal(size=(count, 3, 3)))
    box = Obb(np.zeros(3), np.eye(3), np.ones(3))
    velocity, duration = (0.5, -0.25, 1.0), 1.0

    met: Any = intersects(box, triangles, 0, velocity, duration, threads=1)
    when: Any = first_contact(box, triangles, 0, velocity, duration, threads=1)

    assert np.array_equal(np.flatnonzero(met), when.rows)
    for threads in (2, 7, None):
        assert np.array_equal(intersects(box, triangles, 0, velocity, 1.0, threads=threads), met)
        other: Any = first_contact(box, triangles, 0, velocity, duration, threads=threads)
        for name in ("rows", "time", "last_time", "point", "normal"):
            assert getattr(other, name).tobytes() == getattr(when, name).tobytes()


def test_threads_are_those_asked_for_or_one_a_usable_core(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {1, 5, 6}, raising=False)
    assert usable_cores() == thread_count(None) == 3
    assert thread_count(7) == 7
    assert thread_count(10**9) == 256

    monkeypatch.delattr(os, "sched_getaffinity")
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert usable_cores() == 1


@pytest.mark.parametrize("threads", [0, -1, 1.5, True, "2"])
def test_number_of_threads_that_is_none_is_refused(threads: Any) -> None:
    crowd = Mesh(*soup(3))
    with pytest.raises(ObbError) as caught:
        obbcli.triangle_pairs(crowd, crowd, threads=threads)

    assert caught.value.where == "threads"
