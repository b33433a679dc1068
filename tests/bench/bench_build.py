"""Whole trees: seconds, by split and threads, and bytes a triangle in memory and on disk."""

from __future__ import annotations

import gc
import tempfile
from functools import partial
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

from harness import OURS, Row, alternate, resident_bytes
from meshes.surfaces import Surface, blob
from peers import CONTESTANTS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from contestant import Contestant

SIZES = {100_000: 9, 1_000_000: 5}
QUICK_SIZES = {10_000: 5, 100_000: 3}
SPLITS = ("compact", "median")
THREADS = (1, 2)


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a size."""
    for triangles, rounds in (QUICK_SIZES if quick else SIZES).items():
        surface = blob(triangles)
        calls = {one.name: partial(one.build, surface) for one in CONTESTANTS}
        for split, threads in product(SPLITS, THREADS):
            calls[f"{OURS} {split} x{threads}"] = partial(whole, surface, split, threads)
        notes = {one.name: bytes_a_triangle(one, surface) for one in CONTESTANTS}
        yield Row("build", "blob", len(surface.faces), alternate(calls, rounds), notes)


def whole(surface: Surface, split: Any, threads: int) -> object:
    """Return a whole tree that so many threads made; the mesh's own checks are part of it."""
    from obbcli import Mesh
    from obbcli.tree.growing import Growth
    from obbcli.tree.options import BuildOptions

    mesh = Mesh(surface.vertices, surface.faces)
    options = BuildOptions(split=split)
    return Growth(mesh, options, on_demand=False, threads=threads).arrays()


def bytes_a_triangle(one: Contestant, surface: Surface) -> dict[str, object]:
    """Return what a tree takes: as it says, as the process grows, and in its file."""
    count = len(surface.faces)
    gc.collect()
    before = resident_bytes()
    model = one.build(surface)
    after = resident_bytes()
    facts: dict[str, object] = {}
    told = one.nbytes(model)
    if told is not None:
        facts["B/tri told"] = round(told / count, 1)
    if before is not None and after is not None:
        facts["B/tri grown"] = round((after - before) / count, 1)
    with tempfile.TemporaryDirectory() as folder:
        size = one.save(model, Path(folder) / "tree")
    if size is not None:
        facts["B/tri file"] = round(size / count, 1)
    return facts
