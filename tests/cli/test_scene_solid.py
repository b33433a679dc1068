"""`scene --solid`: tables, documents, exit codes and refusals."""

from __future__ import annotations

import pytest
from claims.schemas import require_valid
from mesh_files.cube_files import cube, obj


@pytest.fixture
def job(here):
    """Write a scene of a block, an insert inside it, and a lid far above."""
    (here / "block.obj").write_text(obj([tuple(4 * x for x in corner) for corner in cube()]))
    (here / "insert.obj").write_text(obj(cube((1, 1, 1))))
    (here / "lid.obj").write_text(obj(cube((0, 0, 9))))
    names = "block", "insert", "lid"
    text = "".join(f'[[body]]\nname = "{name}"\nmesh = "{name}.obj"\n' for name in names)
    (here / "job.toml").write_text(text)
    return here


def test_embedded_part_is_found(job, obbtree):
    plain = obbtree("scene", "job.toml", "--exit-code", "--json")
    ended = obbtree("scene", "job.toml", "--solid", "--exit-code", "--json")
    table = obbtree("scene", "job.toml", "--solid")

    assert (plain.code, plain.json["result"]["contacts"]) == (0, [])
    assert "solid" not in plain.json
    require_valid(ended.json)
    assert (ended.code, ended.json["solid"]) == (1, True)
    (found,) = ended.json["result"]["contacts"]
    assert (found["body_a"], found["body_b"], found["contained"]) == ("block", "insert", "b")
    assert found["status"] == "overlap_at_start"
    assert "B inside A" in table.out
    quiet = obbtree("scene", "job.toml", "--solid", "--quiet")
    assert quiet.out == "overlap_at_start 0.0 block insert\n"


def test_open_body_is_refused_with_its_name(job, obbtree):
    lines = (job / "insert.obj").read_text().splitlines()
    (job / "insert.obj").write_text("\n".join(lines[:-1]) + "\n")

    ended = obbtree("scene", "job.toml", "--solid")

    assert ended.code == 3
    assert "body 'insert' (insert.obj): is not watertight: 3 edges" in ended.err


def test_triangles_are_not_listed_of_solids(job, obbtree):
    ended = obbtree("scene", "job.toml", "--solid", "--all-contacts")

    assert ended.code == 2
    assert "--all-contacts: lists triangles that meet, and a body inside" in ended.err


def test_scene_file_may_ask_about_solids(job, obbtree):
    (job / "solid.toml").write_text("solid = true\n" + (job / "job.toml").read_text())
    (job / "surface.toml").write_text("solid = false\n" + (job / "job.toml").read_text())

    asked = obbtree("scene", "job.toml", "--solid", "--json").json
    told = obbtree("scene", "solid.toml", "--json").json

    assert (told["solid"], told["result"]) == (True, asked["result"])
    assert "solid" not in obbtree("scene", "surface.toml", "--json").json
    assert obbtree("scene", "surface.toml", "--solid", "--json").json["result"] == told["result"]
    ended = obbtree("scene", "solid.toml", "--all-contacts")
    assert ended.code == 2
    assert "--all-contacts: lists triangles that meet, and the scene asks about so" in ended.err


@pytest.mark.parametrize("value", ["1", '"yes"', "[]"])
def test_scene_file_asks_about_solids_by_true_or_false(job, obbtree, value):
    (job / "job.toml").write_text(f"solid = {value}\n" + (job / "job.toml").read_text())

    ended = obbtree("scene", "job.toml")

    assert ended.code == 3
    assert "job.toml: solid: is " in ended.err
    assert "use true or false" in ended.err


def test_solid_is_no_key_of_a_body(job, obbtree):
    text = (job / "job.toml").read_text()
    (job / "job.toml").write_text(text + "solid = true\n")

    ended = obbtree("scene", "job.toml")

    assert ended.code == 3
    assert "body[2] 'lid': unknown key 'solid'" in ended.err
