"""`obbtree intervals` and `range`: documents, exit codes, and options that are never ignored."""

from __future__ import annotations

import pytest

# A cube of side 1 flies through another: in touch for 0.5 s.
PASSING = ("cube.stl", "cube.stl", "--translate-b", -5, 0.2, 0.3, "--vel-b", 4, 0, 0)
TURNING = (
    "cube.stl",
    "cube.stl",
    "--translate-b",
    -5,
    0.2,
    0.3,
    "--vel-b",
    4,
    0,
    0,
    "--omega-b",
    1,
    2,
    3,
)
FLUSH = ("cube.stl", "cube.stl", "--translate-b", 0, 0, 1, "--omega-b", 0, 0, 1)
APART = ("cube.stl", "cube.stl", "--translate-b", 3, 0, 0)


def test_intervals_document_holds_what_was_asked_and_answered(here, obbtree):
    ended = obbtree("intervals", *PASSING, "--duration", 3, "--json")

    document = ended.json
    result = document["result"]
    assert (ended.code, ended.err) == (0, "")
    assert document["schema"] == "obbtree/intervals/1"
    assert document["asked"] == {"within": 0.0, "limit": None}
    assert [piece["kind"] for piece in result["pieces"]] == ["free", "contact", "free"]
    assert result["pieces"][0]["end"] == [1.0, 1.0]
    low, high = result["pieces"][1]["end"]
    assert low <= 1.5 <= high
    assert (result["undecided_count"], result["undecided_total"]) == (0, 0)
    assert (result["complete_until"], result["unresolved_after"]) == (3.0, None)


def test_intervals_are_told_to_people_and_scripts(here, obbtree):
    table = obbtree("intervals", *PASSING, "--duration", 3).out
    bare = obbtree("intervals", *PASSING, "--duration", 3, "--quiet").out

    assert "pieces: 2 free, 1 contact" in table
    assert [line.split()[0] for line in bare.splitlines()] == ["free", "contact", "free"]
    assert "free throughout" in obbtree("intervals", *APART).out
    assert (
        "in contact throughout" in obbtree("intervals", "cube.stl", "cube.stl", "--duration", 1).out
    )


def test_a_list_that_ends_early_says_so(here, obbtree):
    cut = obbtree("intervals", *PASSING, "--duration", 3, "--limit", 2, "--json").json["result"]
    assert len(cut["pieces"]) == 2
    assert cut["complete_until"] < 3
    ended = obbtree("intervals", *TURNING, "--duration", 3, "--max-iterations", 1, "--json")
    assert ended.code == 4
    assert ended.json["result"]["unresolved_after"] is not None
    assert ended.json["result"]["complete_until"] < 3


def test_undecided_pieces_are_counted_and_never_clear(here, obbtree):
    ended = obbtree("intervals", *FLUSH, "--json", "--exit-code")

    result = ended.json["result"]
    assert ended.code == 4
    assert result["undecided_count"] >= 1
    assert result["undecided_total"] > 0.9
    assert obbtree("intervals", *FLUSH, "--within", 0.1, "--exit-code").code == 1


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("intervals", *PASSING), 1),
        (("intervals", *APART), 0),
        (("range", *PASSING), 0),
        (("range", "cube.stl", "cube.stl"), 1),
        (("range", *TURNING, "--max-iterations", 1), 4),
    ],
)
def test_exit_codes(here, obbtree, words, code):
    assert obbtree(*words, "--exit-code").code == code
    assert obbtree(*words).code == (0 if code == 1 else code)


@pytest.mark.parametrize("command", ["intervals", "range"])
@pytest.mark.parametrize(
    "words", [("--clearance", "1"), ("--max-depth", "3"), ("--method", "sampled")]
)
def test_what_says_nothing_is_one_clear_error(here, obbtree, command, words):
    ended = obbtree(command, *PASSING, *words)

    assert (ended.code, ended.out) == (2, "")
    assert words[0] in ended.err
    assert ended.err.count("\n") == 1


def test_range_document_and_words(here, obbtree):
    result = obbtree("range", *PASSING, "--duration", 3, "--json").json["result"]

    assert result["free"] == [-3.0, 1.0]
    assert result["before"]["status"] == "separated"
    assert result["after"]["time_bounds"] == [1.0, 1.0]
    assert obbtree("range", *PASSING, "--duration", 3, "--quiet").out == "-3.0 1.0\n"
    assert obbtree("range", "cube.stl", "cube.stl", "--quiet").out == "none\n"
    assert "nothing stops them" in obbtree("range", *PASSING).out


def test_contact_after_release(here, obbtree):
    leaving = ("first-contact", "cube.stl", "cube.stl", "--vel", 1, 0, 0, "--after-release")

    result = obbtree(*leaving, "--duration", 3, "--json").json["result"]
    low, high = result["released"]
    assert result["status"] == "separated"
    assert low <= 1 <= high
    assert result["released_by"] == 0
    assert "no contact after they were released" in obbtree(*leaving, "--duration", 3).out
    assert obbtree(*leaving, "--duration", 3, "--exit-code").code == 0
    never = obbtree(*leaving, "--duration", 0.5, "--exit-code")
    assert never.code == 1
    assert "never released" in never.out
    for words in (("--limit", 2), ("--all-contacts",)):
        assert obbtree(*leaving, *words).code == 2
    assert obbtree("first-contact", "cube.stl", "cube.stl", "--released-by", 1).code == 2
    assert obbtree(*leaving, "--clearance", 1).code == 2
