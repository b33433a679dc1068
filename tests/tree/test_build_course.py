"""How a build goes on: memory, progress, interrupts, threads."""

from __future__ import annotations

import sys
import time
from concurrent.futures import ThreadPoolExecutor
from threading import Event, Thread
from typing import TYPE_CHECKING

import pytest
from meshes.nasty import soup

from obbcli import Mesh, MeshError, ObbTree

if TYPE_CHECKING:
    from pathlib import Path


def saved(tree: ObbTree, folder: Path) -> bytes:
    path = folder / "tree.obbt"
    tree.save(path)
    return path.read_bytes()


def test_build_refuses_more_memory_than_allowed() -> None:
    mesh = Mesh(*soup(1000))

    with pytest.raises(MeshError, match=r"needs about [0-9]+ bytes, 100000 are allowed"):
        ObbTree.build(mesh, max_memory=100_000)
    ObbTree.build(mesh, max_memory=10_000_000)


def test_progress_rises_from_0_to_1() -> None:
    shares: list[float] = []

    ObbTree.build(Mesh(*soup(60_000)), lazy=False, progress=shares.append)

    assert shares
    assert shares == sorted(shares)
    assert 0.0 <= shares[0] <= shares[-1] <= 1.0


def test_interrupt_in_progress_leaves_the_build_and_nothing_else() -> None:
    mesh = Mesh(*soup(60_000))

    def interrupt(share: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ObbTree.build(mesh, lazy=False, progress=interrupt)
    assert ObbTree.build(mesh, lazy=False).node_count == 59_999


def test_builds_in_threads_give_the_same_tree(tmp_path: Path) -> None:
    mesh = Mesh(*soup(5000))
    alone = saved(ObbTree.build(mesh), tmp_path)

    with ThreadPoolExecutor(4) as pool:
        trees = list(pool.map(lambda _: ObbTree.build(mesh, lazy=False), range(8)))

    assert all(saved(tree, tmp_path) == alone for tree in trees)


def test_other_threads_run_while_levels_are_counted() -> None:
    tree = ObbTree.build(Mesh(*soup(60_000)), lazy=False)
    turns = [0]
    is_over = Event()
    # A thread that waits runs once the system wakes it, which may take many counts.
    most_counts = 100_000

    def take_turns() -> None:
        while not is_over.is_set():
            turns[0] += 1
            time.sleep(0)

    interval = sys.getswitchinterval()
    # Nobody is interrupted: a thread runs only while another one lets it.
    sys.setswitchinterval(1e6)
    other = Thread(target=take_turns)
    other.start()
    seen = 0
    try:
        for _ in range(most_counts):
            before = turns[0]
            tree.kernel.levels()
            seen = turns[0] - before
            if seen > 0:
                break
    finally:
        sys.setswitchinterval(interval)
        is_over.set()
        other.join()

    assert seen > 0
