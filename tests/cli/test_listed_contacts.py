"""`obbtree first-contact --all-contacts` and `--limit`: exact lists, limits, documents, tables."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

import pytest
from mesh_files.cube_files import all_pairs, cube, obj

from obbcli import Body, Contact, Motion, ObbTree, contacts, first_contact
from obbcli.questions.search import Search

GEARS = [
    str(Path(__file__).resolve().parents[2] / f"sample_meshes/{n}.stl") for n in ("gear", "pinion")
]
TURNING = ("--omega", 0, 0, 3, "--omega-b", 0, 0, -5.9, "--duration", 2)
LANDING = ("cube.stl", "apart.obj", "--vel", 1, 0, 0)
KEYS = ("contacts", "contacts_complete", "contacts_unresolved_after")


# Those of two cubes that share a face.
LANDED = all_pairs((1, 0, 0))


def ids(result) -> list[list[int | None]]:
    return [[contact["triangle_a"], contact["triangle_b"]] for contact in result["contacts"]]


def turning_gears() -> list[Body]:
    """Return the bodies that `TURNING` moves."""
    return [
        Body(ObbTree.build(path), motion=Motion(angular_velocity=(0, 0, spin)))
        for path, spin in zip(GEARS, (3, -5.9), strict=True)
    ]


@pytest.fixture(scope="module")
def plain_pops() -> int:
    """Return what the plain question about turning gears takes."""
    return first_contact(*turning_gears(), 2.0).stats.pops


def test_all_contacts_of_a_landing_face_are_its_pairs_exactly(here, obbtree):
    result = obbtree("first-contact", *LANDING, "--all-contacts", "--json").json["result"]

    assert ids(result) == LANDED
    assert {tuple(contact["time_bounds"]) for contact in result["contacts"]} == {(2**-40, 2**-40)}
    assert result["contacts_complete"] is True
    assert result["contacts_unresolved_after"] is None


def test_all_contacts_of_bodies_at_rest_are_all_pairs(here, obbtree):
    result = obbtree("first-contact", "cube.stl", "touching.obj", "--all-contacts", "--json").json[
        "result"
    ]

    assert result["status"] == "overlap_at_start"
    assert ids(result) == LANDED


def test_list_leaves_the_rest_of_the_document_as_it_is(here, obbtree):
    plain = obbtree("first-contact", *LANDING, "--json").json
    listed = obbtree("first-contact", *LANDING, "--limit", 3, "--json").json

    assert list(listed["result"]) == [*plain["result"], *KEYS]
    assert {k: v for k, v in listed["result"].items() if k not in KEYS} == plain["result"]
    assert list(listed) == list(plain)
    assert listed["stats"]["pops"] > plain["stats"]["pops"]
    assert list(listed["stats"]["seconds"]) == [*plain["stats"]["seconds"], "contacts"]


def test_listed_contacts_are_those_of_the_package(obbtree):
    expected = list(contacts(*turning_gears(), 2.0, limit=12))

    result = obbtree("first-contact", *GEARS, *TURNING, "--limit", 12, "--json").json["result"]

    assert len(result["contacts"]) == 12
    for contact, found in zip(expected, result["contacts"], strict=True):
        names = [field.name for field in fields(Contact)]
        assert [*found, "part_a", "part_b"] == names
        for name, value in found.items():
            own = getattr(contact, name)
            assert value == (list(own) if isinstance(own, tuple) else own), name


def test_all_contacts_overlap_the_first_and_those_after_do_not(obbtree):
    document = obbtree("first-contact", *GEARS, *TURNING, "--all-contacts", "--json").json
    more = obbtree("first-contact", *GEARS, *TURNING, "--limit", 12, "--json").json["result"]

    result = document["result"]
    low, high = result["time_bounds"]
    inside = [c for c in more["contacts"] if c["time_bounds"][0] <= high]
    assert result["contacts"] == inside
    assert 1 < len(inside) < 12
    assert all(c["time_bounds"][1] >= low for c in inside)
    assert [result["triangle_a"], result["triangle_b"]] in ids(result)


@pytest.mark.parametrize(
    ("limit", "is_complete"), [(1, False), (3, False), (len(LANDED) + 1, True)]
)
def test_limit_cuts_the_list_of_the_first_contact(here, obbtree, limit, is_complete):
    words = (*LANDING, "--all-contacts", "--limit", limit)

    ended = obbtree("first-contact", *words, "--json")

    assert ids(ended.json["result"]) == LANDED[:limit]
    assert ended.json["result"]["contacts_complete"] is is_complete
    assert ended.json["result"]["contacts_unresolved_after"] is None
    assert ended.code == 0
    told = obbtree("first-contact", *words).err
    assert ("more may follow: see --limit" in told) is not is_complete


def test_limit_alone_goes_on_after_the_first_contact(here, obbtree):
    words = (*LANDING, "--duration", 3, "--limit", 200, "--json")

    result = obbtree("first-contact", *words).json["result"]

    # The cubes pass into each other, so that others of their triangles meet later.
    times = [contact["time"] for contact in result["contacts"]]
    assert ids(result)[: len(LANDED)] == LANDED
    assert times == sorted(times)
    assert len(times) > len(LANDED)
    assert result["contacts_complete"] is True


def test_no_contact_lists_none(here, obbtree):
    words = ("cube.stl", "apart.obj", "--vel", -1, 0, 0, "--all-contacts")

    ended = obbtree("first-contact", *words, "--exit-code", "--json")

    assert ended.code == 0
    assert [ended.json["result"][key] for key in KEYS] == [[], True, None]
    assert obbtree("first-contact", *words, "-q").out == ""


# Most of the steps lead to the first of these contacts, and the last few to the others.
@pytest.mark.parametrize(("share", "least"), [(0.0, 0), (0.5, 0), (0.99, 9)])
def test_limit_of_steps_keeps_what_was_listed(obbtree, plain_pops, share, least):
    words = (*GEARS, *TURNING, "--limit", 40)
    whole = obbtree("first-contact", *words, "--json").json
    every = whole["result"]["contacts"]
    pops = plain_pops + int(share * (whole["stats"]["pops"] - plain_pops))

    limited = ("first-contact", *words, "--max-iterations", pops, "--exit-code")
    ended = obbtree(*limited, "--json")

    result = ended.json["result"]
    after = result["contacts_unresolved_after"]
    assert ended.code == 4
    assert "a limit was reached: complete only before" in obbtree(*limited).err
    assert result["status"] == "contact"
    assert result["contacts_complete"] is False
    assert result["contacts"] == every[: len(result["contacts"])]
    assert len(result["contacts"]) >= max(least, sum(c["time"] < after for c in every))
    assert ended.json["stats"]["pops"] == pops


def test_steps_that_end_before_the_first_contact_list_none(obbtree, plain_pops):
    words = (*GEARS, *TURNING, "--all-contacts", "--max-iterations", plain_pops // 2)

    ended = obbtree("first-contact", *words, "--json")

    result = ended.json["result"]
    assert ended.code == 4
    assert result["status"] == "unresolved"
    assert [result[key] for key in KEYS] == [[], False, result["time"]]


def test_timeout_is_that_of_question_and_list_together(obbtree, monkeypatch):
    seconds = []
    make = Search.__init__

    def spy(self, pops, allowed, **others):
        seconds.append(allowed)
        make(self, pops, allowed, **others)

    monkeypatch.setattr(Search, "__init__", spy)

    obbtree("first-contact", *GEARS, *TURNING, "--all-contacts", "--timeout", 600)

    assert 0 < seconds[0] < 600


def test_ctrl_c_tells_what_is_proven(here, obbtree, monkeypatch):
    look = Search._look

    def interrupted(self, proven):
        if proven > 0.05:
            raise KeyboardInterrupt
        return look(self, proven)

    monkeypatch.setattr(Search, "_look", interrupted)
    monkeypatch.setattr("obbcli.questions.budget.POPS_A_SLICE", 100)

    ended = obbtree("first-contact", *GEARS, *TURNING, "--limit", 9)

    assert ended.code == 130
    assert ended.out == ""
    assert "first contact at t = 0.0567992" in ended.err
    assert "found of the list: 0" in ended.err


def test_contained_body_lists_no_contact(here, obbtree):
    (here / "inner.obj").write_text(obj([[0.25 + 0.5 * x for x in corner] for corner in cube()]))
    words = ("cube.stl", "inner.obj", "--solid", "--vel", 1, 0, 0, "--all-contacts", "--json")

    result = obbtree("first-contact", *words).json["result"]

    assert result["status"] == "overlap_at_start"
    assert result["contained"] == "b"
    assert [result[key] for key in KEYS] == [[], True, None]


def test_contacts_of_boxes_have_no_triangles(here, obbtree):
    words = (*LANDING, "--translate-b", 1, 0, 0, "--max-depth", 0, "--all-contacts")

    result = obbtree("first-contact", *words, "--json").json["result"]

    (contact,) = result["contacts"]
    assert ids(result) == [[None, None]]
    assert (contact["approximate"], contact["feature"]) == (True, "box")
    assert contact["time_bounds"] == result["time_bounds"]
    assert obbtree("first-contact", *words, "-q").out == f"{contact['time']!r} - -\n"


def test_quiet_is_a_line_a_contact(here, obbtree):
    out = obbtree("first-contact", *LANDING, "--all-contacts", "-q").out

    assert out == "".join(f"{2**-40!r} {i} {j}\n" for i, j in LANDED)


@pytest.mark.parametrize(
    ("words", "texts"),
    [
        (("--all-contacts",), (f"\npairs that touch: {len(LANDED)}, earliest first\n",)),
        (("--limit", 1), ("\npairs that touch: 1, earliest first; more may follow",)),
        (("--limit", 1), ("time [s]", "triangle of A", "triangle of B", "feature", "point")),
    ],
)
def test_table_lists_the_contacts(here, obbtree, words, texts):
    ended = obbtree("first-contact", *LANDING, *words)

    for text in texts:
        assert text in ended.out


@pytest.mark.parametrize("words", [("--all-contacts",), ("--limit", 3)])
def test_sampling_lists_no_contacts(here, obbtree, words):
    ended = obbtree("first-contact", *LANDING, *words, "--method", "sampled")

    assert ended.code == 2
    assert ended.out == ""
    assert f"error: {words[0]}: lists contacts of pairs" in ended.err
