"""`obbtree sweep`: rows in, results out; defaults, bad rows, exit codes, what is refused."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from pathlib import Path

PAIR = ("cube.stl", "apart.obj")


def swept(path: Path) -> list[dict]:
    """Return the rows of a results file."""
    header, *rows = [json.loads(line) for line in path.read_text().splitlines()]
    assert header["schema"] == "obbtree/sweep/1"
    assert [row["row"] for row in rows] == list(range(len(rows)))
    return rows


@pytest.fixture
def ask(here: Path, obbtree):
    """Return what sweeps the rows of a text and gives how that ended, and the results."""

    def run(text: str | bytes, *words: object, name: str = "q.csv"):
        (here / name).write_bytes(text.encode() if isinstance(text, str) else text)
        ended = obbtree("sweep", *PAIR, name, "-o", "out.jsonl", *words)
        path = here / "out.jsonl"
        return ended, swept(path) if path.exists() else None

    return run


def contact_of(obbtree, *words: object) -> dict:
    """Return what `first-contact` says of one row."""
    return obbtree("first-contact", *PAIR, *words, "--json").json["result"]


CSV = """\
id,vel,omega,pivot,translate_b,rotate_b,duration
fast,1 0 0,,,,,2
slow,1e-12 0 0,,,,,
turn,,0 0 2,0 0 0,1 0 0,0 0 0.25,
rest,,,,,,
"""
JSONL = """\
{"id": "fast", "vel": [1, 0, 0], "duration": 2}
{"id": "slow", "vel": [1e-12, 0, 0]}
{"id": "turn", "omega": [0, 0, 2], "pivot": [0, 0, 0], "translate_b": [1, 0, 0], \
"rotate_b": [0, 0, 0.25]}
{"id": "rest", "vel": null}
"""
PARTED = """\
id,vel_x,vel_y,vel_z,omega,pivot_x,pivot_y,pivot_z,translate_b,rotate_b_z,rotate_b_x,rotate_b_y,duration
fast,1,0,0,,,,,,,,,2
slow,1e-12,0,0,,,,,,,,,
turn,,,,0 0 2,0,0,0,1 0 0,0.25,0,0,
rest,,,,,,,,,,,,
"""
WORDS = {
    "fast": ("--vel", 1, 0, 0, "--duration", 2),
    "slow": ("--vel", 1e-12, 0, 0),
    "turn": (
        *("--omega", 0, 0, 2, "--pivot", 0, 0, 0),
        *("--translate-b", 1, 0, 0, "--rotate-b", 0, 0, 0.25),
    ),
    "rest": (),
}


@pytest.mark.parametrize(
    ("text", "name"), [(CSV, "q.csv"), (JSONL, "q.jsonl"), (PARTED, "q.csv"), (JSONL, "questions")]
)
def test_rows_are_answered_as_first_contact_answers_them(ask, obbtree, text, name):
    ended, rows = ask(text, name=name)

    assert (ended.code, ended.err) == (0, "")
    assert [row["id"] for row in rows] == list(WORDS)
    for row, words in zip(rows, WORDS.values(), strict=True):
        result = contact_of(obbtree, *words)
        assert {name: row[name] for name in result} == result
    assert {row["status"] for row in rows} == {"contact", "separated"}


def test_options_say_what_rows_leave_out(ask, obbtree):
    text = "vel,translate_b\n1 0 0,\n,0 0 5\n"

    _, rows = ask(text, "--vel", 90, 0, 0, "--translate-b", 2, 0, 0, "--duration", 4)

    own = contact_of(obbtree, "--vel", 1, 0, 0, "--translate-b", 2, 0, 0, "--duration", 4)
    other = contact_of(obbtree, "--vel", 90, 0, 0, "--translate-b", 0, 0, 5, "--duration", 4)
    assert [rows[0]["time"], rows[1]["time"]] == [own["time"], other["time"]]
    assert own["time"] == 2 + 2**-40


def test_degrees_hold_for_rows_too(ask, obbtree):
    _, rows = ask("omega,rotate_b\n0 0 90,0 0 30\n", "--degrees")

    words = ("--omega", 0, 0, 90, "--rotate-b", 0, 0, 30, "--degrees")
    assert rows[0]["time"] == contact_of(obbtree, *words)["time"]


@pytest.mark.parametrize(
    "words", [("--method", "sampled", "--steps", 3), ("--max-depth", 0), ("--clearance", 0.5)]
)
def test_accuracy_is_that_of_first_contact(ask, obbtree, words):
    _, rows = ask(CSV, *words)

    for row, own in zip(rows, WORDS.values(), strict=True):
        result = contact_of(obbtree, *own, *words)
        assert {name: row[name] for name in result} == result


def test_header_says_what_was_asked(ask, here):
    ask(CSV, "--duration", 3, "--clearance", 0.25)

    header = json.loads((here / "out.jsonl").read_text().splitlines()[0])
    assert header["inputs"]["a"]["triangle_count"] == 12
    assert header["inputs"]["queries"]["path"] == "q.csv"
    assert len(header["inputs"]["queries"]["sha256"]) == len(header["digest"]) == 64
    assert header["options"]["duration"] == 3
    assert header["accuracy"]["clearance"] == 0.25


BAD_CELLS = {
    "two numbers": ("1 2", "q.csv:3, column vel", "'1 2' is not three numbers"),
    "a word": ("1 2 x", "q.csv:3, column vel", "'x' is not a finite number"),
    "infinite": ("1 2 inf", "q.csv:3, column vel", "'inf' is not a finite number"),
    "grouped": ("1 2 1_0", "q.csv:3, column vel", "'1_0' is not a finite number"),
    "too fast": ("1e308 1e308 1e308", "q.csv:3, motion", "exceed"),
}


@pytest.mark.parametrize(("cell", "where", "fault"), BAD_CELLS.values(), ids=BAD_CELLS.keys())
def test_bad_row_is_an_error_row_and_not_the_end(ask, cell, where, fault):
    ended, rows = ask(f"id,vel\ngood,1 0 0\nbad,{cell}\nalso,1 0 0\n")

    assert ended.code == 3
    assert ended.err == ""
    assert "refused  1 row: see their errors" in ended.out
    assert [row["id"] for row in rows] == ["good", "bad", "also"]
    assert rows[1]["error"]["where"] == where
    assert fault in rows[1]["error"]["fault"]
    assert rows[0]["status"] == rows[2]["status"] == "contact"


BAD_ROWS = {
    "few cells": ("id,vel,duration\na,1 0 0\n", "has 2 cells, and there are 3 columns"),
    "many cells": ("id,vel\na,1 0 0,\n", "has 3 cells, and there are 2 columns"),
    "part of a vector": ("vel_x,vel_y,vel_z\n1,,0\n", "'' is not a finite number"),
    "pivot alone": ("pivot,vel\n0 0 0,1 0 0\n", "is where an axis of rotation passes"),
    "back in time": ("duration,vel\n-1,1 0 0\n", "is -1.0"),
    "open quotes": ('id,vel\n"a,1 0 0\n', "is no line of CSV: unexpected end of data"),
    "far away": ("translate\n1e308 1e308 0\n", "range of double"),
}


@pytest.mark.parametrize(("text", "fault"), BAD_ROWS.values(), ids=BAD_ROWS.keys())
def test_bad_rows_say_why(ask, text, fault):
    ended, rows = ask(text)

    assert ended.code == 3
    assert fault in rows[0]["error"]["fault"]
    assert rows[0]["error"]["where"].startswith("q.csv:2")


BAD_LINES = {
    "no JSON": ('{"vel": [1, 0, 0}', "is no JSON: "),
    "no object": ("[1, 0, 0]", "is no JSON object"),
    "NaN": ('{"vel": [1, 0, NaN]}', "is no JSON: NaN is no number"),
    "beyond doubles": ('{"vel": [1, 0, 1e999]}', "is not a finite number"),
    "huge": ('{"duration": 1' + 400 * "0" + "}", "is not a finite number"),
    "truth": ('{"vel": [1, 0, true]}', "True is not a finite number"),
    "two": ('{"vel": [1, 0]}', "[1, 0] is not a list of three numbers"),
    "text": ('{"vel": "1 0 0"}', "'1 0 0' is not a list of three numbers"),
    "two of a key": ('{"vel": [1, 0, 0], "vel": [2, 0, 0]}', "has the key 'vel' twice"),
    "unknown": ('{"velo": [1, 0, 0]}', "there is no key 'velo'"),
    "an id like no other": ('{"id": [1], "vel": [1, 0, 0]}', "[1] is not a finite number"),
    "deep": ("[" * 100_000, "is n"),
}


@pytest.mark.parametrize(("line", "fault"), BAD_LINES.values(), ids=BAD_LINES.keys())
def test_bad_line_of_json_is_an_error_row(ask, line, fault):
    ended, rows = ask(f'\n{line}\n\n{{"vel": [1, 0, 0]}}\n', name="q.jsonl")

    assert ended.code == 3
    assert rows[0]["error"]["where"].startswith("q.jsonl:2")
    assert fault in rows[0]["error"]["fault"]
    assert rows[1]["status"] == "contact"


def test_misspelt_key_is_told_its_neighbour(ask):
    _, rows = ask('{"omga_b": [1, 0, 0]}\n', name="q.jsonl")

    assert rows[0]["error"]["remedy"] == "did you mean 'omega_b'?"


BAD_FILES = {
    "empty": ("", "q.csv: is empty"),
    "names alone": ("id,vel\n", "q.csv: holds no questions"),
    "an unknown column": ("id,velo\na,1 0 0\n", "q.csv:1: there is no column 'velo'; did you"),
    "no names": ("1 0 0,2\n", "q.csv:1: there is no column '1 0 0'; the columns are vel, omega"),
    "a column twice": ("vel,id,vel\n", "q.csv:1: there are two columns 'vel'"),
    "a part missing": ("vel_x,vel_z\n", "q.csv:1: there is no column 'vel_y'"),
    "both ways": ("vel,vel_x,vel_y,vel_z\n", "q.csv:1: columns 'vel' and 'vel_x' say the same"),
    "quotes": ('"id,vel\n', "q.csv:1: is no line of CSV"),
}


@pytest.mark.parametrize(("text", "told"), BAD_FILES.values(), ids=BAD_FILES.keys())
def test_file_without_questions_is_refused_and_nothing_written(ask, text, told):
    ended, rows = ask(text)

    assert ended.code == 3
    assert ended.err.startswith(f"error: {told}")
    assert ended.err.count("\n") == 1
    assert rows is None


def test_empty_jsonl_is_refused(ask):
    ended, rows = ask("\n\n", name="q.jsonl")

    assert (ended.code, rows) == (3, None)
    assert ended.err == "error: q.jsonl: holds no questions; write one a line\n"


def test_marks_ends_blanks_and_quotes_of_csv_change_nothing(ask):
    text = '\ufeff"id", vel ,duration\r\n\r\n" a ""b"", c ","1 0 0",\r\n   \r\nd, 1\t0  0 ,2\r\n'

    ended, rows = ask(text)

    assert (ended.code, ended.err) == (0, "")
    assert [row["id"] for row in rows] == [' a "b", c ', "d"]
    assert rows[0]["time"] == rows[1]["time"] == 2**-40


def test_ids_of_any_letters_come_back(ask):
    _, rows = ask("id,vel\nNuß ↯,1 0 0\n".encode() + b"\xff,1 0 0\n")

    assert [row["id"] for row in rows] == ["Nuß ↯", "\ufffd"]


def test_numbers_are_ids_too(ask):
    _, rows = ask('{"id": 7}\n{"id": 0.5}\n{"id": null}\n{}\n', name="q.jsonl")

    assert [row["id"] for row in rows] == [7, 0.5, None, None]


def test_unresolved_rows_have_the_higher_code(ask):
    text = "vel,translate_b\n1 0,\n1 0 0,0.5 0 0\n"

    ended, rows = ask(text, "--max-iterations", 1)

    assert ended.code == 4
    assert rows[1]["status"] == "unresolved"


@pytest.mark.parametrize(
    ("text", "words", "code"),
    [
        ("vel\n1 0 0\n-1 0 0\n", (), 1),
        ("vel\n-1 0 0\n", (), 0),
        ("vel\n-1 0 0\n", ("--method", "sampled"), 4),
        ("vel\n1 0 0\nx\n", (), 3),
    ],
)
def test_exit_code_is_of_all_rows(ask, text, words, code):
    ended, _ = ask(text, "--exit-code", *words)

    assert ended.code == code


def test_summary_is_a_document_where_asked(ask):
    ended, _ = ask(CSV + "bad,1,,,,,\n", "--json")

    assert ended.json["schema"] == "obbtree/sweep-summary/1"
    assert ended.json["result"]["row_count"] == 5
    assert ended.json["result"]["error_count"] == 1
    assert sum(ended.json["result"]["statuses"].values()) == 4


def test_quiet_summary_counts_statuses(ask):
    ended, _ = ask(CSV + "bad,1,,,,,\n", "-q")

    assert ended.out == "contact 2\nseparated 2\nerror 1\n"


USAGE = {
    "nowhere": (("q.csv",), "-o: is missing"),
    "standard output": (("q.csv", "-o", "-"), "-o: is missing"),
    "over the queries": (("q.csv", "-o", "q.csv", "--force"), "is the input q.csv"),
    "over a mesh": (("q.csv", "-o", "cube.stl", "--force"), "is the input cube.stl"),
    "both": (("q.csv", "-o", "x", "--resume", "--force"), "--resume: keeps results"),
    "samples": (("q.csv", "-o", "x", "--steps", 3), "--steps: has a meaning with --method"),
}


@pytest.mark.parametrize(("words", "told"), USAGE.values(), ids=USAGE.keys())
def test_usage_is_told_before_anything_is_read(here, obbtree, words, told):
    (here / "q.csv").write_text("vel\n1 0 0\n")
    before = {path: path.read_bytes() for path in here.iterdir()}

    ended = obbtree("sweep", *PAIR, *words)

    assert ended.code == 2
    assert told in ended.err
    assert {path: path.read_bytes() for path in here.iterdir()} == before


def test_standard_input_is_no_two_files(here, obbtree):
    ended = obbtree("sweep", "-", "apart.obj", "-", "-o", "out.jsonl")

    assert ended.code == 2
    assert "QUERIES: is standard input, and so is a mesh" in ended.err


@pytest.mark.parametrize("name", ["gone.csv", "."])
def test_queries_that_are_no_file_are_refused(here, obbtree, name):
    ended = obbtree("sweep", *PAIR, name, "-o", "out.jsonl")

    assert ended.code == 3
    assert ended.err.startswith(f"error: {name}: ")
    assert not (here / "out.jsonl").exists()


def test_queries_that_change_meanwhile_are_told(ask, here, monkeypatch):
    from obbcli.sweeps import stream

    answer_rows = stream.answer_rows

    def changed(*arguments):
        (here / "q.csv").write_text("vel\n" + 101 * "-1 0 0\n")
        return answer_rows(*arguments)

    monkeypatch.setattr(stream, "answer_rows", changed)
    ended, _ = ask("vel\n" + 100 * "-1 0 0\n")

    assert ended.code == 3
    assert ended.err.startswith("error: q.csv: changed while it was read; ")


def test_results_in_no_folder_are_an_output_fault(here, obbtree):
    (here / "q.csv").write_text("vel\n1 0 0\n")

    ended = obbtree("sweep", *PAIR, "q.csv", "-o", "gone/out.jsonl")

    assert ended.code == 5
    assert "cannot be written" in ended.err
