"""`obbtree tradeoff --ask distance|overlap`: documents, tables, exit codes, refusals."""

from __future__ import annotations

import shlex

import pytest

CUBES = "cube.stl", "cube.stl", "--translate", 0.75, 0.5, 0.25
ASKED = ("--ask", "overlap", "--budget", 20)


def test_document_holds_rows_whose_commands_ask_so(here, obbtree):
    ended = obbtree("tradeoff", *CUBES, *ASKED, "--json")

    result = ended.json["result"]
    assert (ended.code, ended.json["schema"]) == (0, "obbtree/tradeoff/1")
    assert (result["ask"], result["claims_broken"], result["unreached"]) == ("overlap", 0, [])
    assert result["reference"]["relation"] == "overlapping"
    for row in result["rows"]:
        words = shlex.split(row["command"])
        assert words[:2] == ["obbtree", "overlap"]
        again = obbtree(*words[1:], "--json").json["result"]
        assert again["relation"] == row["relation"]
        assert again["thickness"]["bounds"] == row["bounds"]["thickness"]


def test_table_and_bare_answer_name_settings(here, obbtree):
    table = obbtree("tradeoff", *CUBES, *ASKED, "--max-time", 60).out

    assert "claims" in table
    assert "--tolerance 0.001" in table
    (line,) = obbtree("tradeoff", *CUBES, *ASKED, "--max-time", 60, "--quiet").out.splitlines()
    assert line.startswith("obbtree overlap cube.stl cube.stl --translate 0.75 0.5 0.25 --tol")


def test_distance_is_asked_too(here, obbtree):
    words = ("cube.stl", "apart.obj", "--ask", "distance", "--budget", 5, "--json")

    result = obbtree("tradeoff", *words).json["result"]

    assert (result["ask"], result["claims_broken"]) == ("distance", 0)
    assert result["rows"][0]["options"] == []


@pytest.mark.parametrize(
    "words",
    [
        ("--vel", 1, 0, 0),
        ("--max-error", 1e-3),
        ("--max-gap", 1e-3),
        ("--plot", "trade.svg"),
        ("--max-depth", 3),
    ],
)
def test_what_says_nothing_is_one_clear_error(here, obbtree, words):
    ended = obbtree("tradeoff", *CUBES, *ASKED, *words)

    assert (ended.code, ended.out) == (2, "")
    assert ended.err.count("\n") == 1


def test_limit_leaves_the_reference_open(here, obbtree):
    words = ("--max-iterations", 1, "--quiet", "--ask", "overlap", "--budget", 1)

    assert obbtree("tradeoff", *CUBES, *words).code == 4
