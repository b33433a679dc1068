"""Overlap queries of damaged trees end: with bounds, or with a clean refusal."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from meshes.surfaces import sphere
from movers.meshes import box
from oracles.tree_files import FIXED, forge
from overlap.asking import ANY_NUMBER, Solid, protrusion, solid

from obbcli import Mesh, ObbTree, Pose, TreeFileError, kernels

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

BALL = sphere(80).vertices, sphere(80).faces
TURNED = Pose((0.3, -0.2, 0.5), (0.25, 0.0, 0.0))
MOST_CELLS = 40


def file_of(mesh: Any, folder: Path, **options: Any) -> bytes:
    path = folder / "made.obbt"
    ObbTree.build(Mesh(*mesh), **options).save(path)
    return path.read_bytes()


def queries(a: ObbTree, pose_a: Pose, b: ObbTree, pose_b: Pose) -> Iterator[Any]:
    """Yield the making of each kind of query."""
    bodies = a.kernel, pose_a.kernel, b.kernel, pose_b.kernel
    asked = {"tolerance": 0.01, "floor": 1e-9, "max_cells": MOST_CELLS}
    yield lambda: kernels.ThicknessQuery(*bodies, **asked)
    yield lambda: kernels.ProtrusionQuery(*bodies, **asked)
    yield lambda: kernels.ProtrusionQuery(*bodies, **asked, inside_only=False)
    yield lambda: kernels.ProtrusionQuery(*bodies, **asked, deeper_than=0.1)
    yield lambda: kernels.OverlapRegions(*bodies, **asked, resolution=0.1)
    yield lambda: kernels.ColumnVolume(*bodies)
    yield lambda: kernels.SelfOverlap(*bodies[:2])


def outcomes(damaged: ObbTree, good: ObbTree) -> Iterator[str]:
    """Yield what becomes of each query in which a damaged tree has a part."""
    here = Pose()
    for bodies in ((damaged, here, good, TURNED), (good, TURNED, damaged, here)):
        for make in queries(*bodies):
            try:
                query = make()
                while not query.advance(ANY_NUMBER):
                    pass
            except kernels.TreeError:
                yield "refused"
            else:
                require_sound(query)
                yield "answered"


def require_sound(query: Any) -> None:
    """Require that a finished query kept its limit, and that its brackets are brackets."""
    if isinstance(query, kernels.OverlapRegions):
        for low, high, _, thickness, _, _ in query.regions:
            assert thickness[0] <= thickness[1]
            assert all(x <= y for x, y in zip(low, high, strict=True))
        return
    if isinstance(query, kernels.SelfOverlap):
        brackets = query.volume, query.excess
    else:
        brackets = (query.bounds,)
    assert all(low <= high for low, high in brackets)
    assert getattr(query, "cells", 0) <= MOST_CELLS


def hurt(data: bytearray, start: int, random: np.random.Generator) -> None:
    """Write a value that hurts somewhere behind the header."""
    values = [
        random.bytes(8),
        struct.pack("<II", *random.integers(0, 64, 2).tolist()),
        struct.pack("<II", 2**32 - 1, 0),
        struct.pack("<d", np.nan),
        struct.pack("<ff", -np.inf, np.nan),
    ]
    width = int(random.choice([2, 4, 8]))
    place = start + width * int(random.integers((len(data) - start) // width))
    data[place : place + width] = values[random.integers(len(values))][:width]


@pytest.mark.parametrize("options", [{}, {"split": "center", "leaf_size": 3}], ids=str)
def test_queries_of_damaged_trees_end(options: dict[str, Any], tmp_path: Path) -> None:
    data = file_of(BALL, tmp_path, **options)
    good = ObbTree.build(Mesh(*BALL))
    start = FIXED.unpack_from(data)[2]
    random = np.random.default_rng(4)
    seen = set()

    for _ in range(40):
        damaged = bytearray(data)
        for _ in range(random.integers(1, 6)):
            hurt(damaged, start, random)
        try:
            tree = ObbTree.from_bytes(forge(bytes(damaged)), verify=False)
        except TreeFileError:
            continue
        seen.update(outcomes(tree, good))

    assert seen == {"answered", "refused"}


@pytest.mark.parametrize("inside_only", [True, False])
def test_box_that_is_no_number_hides_nothing(tmp_path: Path, inside_only: bool) -> None:
    block = solid(box((0, 0, 0), (2, 2, 2)))
    tip = solid(box((0.5, 0.5, 1.5), (1, 1, 5)))
    data = file_of((np.asarray(block.tree.mesh.vertices), block.faces), tmp_path)
    start = FIXED.unpack_from(data)[2]
    true = [
        protrusion(a, b, inside_only=inside_only).bounds for a, b in ((block, tip), (tip, block))
    ]

    numbers = [(8 * k, "d") for k in range(3)] + [(24 + 4 * k, "f") for k in range(7)]
    for slot in range(block.tree.node_count):
        for offset, kind in numbers:
            damaged = bytearray(data)
            struct.pack_into(f"<{kind}", damaged, start + 64 * slot + offset, np.nan)
            tree = ObbTree.from_bytes(bytes(damaged), verify=False)
            hurt_block = Solid(tree, Pose(), block.vertices, block.faces)
            for (low, high), (a, b) in zip(
                true, ((hurt_block, tip), (tip, hurt_block)), strict=True
            ):
                found = protrusion(a, b, inside_only=inside_only, max_cells=500).bounds
                assert found[0] <= high
                assert low <= found[1]


def test_box_that_is_no_number_hides_no_volume(tmp_path: Path) -> None:
    block, tip = box((0, 0, 0), (2, 2, 2)), box((0.5, 0.5, 1.5), (1, 1, 5))
    data = file_of(block, tmp_path)
    start = FIXED.unpack_from(data)[2]
    other = ObbTree.build(Mesh(*tip)).kernel

    for slot in range(11):
        for offset in (0, 8, 24, 36, 40):
            damaged = bytearray(data)
            struct.pack_into(
                "<d" if offset < 24 else "<f", damaged, start + 64 * slot + offset, np.nan
            )
            tree = ObbTree.from_bytes(bytes(damaged), verify=False).kernel
            query = kernels.ColumnVolume(tree, Pose().kernel, other, Pose().kernel)
            while not query.advance(ANY_NUMBER):
                pass
            low, high = query.bounds
            assert low <= 0.125 <= high
