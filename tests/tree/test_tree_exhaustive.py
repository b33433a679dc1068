"""Every flipped byte and every link of a small tree file, and sections in each other's place."""

from __future__ import annotations

import contextlib
import itertools
from typing import TYPE_CHECKING

import numpy as np
import pytest
from meshes.nasty import soup
from oracles import tree_files as tree_oracles
from oracles.tree_files import FIXED, NODE
from tree_files.opened import data_blocks

import obbcli
from obbcli import Body, Mesh, Motion, ObbTree, Pose, TreeFileError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

OTHER = Mesh(*soup(4, 5))
MOVING = Body(OTHER, Pose(None, (9.0, 0.0, 0.0)), Motion((-9.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
QUESTIONS: tuple[Callable[[ObbTree], object], ...] = (
    lambda tree: obbcli.triangle_pairs(tree, OTHER).tolist(),
    lambda tree: obbcli.distance(tree, MOVING).bounds,
    lambda tree: str(obbcli.first_contact(tree, MOVING).time_bounds),
    lambda tree: (tree.check(), tree.mesh.vertices.tolist())[1],
)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "small.obbt"
    ObbTree.build(Mesh(*soup(5))).save(path)
    return path


def answers(path: Path, verify: bool) -> list[object]:
    """Return the answer to every question about the file; None: refused."""
    found: list[object] = [None] * len(QUESTIONS)
    try:
        tree = ObbTree.open(path, verify=verify)
    except TreeFileError:
        return found
    for number, question in enumerate(QUESTIONS):
        with contextlib.suppress(TreeFileError):
            found[number] = question(tree)
    return found


def test_every_flipped_byte_is_refused_or_changes_no_answer(path: Path) -> None:
    whole = path.read_bytes()
    sound = answers(path, True)
    assert None not in sound
    refused = 0
    for position in range(len(whole)):
        damaged = bytearray(whole)
        damaged[position] ^= 1 << position % 8
        path.write_bytes(damaged)

        for found, wanted in zip(answers(path, True), sound, strict=True):
            assert found is None or found == wanted
            refused += found is None

    assert refused == len(whole) * len(QUESTIONS)


def test_every_link_is_refused_or_leads_to_an_answer(path: Path) -> None:
    whole = path.read_bytes()
    start = data_blocks(path)[0]
    count = FIXED.unpack_from(whole)[6]
    sound = answers(path, True)
    values = (*range(count + 3), 2**31, 2**32 - 1)
    for slot, name, value in itertools.product(range(count), ("split", "right"), values):
        data = bytearray(whole)
        node = np.frombuffer(data, NODE, 1, start + slot * NODE.itemsize)
        is_same = node[name][0] == value
        node[name][0] = value
        path.write_bytes(tree_oracles.forge(bytes(data)))

        for verify in (True, False):
            found = answers(path, verify)

            # Of two triangles under a box no link says where they are.
            assert found[-1] is None or found == sound
            assert not is_same or found == sound
            assert is_same or name == "right" or found[-1] is None


@pytest.mark.parametrize(("first", "second"), [*itertools.combinations(range(4), 2)])
@pytest.mark.parametrize("is_forged", [True, False])
def test_sections_in_each_others_place_are_refused(
    path: Path, first: int, second: int, is_forged: bool
) -> None:
    whole = path.read_bytes()
    start = data_blocks(path)[0]
    nodes, triangles, vertices = FIXED.unpack_from(whole)[6:9]
    lengths = (64 * nodes, 12 * triangles, 4 * triangles, 24 * vertices)
    starts = [start + sum(-(-n // 64) * 64 for n in lengths[:k]) for k in range(4)]
    size = min(lengths[first], lengths[second])
    data = bytearray(whole)
    data[starts[first] : starts[first] + size] = whole[starts[second] : starts[second] + size]
    data[starts[second] : starts[second] + size] = whole[starts[first] : starts[first] + size]
    path.write_bytes(tree_oracles.forge(bytes(data)) if is_forged else data)

    assert answers(path, True)[-1] is None
    assert answers(path, False)[-1] is None
