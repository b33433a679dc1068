"""`obbtree sweep` and bad input: a bad row is an error row, a bad file is refused whole."""

from __future__ import annotations

import pytest

BAD_CELLS = {
    "two numbers": ("1 2", "q.csv:3, column vel", "'1 2' is not three numbers"),
    "a word": ("1 2 x", "q.csv:3, column vel", "'x' is not a finite number"),
    "infinite": ("1 2 inf", "q.csv:3, column vel", "'inf' is not a finite number"),
    "grouped": ("1 2 1_0", "q.csv:3, column vel", "'1_0' is not a finite number"),
    "too fast": ("1e308 1e308 1e308", "q.csv:3, motion", "exceed"),
}


@pytest.mark.parametrize(("cell", "where", "fault"), BAD_CELLS.values(), ids=BAD_CELLS.keys())
def test_bad_row_is_an_error_row_and_not_the_end(ask_rows, cell, where, fault):
    ended, rows = ask_rows(f"id,vel\ngood,1 0 0\nbad,{cell}\nalso,1 0 0\n")

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
def test_bad_rows_say_why(ask_rows, text, fault):
    ended, rows = ask_rows(text)

    assert ended.code == 3
    assert fault in rows[0]["error"]["fault"]
    assert rows[0]["error"]["where"].startswith("q.csv:2")


BAD_LINES = {
    "no JSON": ('{"vel": [1, 0, 0}', "is no JSON from column 17 on"),
    "long number": ('{"vel": [1, 0, ' + 9 * "9" * 1000 + "]}", "a number has too many digits"),
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
def test_bad_line_of_json_is_an_error_row(ask_rows, line, fault):
    ended, rows = ask_rows(f'\n{line}\n\n{{"vel": [1, 0, 0]}}\n', name="q.jsonl")

    assert ended.code == 3
    assert rows[0]["error"]["where"].startswith("q.jsonl:2")
    assert fault in rows[0]["error"]["fault"]
    assert rows[1]["status"] == "contact"


def test_misspelt_key_is_told_its_neighbour(ask_rows):
    _, rows = ask_rows('{"omga_b": [1, 0, 0]}\n', name="q.jsonl")

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
def test_file_without_questions_is_refused_and_nothing_written(ask_rows, text, told):
    ended, rows = ask_rows(text)

    assert ended.code == 3
    assert ended.err.startswith(f"error: {told}")
    assert ended.err.count("\n") == 1
    assert rows is None


def test_empty_jsonl_is_refused(ask_rows):
    ended, rows = ask_rows("\n\n", name="q.jsonl")

    assert (ended.code, rows) == (3, None)
    assert ended.err == "error: q.jsonl: holds no questions; write one a line\n"
