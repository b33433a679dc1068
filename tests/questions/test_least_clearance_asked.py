"""What may be asked about a least clearance, its limits, and trees that are damaged."""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING

import numpy as np
import pytest
from meshes.surfaces import sphere
from movers.answers import as_body
from movers.meshes import cube
from movers.random_pairs import random_pair
from oracles.tree_files import FIXED, forge

from obbcli import (
    Accuracy,
    Body,
    Mesh,
    Motion,
    MotionError,
    ObbTree,
    Pose,
    TreeFileError,
    clearance,
)

if TYPE_CHECKING:
    from pathlib import Path

CUBE = Mesh(*cube())
BALL = Mesh(sphere(80).vertices, sphere(80).faces)
MOST_POPS = 20_000


def moving(mesh, place, **motion):
    return Body(mesh, Pose(translation=place), Motion(**motion))


def test_at_least_nothing_always_holds():
    touching = moving(CUBE, (1, 0, 0), linear_velocity=(4, 0, 0))

    assert clearance(CUBE, touching, at_least=0.0).at_least.verdict == "holds"


def test_limits_leave_a_proven_bracket():
    a, b = random_pair("both_turning", 1)
    answer = clearance(as_body(a), as_body(b), 1.0, Accuracy(max_iterations=1))
    whole = clearance(as_body(a), as_body(b), 1.0)

    assert not answer.complete
    assert answer.minimum.bounds[0] <= whole.minimum.bounds[0]
    assert answer.minimum.bounds[1] >= whole.minimum.bounds[1]
    wanted = 0.5 * whole.minimum.bounds[1]
    opened = clearance(
        as_body(a), as_body(b), 1.0, Accuracy(max_iterations=1), at_least=max(wanted, 0.01)
    )
    assert opened.at_least.verdict in ("open", "violated")


@pytest.mark.parametrize("name", ["clearance", "time_tolerance", "max_depth_a", "leaves"])
def test_accuracy_that_says_nothing_is_refused(name):
    value = "boxes" if name == "leaves" else 1
    with pytest.raises(MotionError, match=name):
        clearance(CUBE, CUBE, accuracy=Accuracy(**{name: value}))


@pytest.mark.parametrize(
    "wrong",
    [{"tolerance": 0}, {"tolerance": 1}, {"tolerance": math.nan}, {"tolerance": "1"},
     {"at_least": -1}, {"at_least": math.inf}, {"at_least": True}],
    ids=str,
)  # fmt: skip
def test_arguments_that_mean_nothing_are_refused(wrong):
    with pytest.raises(MotionError, match=next(iter(wrong))):
        clearance(CUBE, CUBE, **wrong)


def hurt(data, start, random):
    """Write a value that hurts somewhere behind the header."""
    values = [
        random.bytes(8),
        struct.pack("<II", *random.integers(0, 64, 2).tolist()),
        struct.pack("<d", np.nan),
        struct.pack("<ff", -np.inf, np.nan),
    ]
    width = int(random.choice([2, 4, 8]))
    place = start + width * int(random.integers((len(data) - start) // width))
    data[place : place + width] = values[random.integers(len(values))][:width]


@pytest.mark.parametrize("leaf_size", [1, 3])
def test_questions_about_damaged_trees_end(leaf_size: int, tmp_path: Path) -> None:
    path = tmp_path / "made.obbt"
    ObbTree.build(BALL, leaf_size=leaf_size).save(path)
    data = path.read_bytes()
    start = FIXED.unpack_from(data)[2]
    random = np.random.default_rng(7)
    limits = Accuracy(max_iterations=MOST_POPS)
    seen = set()

    for _ in range(40):
        damaged = bytearray(data)
        for _ in range(random.integers(1, 6)):
            hurt(damaged, start, random)
        try:
            tree = ObbTree.from_bytes(forge(bytes(damaged)), verify=False)
            spin = {"angular_velocity": (0.5, 1, 0), "linear_velocity": (1, 0, 0)}
            a, b = moving(tree, (0, 0, 0), **spin), moving(BALL, (2.5, 2.2, 0))
            for bodies in ((a, b), (b, a)):
                answer = clearance(*bodies, 1.0, limits)
                low, high = answer.minimum.bounds
                assert high is None or low <= high
            seen.add("answered")
        except (TreeFileError, MotionError):
            seen.add("refused")

    assert seen == {"answered", "refused"}
