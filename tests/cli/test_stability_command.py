"""`obbtree stability`: documents, exit codes, Ctrl-C."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from obbcli.study.stability import battery
from obbcli.study.stability.battery import Battery

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
LINKS = SAMPLES / "chain_link_a.off", SAMPLES / "chain_link_b.ply"
APART = SAMPLES / "housing.stl", SAMPLES / "board.vtk"
KEYS = ["schema", "tool_version", "inputs", "motion", "accuracy", "result", "stats"]


def test_document_has_every_row(obbtree):
    ended = obbtree("stability", *LINKS, "--vel", 0, 0, -5, "--json")

    document, result = ended.json, ended.json["result"]
    assert ended.code == 0
    assert list(document) == KEYS
    assert document["schema"] == "obbtree/stability/1"
    assert result["answer"]["status"] == "contact"
    assert result["tried_count"] == result["extreme_count"] == len(result["rows"])
    assert result["broken_count"] == 0
    assert not result["interrupted"]
    first = result["rows"][0]
    assert (first["family"], first["extreme"], first["magnitude"]) == ("scale by 2^k", "2^1", 2.0)
    assert (first["expected"], first["bound"], first["outcome"]) == ("same bits", 0.0, "same")
    assert first["time_bounds"] == result["answer"]["time_bounds"]
    for family in result["families"]:
        rows = [row for row in result["rows"] if row["family"] == family["family"]]
        assert family["tried_count"] == len(rows)
        for name, number in family["outcomes"].items():
            assert number == sum(row["outcome"] == name for row in rows)


def test_document_is_the_same_every_time(obbtree):
    one, two = (obbtree("stability", *APART, "--json").json for _ in range(2))

    assert one["result"] == two["result"]


def test_table_names_families_and_where_bits_change(obbtree):
    lines = obbtree("stability", *LINKS, "--vel", 0, 0, -5).out.splitlines()

    assert any(line.split() == ["broken", "0"] for line in lines)
    assert any(line.startswith("shift the world") and "11" in line.split() for line in lines)
    assert any(line.startswith("shift the world") and "grid of doubles" in line for line in lines)


def test_bare_answer_counts(obbtree):
    assert obbtree("stability", *APART, "--quiet").out == "held 81\nbroken 0\n"


@pytest.mark.parametrize(
    ("files", "words", "code"), [(LINKS, ("--vel", 0, 0, -5), 1), (APART, (), 0)]
)
def test_exit_code_is_the_answers_where_asked(obbtree, files, words, code):
    assert obbtree("stability", *files, *words, "--exit-code", "--quiet").code == code


def test_limit_leaves_the_answer_open(obbtree):
    words = ("--omega", 0, 0, 1, "--max-iterations", 1, "--quiet")

    assert obbtree("stability", *LINKS, *words).code == 4


def test_broken_promise_is_exit_code_6(obbtree, monkeypatch):
    judge = Battery._judged

    def lie(self, row, changed, answer):
        made = judge(self, row, changed, answer)
        is_first = (row.family, row.extreme) == ("swap A and B", "swapped")
        return replace(made, outcome="broken", held=False, reason="a lie") if is_first else made

    monkeypatch.setattr(Battery, "_judged", lie)
    ended = obbtree("stability", *LINKS, "--vel", 0, 0, -5, "--exit-code")

    assert ended.code == 6
    assert "BROKEN" in ended.out
    assert "swap A and B, swapped  a lie" in ended.out


def test_interrupt_keeps_what_was_tried(obbtree, monkeypatch):
    ask, calls = battery.first_contact, []

    def stop(*question):
        calls.append(question)
        if len(calls) == 5:
            raise KeyboardInterrupt
        return ask(*question)

    monkeypatch.setattr(battery, "first_contact", stop)
    ended = obbtree("stability", *APART, "--json")

    assert ended.code == 130
    assert ended.json["result"]["interrupted"]
    assert len(ended.json["result"]["rows"]) == ended.json["result"]["tried_count"] == 3
    assert (ended.error["code"], ended.error["remedy"]) == (130, "not tried: 78 extremes")


@pytest.mark.needs("matplotlib")
def test_interrupt_of_the_first_extreme_draws_an_empty_plot(here, obbtree, monkeypatch):
    def stop(self):
        raise KeyboardInterrupt

    monkeypatch.setattr(Battery, "advance", stop)
    ended = obbtree("stability", *APART, "--plot", "held.svg")

    assert ended.code == 130
    assert "0 of 81 (interrupted)" in ended.out
    assert ended.err == "note: interrupted; not tried: 81 extremes\n"
    assert "0 extremes" in (here / "held.svg").read_text()


def test_sampled_method_is_refused(obbtree):
    ended = obbtree("stability", *APART, "--method", "sampled")

    assert ended.code == 2
    assert ended.err.startswith("error: --method sampled: proves nothing")


@pytest.mark.needs("matplotlib")
@pytest.mark.parametrize(("name", "magic"), [("held.svg", b"<?xml"), ("held.PNG", b"\x89PNG\r\n")])
def test_plot_shows_every_family(here, obbtree, name, magic):
    pictures = []
    for _ in range(2):
        assert obbtree("stability", *APART, "--plot", name, "--quiet").code == 0
        picture = (here / name).read_bytes()
        assert picture.startswith(magic)
        pictures.append(picture)

    assert pictures[0] == pictures[1]
    if name == "held.svg":
        text = picture.decode()
        assert all(family in text for family in ("shift the world", "tilt B", "none is broken"))


@pytest.mark.parametrize(
    ("words", "code", "fault"),
    [
        (("--plot", "held.pdf"), 2, "is no .svg or .png file"),
        pytest.param(
            ("--plot", "gone/held.svg"), 5, "folder", marks=pytest.mark.needs("matplotlib")
        ),
        (("--plot", "held.svg", "-o", "held.svg"), 2, "where the answer goes"),
    ],
)
def test_plot_that_cannot_be_is_refused_first(here, obbtree, words, code, fault):
    ended = obbtree("stability", *APART, *words)

    assert ended.code == code
    assert fault in ended.err
    assert not ended.out
    assert not (here / "held.svg").exists()


def test_plot_without_matplotlib_says_what_to_install(here, obbtree, monkeypatch):
    monkeypatch.setattr("obbcli.cli.plot.find_spec", lambda _: None)

    ended = obbtree("stability", *APART, "--plot", "held.svg")

    assert ended.code == 2
    assert "pip install matplotlib" in ended.err


@pytest.mark.parametrize("ask", ["distance", "overlap"])
def test_question_at_rest_has_its_own_rows(obbtree, ask):
    document = obbtree("stability", *APART, "--ask", ask, "--json").json

    result = document["result"]
    assert result["ask"] == ask
    assert result["broken_count"] == 0
    assert result["rows"][0]["bounds"]["distance"][0] <= 0.05
    assert (result["rows"][0]["relation"] == "clear") == (ask == "overlap")
    assert (result["rows"][0]["status"], result["rows"][0]["time_bounds"]) == (None, None)


def test_question_at_rest_is_told_to_people(obbtree):
    lines = obbtree("stability", *APART, "--ask", "overlap").out.splitlines()

    told = {line.split()[0]: line.split()[1:] for line in lines if line}
    assert told["answer"] == ["clear"]
    assert told["broken"] == ["0"]


@pytest.mark.parametrize("words", [("--vel", 1, 0, 0), ("--duration", 2), ("--max-depth", 3)])
def test_what_says_nothing_at_rest_is_refused(obbtree, words):
    ended = obbtree("stability", *APART, "--ask", "overlap", *words)

    assert (ended.code, ended.out) == (2, "")
    assert words[0].removesuffix("s") in ended.err.replace("_", "-") or "max" in ended.err


@pytest.mark.parametrize(("words", "code"), [((), 0), (("--translate", 0, 0, 0.3), 1)])
def test_exit_code_of_a_question_at_rest_is_its_own(obbtree, words, code):
    asked = ("--ask", "distance", "--exit-code", "--quiet")

    assert obbtree("stability", *APART, *words, *asked).code == code
