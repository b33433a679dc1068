"""`obbtree sweep`: rows in, results out; defaults, bad rows, exit codes, what is refused."""

from __future__ import annotations

import json

import pytest

PAIR = ("cube.stl", "apart.obj")


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
def test_rows_are_answered_as_first_contact_answers_them(ask_rows, obbtree, text, name):
    ended, rows = ask_rows(text, name=name)

    assert (ended.code, ended.err) == (0, "")
    assert [row["id"] for row in rows] == list(WORDS)
    for row, words in zip(rows, WORDS.values(), strict=True):
        result = contact_of(obbtree, *words)
        assert {name: row[name] for name in result} == result
    assert {row["status"] for row in rows} == {"contact", "separated"}


def test_options_say_what_rows_leave_out(ask_rows, obbtree):
    text = "vel,translate_b\n1 0 0,\n,0 0 5\n"

    _, rows = ask_rows(text, "--vel", 90, 0, 0, "--translate-b", 2, 0, 0, "--duration", 4)

    own = contact_of(obbtree, "--vel", 1, 0, 0, "--translate-b", 2, 0, 0, "--duration", 4)
    other = contact_of(obbtree, "--vel", 90, 0, 0, "--translate-b", 0, 0, 5, "--duration", 4)
    assert [rows[0]["time"], rows[1]["time"]] == [own["time"], other["time"]]
    assert own["time"] == 2 + 2**-40


def test_degrees_hold_for_rows_too(ask_rows, obbtree):
    _, rows = ask_rows("omega,rotate_b\n0 0 90,0 0 30\n", "--degrees")

    words = ("--omega", 0, 0, 90, "--rotate-b", 0, 0, 30, "--degrees")
    assert rows[0]["time"] == contact_of(obbtree, *words)["time"]


@pytest.mark.parametrize(
    "words", [("--method", "sampled", "--steps", 3), ("--max-depth", 0), ("--clearance", 0.5)]
)
def test_accuracy_is_that_of_first_contact(ask_rows, obbtree, words):
    _, rows = ask_rows(CSV, *words)

    for row, own in zip(rows, WORDS.values(), strict=True):
        result = contact_of(obbtree, *own, *words)
        assert {name: row[name] for name in result} == result


def test_header_says_what_was_asked(ask_rows, here):
    ask_rows(CSV, "--duration", 3, "--clearance", 0.25)

    header = json.loads((here / "out.jsonl").read_text().splitlines()[0])
    assert header["inputs"]["a"]["triangle_count"] == 12
    assert header["inputs"]["queries"]["path"] == "q.csv"
    assert len(header["inputs"]["queries"]["sha256"]) == len(header["digest"]) == 64
    assert header["options"]["duration"] == 3
    assert header["accuracy"]["clearance"] == 0.25


def test_marks_ends_blanks_and_quotes_of_csv_change_nothing(ask_rows):
    text = '\ufeff"id", vel ,duration\r\n\r\n" a ""b"", c ","1 0 0",\r\n   \r\nd, 1\t0  0 ,2\r\n'

    ended, rows = ask_rows(text)

    assert (ended.code, ended.err) == (0, "")
    assert [row["id"] for row in rows] == [' a "b", c ', "d"]
    assert rows[0]["time"] == rows[1]["time"] == 2**-40


def test_ids_of_any_letters_come_back(ask_rows):
    _, rows = ask_rows("id,vel\nNuß ↯,1 0 0\n".encode() + b"\xff,1 0 0\n")

    assert [row["id"] for row in rows] == ["Nuß ↯", "\ufffd"]


def test_numbers_are_ids_too(ask_rows):
    _, rows = ask_rows('{"id": 7}\n{"id": 0.5}\n{"id": null}\n{}\n', name="q.jsonl")

    assert [row["id"] for row in rows] == [7, 0.5, None, None]


def test_unresolved_rows_have_the_higher_code(ask_rows):
    text = "vel,translate_b\n1 0,\n1 0 0,0.5 0 0\n"

    ended, rows = ask_rows(text, "--max-iterations", 1)

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
def test_exit_code_is_of_all_rows(ask_rows, text, words, code):
    ended, _ = ask_rows(text, "--exit-code", *words)

    assert ended.code == code


def test_summary_is_a_document_where_asked(ask_rows):
    ended, _ = ask_rows(CSV + "bad,1,,,,,\n", "--json")

    assert ended.json["schema"] == "obbtree/sweep-summary/1"
    assert ended.json["result"]["row_count"] == 5
    assert ended.json["result"]["error_count"] == 1
    assert sum(ended.json["result"]["statuses"].values()) == 4


def test_quiet_summary_counts_statuses(ask_rows):
    ended, _ = ask_rows(CSV + "bad,1,,,,,\n", "-q")

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


def test_queries_that_change_meanwhile_are_told(ask_rows, here, monkeypatch):
    from obbcli.sweeps import stream

    answer_rows = stream.answer_rows

    def changed(*arguments):
        (here / "q.csv").write_text("vel\n" + 101 * "-1 0 0\n")
        return answer_rows(*arguments)

    monkeypatch.setattr(stream, "answer_rows", changed)
    ended, _ = ask_rows("vel\n" + 100 * "-1 0 0\n")

    assert ended.code == 3
    assert ended.err.startswith("error: q.csv: changed while it was read; ")


def test_results_in_no_folder_are_an_output_fault(here, obbtree):
    (here / "q.csv").write_text("vel\n1 0 0\n")

    ended = obbtree("sweep", *PAIR, "q.csv", "-o", "gone/out.jsonl")

    assert ended.code == 5
    assert "cannot be written" in ended.err
