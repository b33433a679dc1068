"""Pairs of solids that overlap, with what is known of how thick they do: all in a common turn."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from meshes.solids import joined, shifted, turned_over
from meshes.surfaces import box as fine_box
from meshes.surfaces import sphere
from movers.meshes import disc
from overlap.test_thickness import ring
from scenes.pairs import random_rotation

import obbcli

if TYPE_CHECKING:
    from collections.abc import Iterator

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
TURN = random_rotation(np.random.default_rng(7))


@dataclass(frozen=True, eq=False)
class OverlapPair:
    """Two solids as vertices and faces, the truth where a closed form has it, depths to ask for."""

    name: str
    a: Any
    b: Any
    truth: float | None
    limits: tuple[float, ...]


def overlap_pairs(quick: bool) -> Iterator[OverlapPair]:
    """Yield the pairs, those of few triangles alone where it is to be quick."""
    for triangles in (3_000,) if quick else (3_000, 60_000):
        yield _turned("slabs", _slab(triangles, 0.0), _slab(triangles, 0.9), 0.1, (0.09, 0.2))
        yield _turned("beam in a block", *_beam(triangles), 1.0, (0.9, 1.1))
    for triangles in (9_680,) if quick else (9_680, 103_680):
        ball = sphere(triangles, 10.0)
        mesh = ball.vertices, ball.faces
        yield _turned("spheres, 2 deep", mesh, shifted(mesh, (18, 0, 0)), None, (0.5, 3.0))
    pins = ((32, 48, 0.0), (32, 32, 0.005), (100, 120, 0.0))
    for pin, hole, excess in pins:
        name = f"pin of {pin} in hole of {hole} facets, +{excess:g}"
        bodies = disc(pin, 5 + excess, 0, 30), ring(hole, 5, 10, 10, 20)
        yield _turned(name, *bodies, None, (0.001, 0.01, 0.1))
    ball = sphere(2_000, 5.0)
    socket = fine_box(12, (14.0, 14.0, 14.0))
    hollow = turned_over((sphere(2_420, 5.0).vertices, sphere(2_420, 5.0).faces))
    block = joined(shifted((socket.vertices, socket.faces), (-7, -7, -7)), hollow)
    yield _turned("ball in socket", (ball.vertices, ball.faces), block, None, (0.01, 0.1))
    for rise in (0.1, 0.5):
        bolt, nut = (_sample(name) for name in ("bolt.ply", "nut.obj"))
        limits = (0.01, 0.1)
        yield _turned(f"bolt in nut, +{rise:g}", bolt, shifted(nut, (0, 0, rise)), None, limits)


def _turned(name: str, a: Any, b: Any, truth: float | None, limits: Any) -> OverlapPair:
    """Return a pair in a frame that nothing is aligned with."""
    a, b = ((np.asarray(v, dtype=np.float64) @ TURN.T, np.asarray(f)) for v, f in (a, b))
    return OverlapPair(name, a, b, truth, limits)


def _slab(triangles: int, height: float) -> Any:
    slab = fine_box(triangles, (100.0, 100.0, 1.0))
    return shifted((slab.vertices, slab.faces), (3 * height, 2 * height, height))


def _beam(triangles: int) -> tuple[Any, Any]:
    beam, block = fine_box(triangles, (1.0, 1.0, 10.0)), fine_box(triangles, (5.0, 5.0, 5.0))
    return (beam.vertices, beam.faces), shifted((block.vertices, block.faces), (-2, -2, 8.5))


def _sample(name: str) -> Any:
    mesh = obbcli.load_mesh(SAMPLES / name)
    return mesh.vertices, mesh.triangles
