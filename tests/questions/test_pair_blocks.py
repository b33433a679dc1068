"""Lists of pairs as long as the product of two meshes: in blocks, refused, and written as found."""

from __future__ import annotations

import json

import numpy as np
import pytest
from meshes.hostile import HOSTILE, coincident

import obbcli
from obbcli import Body, Mesh, MotionError, ObbTree, Pose, UnresolvedError, triangle_pair_blocks
from obbcli.cli import main


def mesh_of(name: str, count: int) -> Mesh:
    surface = HOSTILE[name](count).b
    return Mesh(surface.vertices, surface.faces)


@pytest.mark.parametrize("name", ["crossing", "stacked grids", "nested spheres", "coincident"])
@pytest.mark.parametrize("most", [1, 7, 500, 10**9])
def test_blocks_are_all_pairs_in_their_order(name, most):
    mesh = mesh_of(name, 60)
    turned = Body(mesh, Pose(rotation=(0.1, 0.2, 0.3), translation=(0.01, 0.02, 0.03)))
    wanted = obbcli.triangle_pairs(mesh, turned)

    blocks = list(triangle_pair_blocks(mesh, turned, most))

    assert np.array_equal(np.concatenate(blocks), wanted)
    for block in blocks:
        assert block.dtype == np.int64
        assert len(block) <= most or (block[:, 0] == block[0, 0]).all()


def test_blocks_of_a_tree_file_are_those_of_its_mesh(tmp_path):
    mesh = mesh_of("crossing", 40)
    path = tmp_path / "tree.obbt"
    ObbTree.build(mesh, leaf_size=3).save(path)

    blocks = list(triangle_pair_blocks(path, path, 100))

    assert np.array_equal(np.concatenate(blocks), obbcli.triangle_pairs(mesh, mesh))


def test_blocks_of_surfaces_apart_are_none():
    mesh = mesh_of("crossing", 20)
    assert list(triangle_pair_blocks(mesh, Body(mesh, Pose(translation=(9, 0, 0))))) == []


def test_first_blocks_come_before_all_pairs_are_found():
    # Ten thousand million pairs: neither their time nor their memory is there.
    surface = coincident(100_000)
    mesh = Mesh(surface.vertices, surface.faces)
    blocks = triangle_pair_blocks(mesh, mesh, 50_000, threads=1)

    for row, block in zip(range(2), blocks, strict=False):
        assert block[:, 0].tolist() == [row] * 100_000
        assert np.array_equal(block[:, 1], np.arange(100_000))


@pytest.mark.parametrize("threads", [1, 2])
def test_more_pairs_than_memory_allows_are_refused(threads):
    surface = coincident(3000)
    mesh = Mesh(surface.vertices, surface.faces)

    with pytest.raises(UnresolvedError, match=r"more than 31250 pairs .* 1000000 bytes") as fault:
        obbcli.triangle_pairs(mesh, mesh, threads=threads, max_memory=1_000_000)

    assert "blocks" in fault.value.remedy


@pytest.mark.parametrize("threads", [1, 2])
def test_memory_that_suffices_changes_nothing(threads):
    mesh = mesh_of("crossing", 200)
    wanted = obbcli.triangle_pairs(mesh, mesh)

    needed = 32 * len(wanted)
    found = obbcli.triangle_pairs(mesh, mesh, threads=threads, max_memory=needed)

    assert np.array_equal(found, wanted)
    with pytest.raises(UnresolvedError):
        obbcli.triangle_pairs(mesh, mesh, threads=threads, max_memory=needed - 32)


@pytest.mark.parametrize("call", [
    lambda mesh, number: obbcli.triangle_pairs(mesh, mesh, max_memory=number),
    lambda mesh, number: triangle_pair_blocks(mesh, mesh, number),
])  # fmt: skip
@pytest.mark.parametrize("number", [0, -1, 1.5, True, "1"])
def test_room_for_pairs_is_a_whole_number(call, number):
    mesh = mesh_of("crossing", 2)
    with pytest.raises(MotionError, match="whole number"):
        call(mesh, number)


@pytest.fixture
def crossing_file(tmp_path):
    """Return the path of a mesh of 100 triangles of which any two cross, in a format of text."""
    surface = HOSTILE["crossing"](100).a
    rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in surface.vertices.tolist()]
    rows += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in surface.faces.tolist()]
    path = tmp_path / "crossing.obj"
    path.write_text("\n".join(rows) + "\n")
    return str(path)


def test_quiet_pairs_are_written_as_blocks_come(crossing_file, capsys):
    assert main(["collide", crossing_file, crossing_file, "--all-pairs", "--quiet"]) == 0

    lines = capsys.readouterr().out.splitlines()
    assert lines == [f"{i} {j}" for i in range(100) for j in range(100)]


def test_command_refuses_a_list_beyond_its_memory(crossing_file, capsys):
    words = ["collide", crossing_file, crossing_file, "--all-pairs", "--json"]

    assert main([*words, "--max-memory", "1M"]) == 4

    fault = json.loads(capsys.readouterr().err)
    assert "more than 2048 pairs" in json.dumps(fault)
    assert main([*words, "--max-memory", "8M"]) == 0
    assert len(json.loads(capsys.readouterr().out)["result"]["pairs"]) == 10_000
    assert main([*words, "--max-memory", "1M", "--limit", "2000"]) == 0
    assert json.loads(capsys.readouterr().out)["result"]["pairs_complete"] is False


def test_memory_without_a_list_is_a_usage_error(crossing_file, capsys):
    assert main(["collide", crossing_file, crossing_file, "--max-memory", "1M"]) == 2
    assert "--max-memory" in capsys.readouterr().err
