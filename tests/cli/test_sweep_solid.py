"""`sweep --solid`: lines of results, resuming and refusals."""

from __future__ import annotations

import json

import pytest
from mesh_files.cube_files import cube, obj

WORDS = "sweep", "small.obj", "big.obj", "q.csv", "-o", "r.jsonl", "--quiet"


@pytest.fixture
def files(here):
    """Write a cube of 4, one of 1, and rows that place the small one inside and outside."""
    (here / "big.obj").write_text(obj([tuple(4 * x for x in corner) for corner in cube()]))
    (here / "small.obj").write_text(obj(cube()))
    rows = "1 1 1,0 0 0", "1 1 1,0 0 1", "9 1 1,0 0 1", "9 1 1,-8 0 0"
    (here / "q.csv").write_text("translate,vel\n" + "\n".join(rows) + "\n")
    return here


def lines(here):
    return [json.loads(line) for line in (here / "r.jsonl").read_text().splitlines()]


def test_rows_that_start_inside_are_in_contact(files, obbtree):
    ended = obbtree(*WORDS, "--solid", "--exit-code")

    header, *rows = lines(files)
    assert ended.code == 1
    assert header["options"]["solid"] is True
    assert [row["contained"] for row in rows] == ["a", "a", None, None]
    found = [row["status"] for row in rows]
    assert found == ["overlap_at_start", "overlap_at_start", "separated", "contact"]
    assert rows[3]["time"] == 0.625


def test_results_of_surfaces_are_not_gone_on_with(files, obbtree):
    obbtree(*WORDS)
    header, *rows = lines(files)

    assert "solid" not in header["options"]
    assert [row["status"] for row in rows[:1]] == ["separated"]
    assert obbtree(*WORDS, "--solid", "--resume").code == 3
    assert obbtree(*WORDS, "--resume").code == 0


def test_open_mesh_is_refused_before_anything_is_written(files, obbtree):
    text = (files / "small.obj").read_text().splitlines()[:-1]
    (files / "small.obj").write_text("\n".join(text) + "\n")

    ended = obbtree(*WORDS, "--solid")

    assert ended.code == 3
    assert "A (small.obj): is not watertight" in ended.err
    assert not (files / "r.jsonl").exists()
