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
