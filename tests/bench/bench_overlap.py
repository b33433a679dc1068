"""How thick overlaps are: time to a bracket of 1 % and to decisions, and what others say of depth.

Trees are warm. The depths of python-fcl, coal and trimesh are the largest over their contacts;
manifold3d tells the volume, with the making of its input, beside ours by columns.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from harness import OURS, Row, alternate
from overlap_sets import overlap_pairs

from obbcli import Mesh, ObbTree, Pose, kernels

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from overlap_sets import OverlapPair

    Calls = dict[str, Callable[[], object]]

ROUNDS = 5
TOLERANCE = 0.01
MOST_CONTACTS = 100_000
HERE = Pose().kernel


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a pair; every bracket is held against the others and the truth."""
    for pair in overlap_pairs(quick):
        trees = [ObbTree.build(Mesh(*mesh)) for mesh in (pair.a, pair.b)]
        size = max(float(np.linalg.norm(np.ptp(v, axis=0))) for v, _ in (pair.a, pair.b))
        calls = _ours(trees, size, pair)
        value = calls[OURS]()
        volume = calls[f"{OURS} volume"]()
        low, high = value.bounds
        assert pair.truth is None or low - 1e-12 * size <= pair.truth <= high + 1e-12 * size
        notes: dict[str, dict[str, object]] = {
            OURS: {"low": low, "high": high, "cells": value.cells}
        }
        for k, limit in enumerate(pair.limits):
            decided = calls[_decision(k)]()
            assert decided.deeper is None or decided.deeper is (limit < low) or low <= limit <= high
            notes[OURS][f"> {limit:g}"] = f"{decided.deeper} ({decided.cells} cells)"
        peers = _peers(pair)
        for who, call in peers.items():
            notes[who] = {"volume" if who == "manifold3d" else "depth": call()}
        least, most = volume.bounds
        room = 1e-9 * abs(most)
        assert least - room <= notes["manifold3d"]["volume"] <= most + room
        rounds = 1 if quick else ROUNDS
        yield Row("overlap", pair.name, len(pair.a[1]), alternate(calls | peers, rounds), notes)


def _ours(trees: Any, size: float, pair: OverlapPair) -> Calls:
    """Return the kernels' questions: the value, a decision a limit, and the volume."""
    bodies = trees[0].kernel, HERE, trees[1].kernel, HERE

    def thickness(limit: float | None) -> Any:
        query = kernels.ThicknessQuery(
            *bodies,
            tolerance=TOLERANCE,
            deeper_than=limit,
            floor=1e-9 * size,
            max_cells=200_000,
        )
        return _finished(query)

    calls: Calls = {OURS: lambda: thickness(None)}
    for k, limit in enumerate(pair.limits):
        calls[_decision(k)] = lambda limit=limit: thickness(limit)
    calls[f"{OURS} volume"] = lambda: _finished(kernels.ColumnVolume(*bodies))
    return calls


def _decision(number: int) -> str:
    return f"{OURS} decision {number + 1}"


def _finished(query: Any) -> Any:
    while not query.advance(2**40):
        pass
    return query


def _peers(pair: OverlapPair) -> Calls:
    """Return what others are asked: depth over all contacts, and manifold3d's volume."""
    return {
        "python-fcl": _fcl(pair),
        "coal": _coal(pair),
        "trimesh": _trimesh(pair),
        "manifold3d": _manifold(pair),
    }


def _fcl(pair: OverlapPair) -> Callable[[], float]:
    import fcl

    bodies = []
    for vertices, faces in (pair.a, pair.b):
        model = fcl.BVHModel()
        model.beginModel(len(faces), len(vertices))
        model.addSubModel(vertices, faces)
        model.endModel()
        bodies.append(fcl.CollisionObject(model, fcl.Transform()))
    request = fcl.CollisionRequest(num_max_contacts=MOST_CONTACTS, enable_contact=True)

    def depth() -> float:
        result = fcl.CollisionResult()
        fcl.collide(*bodies, request, result)
        return max((abs(c.penetration_depth) for c in result.contacts), default=0.0)

    return depth


def _coal(pair: OverlapPair) -> Callable[[], float]:
    import coal

    models = []
    for vertices, faces in (pair.a, pair.b):
        model = coal.BVHModelOBB()
        model.beginModel(len(faces), len(vertices))
        model.addVertices(vertices)
        model.addTriangles(faces)
        model.endModel()
        models.append(model)
    request, place = coal.CollisionRequest(), coal.Transform3s()
    request.num_max_contacts, request.enable_contact = MOST_CONTACTS, True

    def depth() -> float:
        result = coal.CollisionResult()
        coal.collide(models[0], place, models[1], place, request, result)
        contacts = map(result.getContact, range(result.numContacts()))
        return max((abs(c.penetration_depth) for c in contacts), default=0.0)

    return depth


def _trimesh(pair: OverlapPair) -> Callable[[], float]:
    import trimesh

    manager = trimesh.collision.CollisionManager()
    for name, (vertices, faces) in (("a", pair.a), ("b", pair.b)):
        manager.add_object(name, trimesh.Trimesh(vertices, faces, process=False))

    def depth() -> float:
        _, contacts = manager.in_collision_internal(return_data=True)
        return max((abs(c.depth) for c in contacts), default=0.0)

    return depth


def _manifold(pair: OverlapPair) -> Callable[[], float]:
    import manifold3d

    def volume() -> float:
        solids = [
            manifold3d.Manifold(
                manifold3d.Mesh64(
                    vert_properties=np.ascontiguousarray(vertices),
                    tri_verts=np.ascontiguousarray(faces, dtype=np.uint64),
                )
            )
            for vertices, faces in (pair.a, pair.b)
        ]
        return float((solids[0] ^ solids[1]).volume())

    return volume
