"""Tree files: refused, or the answers of the undamaged; with forged checksums, an end."""

from __future__ import annotations

import functools
import struct
import tempfile
from pathlib import Path
from random import Random
from typing import Any

from fuzz.kinds import Target, require
from meshes.nasty import bumpy_grid, needles, soup
from oracles import tree_files as tree_oracles

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, ObbTree, Pose
from obbcli.errors import ObbError, TreeFileError

_OTHER = Mesh(*soup(5, 9))
_SLOW = Accuracy(max_iterations=2000)
_MOVING = Motion((0.5, -1.0, 0.25), (0.0, 0.5, 1.0), (0.0, 0.0, 0.0))
_QUESTIONS: tuple[Any, ...] = (
    lambda tree: obbcli.triangle_pairs(tree, Body(tree, Pose(translation=(0.5, 0, 0)))).tolist(),
    lambda tree: obbcli.triangle_pairs(tree, _OTHER).tolist(),
    lambda tree: repr(obbcli.distance(tree, Body(_OTHER, Pose(None, (30.0, 0, 0)))).bounds),
    lambda tree: repr(
        obbcli.first_contact(
            tree, Body(_OTHER, Pose(None, (9.0, 0, 0)), _MOVING), 5.0, _SLOW
        ).time_bounds
    ),
    lambda tree: (tree.check(), tree.mesh.vertices.tolist())[1],
)


@functools.cache
def _files() -> tuple[bytes, ...]:
    surfaces = soup(1), soup(2), soup(12), needles(9), bumpy_grid(6)
    files = []
    for number, surface in enumerate(surfaces):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "made.obbt"
            ObbTree.build(Mesh(*surface), leaf_size=1 + number % 2).save(path)
            files.append(path.read_bytes())
    return tuple(files)


def _answers(data: bytes, verify: bool) -> list[object]:
    """Return the answer to every question, None where it was refused, from memory and a file."""
    answers: list[object] = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "read.obbt"
        path.write_bytes(data)
        for opened in (
            lambda: ObbTree.from_bytes(data, verify=verify),
            lambda: ObbTree.open(path, verify=verify),
        ):
            for question in _QUESTIONS:
                try:
                    answers.append(question(opened()))
                except ObbError as fault:
                    answers.append(None if isinstance(fault, TreeFileError) else str(fault))
    return answers


@functools.cache
def _sound(number: int) -> list[object]:
    return _answers(_files()[number], True)


def _run_damaged(data: bytes) -> None:
    """Damage a file as the bytes say: which file, a seed, and for each change what, where, to."""
    number = (data[0] if data else 0) % len(_files())
    damaged = bytearray(_files()[number])
    for start in range(1, len(data) - 3, 4):
        kind, place, value = (
            data[start],
            int.from_bytes(data[start + 1 : start + 3], "little"),
            data,
        )
        at = place % max(len(damaged), 1)
        _change(damaged, kind % 5, at, value[start + 3])
    if data and data[-1] % 2 == 1:
        _answers(_forged(bytes(damaged)), data[-1] % 4 == 1)
        return
    for found, wanted in zip(_answers(bytes(damaged), True), _sound(number), strict=True):
        require(found is None or found == wanted, "damage is refused or changes nothing")


def _forged(data: bytes) -> bytes:
    """Return the bytes with checksums that fit, or as they are where no header is left."""
    try:
        return tree_oracles.forge(data)
    except (struct.error, IndexError):
        return data


def _change(data: bytearray, kind: int, at: int, value: int) -> None:
    if kind == 0:
        data[at : at + 1] = bytes([value])
    elif kind == 1:
        del data[at:]
    elif kind == 2:  # two blocks change places
        size, other = 1 << value % 10, (at * 7 + value) % max(len(data), 1)
        data[at : at + size], data[other : other + size] = (
            data[other : other + size],
            data[at : at + size],
        )
    elif kind == 3:
        wide = (0, 1, 2**31, 2**32 - 1, 2**63, 2**64 - 1)[value % 6].to_bytes(8, "little")
        data[at : at + 4 + 4 * (value & 1)] = wide[: 4 + 4 * (value & 1)]
    else:
        data[at:at] = bytes([value]) * (value % 9)


def _programs() -> list[bytes]:
    random = Random(0)
    return [bytes([k]) + random.randbytes(1 + 4 * (k % 3 + 1)) for k in range(20)]


def _run_bytes(data: bytes) -> None:
    for verify in (True, False):
        _answers(data, verify)


TARGETS = {
    "tree-damage": Target(_programs, _run_damaged),
    "tree-bytes": Target(lambda: list(_files()), _run_bytes),
}
