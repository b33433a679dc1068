"""Questions of damaged trees end: with an answer from what they hold, or with a clean refusal."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from meshes.nasty import bumpy_grid, soup
from oracles.tree_files import FIXED, forge

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, ObbTree, Pose, TreeFileError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

X, Z = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


def file_of(surface: Any, folder: Path, **options: Any) -> bytes:
    path = folder / "made.obbt"
    ObbTree.build(Mesh(*surface), **options).save(path)
    return path.read_bytes()


def answers(data: bytes) -> list[str]:
    """Return what every question says of an unverified tree: an answer, or a clean refusal."""
    try:
        tree = ObbTree.from_bytes(data, verify=False)
    except TreeFileError:
        return ["refused"]
    said = []
    for ask in _questions(tree):
        try:
            ask()
        except TreeFileError:
            said.append("refused")
        else:
            said.append("answered")
    return said


def _questions(tree: ObbTree) -> Iterator[Any]:
    limits = Accuracy(max_iterations=20_000)
    turned = Body(tree, Pose((0.3, -0.2, 0.5), (0.25, 0.0, 0.0)))
    yield lambda: obbcli.collide(tree, turned, accuracy=limits)
    yield lambda: obbcli.collide(turned, tree, accuracy=Accuracy(max_depth_a=2, leaves="boxes"))
    yield lambda: obbcli.triangle_pairs(tree, tree)
    yield lambda: obbcli.distance(tree, Body(tree, Pose(None, (9.0, 0.0, 0.0))), limits)
    for motion in (Motion(X), Motion(X, Z), Motion(None, Z, (3.0, 0.0, 0.0))):
        moving = Body(tree, turned.pose, motion)
        yield lambda moving=moving: obbcli.first_contact(moving, tree, 1.0, limits)
    yield tree.check
    yield lambda: tree.levels


def test_unverified_tree_with_a_flipped_byte_answers_or_refuses(tmp_path: Path) -> None:
    small = file_of(soup(3), tmp_path)
    random = np.random.default_rng(1)
    said = set()
    for position in range(FIXED.unpack_from(small)[2], len(small)):
        flipped = bytearray(small)
        flipped[position] ^= int(random.integers(1, 256))
        said.update(answers(bytes(flipped)))

    assert said == {"answered", "refused"}


@pytest.mark.parametrize("options", [{}, {"split": "center", "leaf_size": 3}], ids=str)
@pytest.mark.parametrize("surface", [soup(12), bumpy_grid(3)], ids=["soup", "grid"])
def test_questions_of_damaged_trees_end_with_an_answer_or_a_refusal(
    surface: Any, options: dict[str, Any], tmp_path: Path
) -> None:
    data = file_of(surface, tmp_path, **options)
    header_bytes = FIXED.unpack_from(data)[2]
    random = np.random.default_rng(2)
    said = set()
    for _ in range(100):
        damaged = bytearray(data)
        for _ in range(random.integers(1, 12)):
            _damage(damaged, header_bytes, random)
        said.update(answers(forge(bytes(damaged))))

    assert said == {"answered", "refused"}


def _damage(data: bytearray, start: int, random: Any) -> None:
    """Write a value that hurts over two, four or eight bytes somewhere in the data."""
    kind = random.choice(["random", "count", "small", "nan", "infinity", "huge"])
    values = {
        "random": random.bytes(8),
        "count": struct.pack("<II", *random.integers(0, 64, 2).tolist()),
        "small": struct.pack("<II", 2**32 - 1, 0),
        "nan": struct.pack("<d", np.nan),
        "infinity": struct.pack("<ff", -np.inf, np.nan),
        "huge": struct.pack("<d", 1.7e308),
    }
    width = int(random.choice([2, 4, 8]))
    place = start + width * int(random.integers((len(data) - start) // width))
    data[place : place + width] = values[str(kind)][:width]


def _with_nan(data: bytes, place: int, kind: str) -> ObbTree:
    """Return the unverified tree whose number at a place is none."""
    damaged = bytearray(data)
    struct.pack_into(f"<{kind}", damaged, place, np.nan)
    return ObbTree.from_bytes(bytes(damaged), verify=False)


def test_box_that_is_no_number_separates_nothing(tmp_path: Path) -> None:
    tree = ObbTree.build(Mesh(*soup(12)))
    data = file_of(soup(12), tmp_path)
    pairs = obbcli.triangle_pairs(tree, tree).tolist()
    start = FIXED.unpack_from(data)[2]
    # A box: three doubles, then seven floats.
    numbers = [(8 * k, "d") for k in range(3)] + [(24 + 4 * k, "f") for k in range(7)]
    for slot in range(tree.node_count):
        for offset, kind in numbers:
            damaged = _with_nan(data, start + 64 * slot + offset, kind)

            assert obbcli.triangle_pairs(damaged, tree).tolist() == pairs
            assert obbcli.triangle_pairs(tree, damaged).tolist() == pairs


def test_triangle_that_is_no_number_is_not_separated_from_a_box(tmp_path: Path) -> None:
    far = Mesh(soup(5)[0] + 100.0, soup(5)[1])
    data = file_of(soup(1), tmp_path)
    roots = Accuracy(max_depth_a=0, max_depth_b=0)
    assert not obbcli.collide(ObbTree.from_bytes(data), far, accuracy=roots).collides
    for k in range(9):
        # Corners and id of the one triangle take 64 bytes each; its vertices follow.
        damaged = _with_nan(data, FIXED.unpack_from(data)[2] + 128 + 8 * k, "d")

        assert obbcli.collide(damaged, far, accuracy=roots).collides
        assert obbcli.collide(far, damaged, accuracy=roots).collides


def test_damaged_tree_of_one_triangle_is_refused_by_every_question(tmp_path: Path) -> None:
    # Its triangle is read when the question is put, not when it is advanced.
    damaged = bytearray(file_of(soup(1), tmp_path))
    struct.pack_into("<I", damaged, FIXED.unpack_from(damaged)[2] + 8, 3)
    tree = ObbTree.from_bytes(bytes(damaged), verify=False)

    for ask in (obbcli.collide, obbcli.triangle_pairs):
        for pair in ((tree, Mesh(*soup(2))), (Mesh(*soup(2)), tree)):
            with pytest.raises(TreeFileError, match="uses a vertex that is not there"):
                ask(*pair)


@pytest.mark.parametrize("triangle_count", [1, 12])
def test_vertex_that_is_no_number_is_the_trees_fault_and_not_the_motions(
    triangle_count: int, tmp_path: Path
) -> None:
    data = file_of(soup(triangle_count), tmp_path)
    far = Mesh(soup(3)[0] + 20.0, soup(3)[1])
    fast = Motion((1.0, 1.0, 1.0), (0.0, 0.0, 1.0))
    start = data.rindex(soup(triangle_count)[0].tobytes())
    damaged = bytearray(data)
    for place in range(start, start + 72 * triangle_count, 8):
        struct.pack_into("<d", damaged, place, np.nan)
    tree = ObbTree.from_bytes(bytes(damaged), verify=False)

    for pair in ((tree, far), (far, tree)):
        with pytest.raises(TreeFileError, match="build it again"):
            obbcli.distance(*pair)
        with pytest.raises(TreeFileError, match="build it again"):
            obbcli.first_contact(Body(pair[0], motion=fast), Body(pair[1], motion=Motion(X, Z)))


@pytest.mark.parametrize("triangle_count", [1, 12])
def test_vertex_of_an_opened_file_that_is_no_number_is_not_read_as_one(
    triangle_count: int, tmp_path: Path
) -> None:
    data = bytearray(file_of(soup(triangle_count), tmp_path))
    start = data.rindex(soup(triangle_count)[0].tobytes())
    for place in range(start, start + 72 * triangle_count, 24):
        struct.pack_into("<d", data, place, np.inf)
    path = tmp_path / "damaged.obbt"
    path.write_bytes(data)

    with pytest.raises(TreeFileError, match="a vertex is not made of usable numbers"):
        obbcli.collide(ObbTree.open(path, verify=False), Mesh(*soup(triangle_count)))


def test_box_that_is_no_number_is_the_trees_fault_and_not_the_motions(tmp_path: Path) -> None:
    data = file_of(soup(12), tmp_path)
    damaged = _with_nan(data, FIXED.unpack_from(data)[2], "d")

    for motion in (Motion(X), Motion(X, Z, (0.0, 0.0, 0.0))):
        with pytest.raises(TreeFileError, match="a box is not made of usable numbers"):
            obbcli.first_contact(Body(damaged, motion=motion), Mesh(soup(3)[0] + 20.0, soup(3)[1]))
