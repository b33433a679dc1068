"""Tree files keep every bit, and are written whole or not at all."""

from __future__ import annotations

import hashlib
import os
import runpy
import stat
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from meshes.nasty import NASTY, bumpy_grid, grid, soup
from oracles import tree_files as tree_oracles

import obbcli
from obbcli import Mesh, ObbTree, TreeFileError

if TYPE_CHECKING:
    from collections.abc import Callable

GOLDEN = Path(__file__).resolve().parents[1] / "data" / "tree" / "v1.obbt"

WRITE_UNDER_A_LIMIT = """
import resource, sys
import numpy as np
from obbcli import Mesh, ObbTree
tree = ObbTree.build(Mesh(np.arange(3000.0).reshape(-1, 3) % 17, np.arange(999).reshape(-1, 3)))
resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
try:
    tree.save(sys.argv[1])
except OSError as fault:
    sys.exit(f"refused: {fault.strerror}")
"""


def built(surface: Any, **options: Any) -> ObbTree:
    return ObbTree.build(Mesh(*surface), **options)


@pytest.mark.parametrize("name", NASTY)
def test_tree_file_round_trip_keeps_every_byte(name: str, tmp_path: Path) -> None:
    first, second = tmp_path / "first.obbt", tmp_path / "second.obbt"
    tree = built(NASTY[name](), leaf_size=2, lazy=False)
    written = tree.save(first)

    again = ObbTree.open(first)
    again.save(second)

    assert first.read_bytes() == second.read_bytes()
    assert first.stat().st_size == written
    assert tree.to_bytes() == again.to_bytes() == first.read_bytes()
    assert again.nbytes == tree.nbytes
    assert np.array_equal(again.mesh.triangles, tree.mesh.triangles)
    again.check()


def test_tree_from_bytes_is_the_tree_in_the_file(tmp_path: Path) -> None:
    path = tmp_path / "tree.obbt"
    tree = built(soup(50))
    tree.save(path)

    again = ObbTree.from_bytes(path.read_bytes(), "stdin")

    again.check()
    assert np.array_equal(again.mesh.triangles, tree.mesh.triangles)
    with pytest.raises(TreeFileError, match=r"^stdin: "):
        ObbTree.from_bytes(path.read_bytes()[:-1], "stdin")


@pytest.mark.parametrize(
    "given",
    [bytearray, lambda data: memoryview(bytearray(data)), lambda data: _every_other(data)],
    ids=["bytearray", "memoryview", "strided"],
)
def test_tree_from_bytes_that_can_change_is_its_own(given: Any, tmp_path: Path) -> None:
    path = tmp_path / "tree.obbt"
    tree = built(soup(50))
    tree.save(path)
    data = given(path.read_bytes())

    again = ObbTree.from_bytes(data)
    for place in range(len(data)):
        data[place] = 0

    again.check()
    assert np.array_equal(again.mesh.triangles, tree.mesh.triangles)


def _every_other(data: bytes) -> memoryview:
    """Return a view of the same bytes with others between them."""
    wide = bytearray(2 * len(data))
    wide[::2] = data
    return memoryview(wide)[::2]


def test_tree_file_carries_options_source_and_hash(tmp_path: Path) -> None:
    mesh_path = tmp_path / "dïsk \N{GREEK SMALL LETTER PHI}.off"
    mesh_path.write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 1 2 3\n")
    tree = ObbTree.build(mesh_path, fit="points", split="center", leaf_size=3, max_depth=5)
    path = tmp_path / "\N{SNOWMAN}.obbt"
    tree.save(path)

    again = ObbTree.open(str(path))

    assert again.source == mesh_path.name
    assert again.source_sha256 == hashlib.sha256(mesh_path.read_bytes()).hexdigest()
    assert (again.fit, again.split, again.leaf_size, again.max_depth) == ("points", "center", 3, 5)
    assert again.tool_version == obbcli.__version__
    assert tree_oracles.parse(path.read_bytes()).description["source"] == mesh_path.name


def test_tree_file_needs_no_mesh_file(tmp_path: Path) -> None:
    mesh_path, path = tmp_path / "m.off", tmp_path / "m.obbt"
    mesh_path.write_text("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n")
    ObbTree.build(mesh_path).save(path)
    mesh_path.unlink()

    assert obbcli.collide(path, path).collides


def test_tree_file_is_found_by_its_first_bytes_whatever_its_name(tmp_path: Path) -> None:
    path = tmp_path / "tree.stl"
    built(soup(5)).save(path)

    assert obbcli.triangle_pairs(path, path).shape[1] == 2


def test_saving_replaces_a_tree_file_and_leaves_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "tree.obbt"
    built(soup(5)).save(path)
    tree = built(soup(9))

    tree.save(path)

    assert ObbTree.open(path).triangle_count == 9
    assert [entry.name for entry in tmp_path.iterdir()] == ["tree.obbt"]
    assert stat.S_IMODE(path.stat().st_mode) == 0o666 & ~_umask()


def _umask() -> int:
    mask = os.umask(0o022)
    os.umask(mask)
    return mask


def test_saving_where_the_disk_is_full_keeps_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "tree.obbt"
    built(soup(5)).save(path)
    before = path.read_bytes()

    ended = subprocess.run(
        [sys.executable, "-c", WRITE_UNDER_A_LIMIT, str(path)],
        capture_output=True,
        text=True,
        check=False,
    )

    assert ended.stderr == "refused: File too large\n"
    assert path.read_bytes() == before
    assert [entry.name for entry in tmp_path.iterdir()] == ["tree.obbt"]


@pytest.mark.parametrize("step", ["fsync", "replace", "chmod"])
def test_saving_that_is_interrupted_keeps_the_old_file(
    step: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "tree.obbt"
    built(soup(5)).save(path)
    before = path.read_bytes()

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os if step == "fsync" else Path, step, interrupt)
    with pytest.raises(KeyboardInterrupt):
        built(soup(9)).save(path)

    assert path.read_bytes() == before
    assert [entry.name for entry in tmp_path.iterdir()] == ["tree.obbt"]


def test_saving_to_a_missing_folder_or_over_a_folder_leaves_nothing(tmp_path: Path) -> None:
    tree = built(soup(5))
    (tmp_path / "folder").mkdir()

    for path, error in (
        (tmp_path / "missing" / "tree.obbt", FileNotFoundError),
        (tmp_path / "folder", IsADirectoryError),
    ):
        with pytest.raises(error) as refused:
            tree.save(path)
        assert (refused.value.filename, refused.value.filename2) == (str(path), None)

    assert [entry.name for entry in tmp_path.iterdir()] == ["folder"]


def test_opening_what_is_not_there_or_no_file_is_an_os_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        ObbTree.open(tmp_path / "missing.obbt")
    with pytest.raises(IsADirectoryError):
        ObbTree.open(tmp_path)


def test_golden_file_of_version_1_reads_and_holds_its_mesh() -> None:
    mesh: Mesh = runpy.run_path(str(GOLDEN.with_name("make_v1.py")))["mesh"]()

    golden = ObbTree.open(GOLDEN)
    golden.check()
    read = tree_oracles.parse(GOLDEN.read_bytes())

    assert tree_oracles.faults(read, mesh.vertices, mesh.triangles) == []
    assert (golden.source, golden.source_sha256) == ("folded sheet.stl", "5a" * 32)
    assert (golden.split, golden.leaf_size, golden.max_depth) == ("center", 2, 7)
    assert golden.tool_version == "0.1.0"


# Of small ranges and of large ones, whatever the registers, threads and compiler.
FRESH = {
    ("triangles", "median"): "54516472a8268310",
    ("triangles", "center"): "2d8c809a92fa9956",
    ("triangles", "compact"): "3020eb39f0c6b1f3",
    ("points", "median"): "d8d5ed4d53af73f0",
    ("axis-aligned", "center"): "afd0cf241c61c64b",
}


@pytest.mark.parametrize("options", FRESH)
def test_fresh_tree_has_the_same_bytes_on_every_machine(options: tuple[Any, Any]) -> None:
    # All coordinates are small multiples of 1/64: no library function has a say in them.
    vertices, faces = grid(40, lambda x, y: (x * x - 3.0 * y + x * y * y / 8.0) / 8.0)
    tree = ObbTree.build(Mesh(vertices, faces), *options, lazy=False)

    arrays = tree._arrays
    digest = hashlib.sha256(arrays.nodes.tobytes() + arrays.triangle_ids.tobytes()).hexdigest()

    assert digest[:16] == FRESH[options]


def test_golden_file_meets_the_mesh_it_was_made_from() -> None:
    mesh: Mesh = runpy.run_path(str(GOLDEN.with_name("make_v1.py")))["mesh"]()
    every = np.arange(50)

    pairs = obbcli.triangle_pairs(GOLDEN, mesh)

    assert set(map(tuple, pairs.tolist())) >= set(zip(every.tolist(), every.tolist(), strict=True))
    assert np.array_equal(pairs, obbcli.triangle_pairs(mesh, mesh))


@pytest.mark.parametrize("change", ["shrinks", "is replaced", "is damaged", "vanishes"])
def test_check_reads_the_file_again(change: str, tmp_path: Path) -> None:
    path = tmp_path / "tree.obbt"
    built(bumpy_grid(6)).save(path)
    tree = ObbTree.open(path)
    changes: dict[str, Callable[[], object]] = {
        "shrinks": lambda: os.truncate(path, 1000),
        "is replaced": lambda: path.write_bytes(b"something else"),
        "is damaged": lambda: path.write_bytes(path.read_bytes()[:-200] + bytes(200)),
        "vanishes": path.unlink,
    }
    assert obbcli.collide(tree, tree).collides
    changes[change]()

    with pytest.raises(FileNotFoundError if change == "vanishes" else TreeFileError):
        tree.check()
    # What was read is still whole.
    assert obbcli.collide(tree, tree).collides
