"""`obbtree sweep` leaves alone what it did not write: other results, other files, others' locks."""

from __future__ import annotations

import fcntl
import json
from typing import TYPE_CHECKING

import pytest
from mesh_files.cube_files import cube, obj

if TYPE_CHECKING:
    from pathlib import Path

WORDS = ("sweep", "cube.stl", "apart.obj", "q.csv", "--duration", "2")


def test_results_are_not_replaced_unasked(here: Path, asked, obbtree):
    ended = obbtree(*WORDS, "-o", "whole.jsonl")

    assert ended.code == 5
    assert ended.err.startswith("error: whole.jsonl: exists already; add --resume, or --force")
    assert (here / "whole.jsonl").read_bytes() == asked


def other_mesh(here: Path) -> tuple[str, ...]:
    (here / "apart.obj").write_text(obj(cube((2, 0, 0))))
    return WORDS


def other_rows(here: Path) -> tuple[str, ...]:
    with (here / "q.csv").open("a") as file:
        file.write("one more,0 0 0\n")
    return WORDS


OTHERS = {
    "mesh": (other_mesh, "B is not the file it was"),
    "rows": (other_rows, "the queries are not those they were"),
    "options": (lambda _: (*WORDS, "--omega", "0", "0", "1"), "it had other options"),
    "accuracy": (lambda _: (*WORDS, "--clearance", "1"), "it had another accuracy"),
}


@pytest.mark.parametrize(("change", "told"), OTHERS.values(), ids=OTHERS.keys())
def test_results_of_another_sweep_are_left_alone(here: Path, asked, obbtree, change, told):
    (here / "out.jsonl").write_bytes(asked[:3000])

    ended = obbtree(*change(here), "-o", "out.jsonl", "--resume")

    assert ended.code == 3
    fault = f"error: out.jsonl: holds the results of another sweep: {told}; remove it"
    assert ended.err.startswith(fault)
    assert ended.err.count("\n") == 1
    assert (here / "out.jsonl").read_bytes() == asked[:3000]


def test_results_of_another_version_are_left_alone(here: Path, asked, obbtree):
    header, rest = asked.split(b"\n", 1)
    old = json.loads(header) | {"tool_version": "0.0.1", "digest": 64 * "0"}
    (here / "out.jsonl").write_bytes(json.dumps(old).encode() + b"\n" + rest)

    ended = obbtree(*WORDS, "-o", "out.jsonl", "--resume")

    assert ended.code == 3
    assert "another version of obbtree wrote it" in ended.err


STRANGE = {
    "text": b"dear diary",
    "text in lines": b"dear diary\nit rains\n",
    "JSON": b'{"schema": "obbtree/collide/1"}\n',
    "a list": b"[]\n",
    "bytes": bytes(range(256)),
}


@pytest.mark.parametrize("content", STRANGE.values(), ids=STRANGE.keys())
def test_file_that_holds_no_results_is_left_alone(here: Path, asked, obbtree, content):
    (here / "out.jsonl").write_bytes(content)

    ended = obbtree(*WORDS, "-o", "out.jsonl", "--resume")

    assert ended.code == 3
    assert ended.err.startswith("error: out.jsonl: holds no results of a sweep; remove it")
    assert (here / "out.jsonl").read_bytes() == content


@pytest.mark.parametrize("change", ["lost", "doubled", "spoilt"])
def test_rows_out_of_sequence_are_refused(here: Path, asked, obbtree, change):
    lines = asked.splitlines(keepends=True)
    lines[10:11] = {"lost": [], "doubled": 2 * lines[10:11], "spoilt": [b"{}\n"]}[change]
    (here / "out.jsonl").write_bytes(b"".join(lines[:20]))

    ended = obbtree(*WORDS, "-o", "out.jsonl", "--resume")

    assert ended.code == 3
    assert "out.jsonl:1" in ended.err
    assert "of the results; remove it" in ended.err
    assert (here / "out.jsonl").read_bytes() == b"".join(lines[:20])


STRANGE_ROWS = {
    "no status": {},
    "no kind": {"status": "separated"},
    "another status": {"status": "perhaps", "approximate": False},
    "a list": {"status": ["separated"], "approximate": False},
}


@pytest.mark.parametrize("row", STRANGE_ROWS.values(), ids=STRANGE_ROWS.keys())
def test_rows_that_are_no_results_are_refused(here: Path, asked, obbtree, row):
    header = asked.partition(b"\n")[0]
    content = header + b"\n" + json.dumps({"row": 0, "id": None, **row}).encode() + b"\n"
    (here / "out.jsonl").write_bytes(content)

    ended = obbtree(*WORDS, "-o", "out.jsonl", "--resume")

    assert ended.code == 3
    assert "out.jsonl:2: is no result of a question; remove it" in ended.err
    assert (here / "out.jsonl").read_bytes() == content


def test_two_sweeps_do_not_share_their_results(here: Path, asked, obbtree):
    with (here / "whole.jsonl").open("a") as file:
        fcntl.flock(file, fcntl.LOCK_EX)

        ended = obbtree(*WORDS, "-o", "whole.jsonl", "--resume")

    assert ended.code == 3
    assert ended.err == "error: whole.jsonl: is being written by another sweep; wait for it\n"
