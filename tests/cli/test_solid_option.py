"""`--solid` of `collide` and `first-contact`: documents, tables, exit codes, refusals."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from mesh_files.cube_files import CUBE_FACES, cube, obj

from obbcli import Mesh, ObbTree

if TYPE_CHECKING:
    from pathlib import Path

COMMANDS = pytest.mark.parametrize("command", ["collide", "first-contact"])


@pytest.fixture
def nested(here: Path) -> Path:
    """Add to the folder a cube inside the others' place and one with a triangle missing."""
    small = [tuple(0.25 + 0.5 * x for x in corner) for corner in cube()]
    (here / "small.obj").write_text(obj(small))
    (here / "open.obj").write_text("\n".join(obj(cube()).splitlines()[:-1]) + "\n")
    ObbTree.build(Mesh(small, CUBE_FACES)).save(here / "small.obbt")
    return here


@COMMANDS
@pytest.mark.parametrize("inner", ["small.obj", "small.obbt"])
def test_document_says_which_body_is_inside(nested, obbtree, command, inner):
    ended = obbtree(command, inner, "cube.stl", "--solid", "--json")
    swapped = obbtree(command, "cube.stl", inner, "--solid", "--json")

    assert ended.json["solid"] is True
    assert ended.json["result"]["status"] == "overlap_at_start"
    assert ended.json["result"]["contained"] == "a"
    assert swapped.json["result"]["contained"] == "b"


def test_collide_document_of_a_body_inside_has_no_witness(nested, obbtree):
    assert obbtree("collide", "small.obj", "cube.stl", "--solid", "--json").json["result"] == {
        "status": "overlap_at_start",
        "collides": True,
        "witness": None,
        "approximate": False,
        "error_bound": 0.0,
        "contained": "a",
    }


@COMMANDS
def test_table_says_which_body_is_inside(nested, obbtree, command):
    ended = obbtree(command, "cube.stl", "small.obj", "--solid")

    assert "in contact at t = 0\ncontained" in ended.out
    assert "B, or a part of it, lies inside A" in ended.out
    assert ended.err == ""


@COMMANDS
def test_without_solid_a_body_inside_is_apart(nested, obbtree, command):
    ended = obbtree(command, "small.obj", "cube.stl", "--exit-code", "--json")

    assert ended.code == 0
    assert ended.json["solid"] is False
    assert ended.json["result"]["status"] == "separated"
    assert ended.json["result"]["contained"] is None


@COMMANDS
@pytest.mark.parametrize("motion", [(), ("--vel", 1, 0, 0), ("--omega", 0, 0, 1)])
def test_exit_code_of_a_body_inside_is_that_of_contact(nested, obbtree, command, motion):
    ended = obbtree(command, "small.obj", "cube.stl", "--solid", "--exit-code", "-q", *motion)

    assert ended.code == 1
    assert ended.out.split()[0] == "overlap_at_start"


@COMMANDS
@pytest.mark.parametrize("files", [("open.obj", "cube.stl"), ("cube.stl", "open.obj")])
def test_open_mesh_is_refused_by_name(nested, obbtree, command, files):
    ended = obbtree(command, *files, "--solid")

    assert ended.code == 3
    assert ended.out == ""
    assert "(open.obj): is not watertight: 3 edges do not join" in ended.err
    assert "without solid" in ended.err
    assert obbtree(command, *files, "-q").code == 0


def test_open_mesh_is_refused_as_one_object(nested, obbtree):
    ended = obbtree("collide", "open.obj", "cube.stl", "--solid", "--json")

    assert ended.code == 3
    assert ended.error["kind"] == "MeshError"
    assert ended.error["where"] == "A (open.obj)"


def test_pairs_and_solid_are_both_answered(nested, obbtree):
    result = obbtree("collide", "small.obj", "cube.stl", "--solid", "--all-pairs", "--json").json[
        "result"
    ]

    assert result["contained"] == "a"
    assert result["pairs"] == []
