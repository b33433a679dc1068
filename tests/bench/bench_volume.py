"""Volumes that two solids share: time and proven bracket, against manifold3d and its input."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from harness import OURS, Row, alternate
from meshes.surfaces import box, sphere
from scenes.pairs import random_rotation

import obbcli
from obbcli import kernels

if TYPE_CHECKING:
    from collections.abc import Iterator

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
ROUNDS, QUICK_ROUNDS = 7, 3
SAMPLE_SECONDS = 0.002
SELF_TESTED = f"{OURS}, looks for overlap with itself"
PEER = "manifold3d"


class Case(NamedTuple):
    """Two placed meshes, and what they share where that is known."""

    name: str
    a: obbcli.Body
    b: obbcli.Body
    truth: float | None = None


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a case; every volume is checked."""
    for case in cases(2_000 if quick else 20_000):
        rounds = QUICK_ROUNDS if quick else ROUNDS
        low, high = volume(case)
        peer = by_manifold(case)
        assert low <= high
        if case.truth is not None:
            assert low - 1e-12 <= case.truth <= high + 1e-12, case.name
        calls = {
            OURS: lambda case=case: volume(case),
            SELF_TESTED: lambda case=case: (volume(case), excesses(case)),
            PEER: lambda case=case: by_manifold(case),
        }
        off = max(low - peer, peer - high, 0.0)
        notes = {OURS: {"low": low, "high": high}, PEER: {"beyond the bracket by": off}}
        triangles = case.a.shape.triangle_count
        yield Row("volume", case.name, triangles, alternate(calls, rounds, SAMPLE_SECONDS), notes)


def cases(triangles: int) -> Iterator[Case]:
    """Yield pairs of solids whose surfaces cross, coincide, or are sliver-thin apart."""
    turn = random_rotation(3)
    ball, block = tree_of(sphere(triangles, 10.0)), tree_of(box(triangles))
    thin = tree_of(box(12, (100.0, 100.0, 1.0)))
    turned = obbcli.Pose(turn)
    yield Case("spheres, 2 deep", body(ball), body(ball, (18.0, 0.0, 0.0)))
    yield Case("sphere in its turned self", body(ball), obbcli.Body(ball, turned))
    sides = np.array((0.7, 0.0, 0.0))
    yield Case(
        "boxes with coincident sides, turned",
        obbcli.Body(block, turned),
        obbcli.Body(block, obbcli.Pose(turn, turn @ sides)),
    )
    yield Case("slabs, 1e-9 deep", body(thin), body(thin, (0.0, 0.0, 1.0 - 1e-9)))
    gear, pinion, bolt, nut = (
        obbcli.ObbTree.build(SAMPLES / name, lazy=False)
        for name in ("gear.stl", "pinion.stl", "bolt.ply", "nut.obj")
    )
    yield Case("gears, 0.5 too close", body(gear), body(pinion, (-0.5, 0.0, 0.0)))
    yield Case("bolt in nut, 0.1 further", body(bolt), body(nut, (0.0, 0.0, 0.1)))


def tree_of(surface: Any) -> obbcli.ObbTree:
    """Return the whole tree of a surface."""
    return obbcli.ObbTree.build(obbcli.Mesh(surface.vertices, surface.faces), lazy=False)


def body(tree: obbcli.ObbTree, shift: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> obbcli.Body:
    """Return a tree moved."""
    return obbcli.Body(tree, obbcli.Pose(translation=shift))


def volume(case: Case) -> tuple[float, float]:
    """Return the bracket of the kernels."""
    bodies = [x for one in (case.a, case.b) for x in (one.shape.kernel, one.pose.kernel)]
    query = kernels.ColumnVolume(*bodies)
    while not query.advance(2**40):
        pass
    return query.bounds


def excesses(case: Case) -> list[tuple[float, float]]:
    """Return by how much either overlaps itself in the common box."""
    bodies = [x for one in (case.a, case.b) for x in (one.shape.kernel, one.pose.kernel)]
    window = kernels.ColumnVolume(*bodies).window
    found = []
    for one in (case.a, case.b):
        query = kernels.SelfOverlap(one.shape.kernel, one.pose.kernel, window)
        while not query.advance(2**40):
            pass
        found.append(query.excess)
    return found


def by_manifold(case: Case) -> float:
    """Return the volume of manifold3d's intersection, its meshes made anew."""
    import manifold3d

    solids = []
    for one in (case.a, case.b):
        mesh = one.shape.mesh
        made = manifold3d.Mesh64(
            vert_properties=np.array(one.pose.apply(mesh.vertices)),
            tri_verts=mesh.triangles.astype(np.uint64),
        )
        made.merge()
        solids.append(manifold3d.Manifold(made))
    return float((solids[0] ^ solids[1]).volume())
