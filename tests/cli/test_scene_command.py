"""`obbtree scene`: what it prints, writes and exits with."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from scenes.cubes import SCENE, add

from obbcli import ObbTree
from obbcli.scene.first_contacts import FirstContacts

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from conftest import Ended

    from obbcli.scene.rounds import Round

    Run = Callable[..., Ended]


@pytest.mark.usefixtures("scene")
def test_table_tells_contacts_and_what_became_of_pairs(obbtree: Run) -> None:
    ended = obbtree("scene", "cell.toml")

    lines = [" ".join(line.split()) for line in ended.out.splitlines()]
    assert ended.code == 0
    assert ended.err == ""
    assert lines[:4] == [
        "scene cell.toml",
        "bodies 3 of 2 files",
        "pairs 3: 2 apart by their bounds, 1 in contact",
        "answer first contact at t = 2.0 s, of still and slow",
    ]
    assert lines[8] == "contacts: 1, earliest first"
    assert lines[11].startswith("still slow 2.0 ")


@pytest.mark.usefixtures("scene")
def test_document_tells_all(obbtree: Run, here: Path) -> None:
    document = obbtree("scene", "cell.toml", "--json").json

    assert list(document) == [
        *("schema", "tool_version", "inputs", "duration", "bodies", "ignore", "accuracy"),
        *("result", "stats"),
    ]
    assert document["schema"] == "obbtree/scene/1"
    inputs = document["inputs"]
    assert inputs["scene"]["path"] == "cell.toml"
    assert inputs["scene"]["triangle_count"] is None
    assert len(inputs["scene"]["sha256"]) == 64
    assert [mesh["path"] for mesh in inputs["meshes"]] == ["cube.stl", "far.stl"]
    assert [mesh["triangle_count"] for mesh in inputs["meshes"]] == [12, 12]
    assert inputs["meshes"][0]["sha256"] == inputs["meshes"][1]["sha256"]
    bodies = document["bodies"]
    assert [(body["name"], body["mesh"]) for body in bodies] == [
        ("still", 0),
        ("slow", 0),
        ("far, far", 1),
    ]
    assert bodies[1]["linear_velocity"] == [-1, 0, 0]
    assert bodies[1]["pivot"] == pytest.approx([3.5, 0.5, 0.5])
    assert (document["duration"], document["accuracy"]["clearance"]) == (4, 0)
    result = document["result"]
    assert (result["status"], result["time"], result["approximate"]) == ("contact", 2, False)
    assert (result["contacts_complete"], result["unresolved"], result["interrupted"]) == (
        *(True, []),
        False,
    )
    (contact,) = result["contacts"]
    assert (contact["body_a"], contact["body_b"], contact["time_bounds"]) == (
        *("still", "slow"),
        [2, 2],
    )
    stats = document["stats"]
    assert (stats["pairs"], stats["apart_by_bounds"], stats["in_contact"]) == (3, 2, 1)
    assert stats["bodies"][2] == {
        "name": "far, far",
        "triangle_count": 12,
        "triangles_loaded": 12,
        "nodes_built": 0,
        "nodes_possible": 11,
    }
    assert set(stats["seconds"]) == {"load", "bounds", "query"}


@pytest.mark.usefixtures("scene")
def test_answer_is_the_same_whatever_the_file_kinds(obbtree: Run, here: Path) -> None:
    of_meshes = obbtree("scene", "cell.toml", "--json").json
    for name in ("cube", "far"):
        ObbTree.build(here / f"{name}.stl").save(here / f"{name}.obbt")
    (here / "cell.toml").write_text(SCENE.replace(".stl", ".obbt"))

    of_trees = obbtree("scene", "cell.toml", "--json").json

    varying = ("inputs", "stats")
    assert {key: value for key, value in of_trees.items() if key not in varying} == {
        key: value for key, value in of_meshes.items() if key not in varying
    }
    assert of_trees["stats"]["bodies"][2]["triangles_loaded"] <= 12


def test_bare_answer_is_a_line_a_contact(obbtree: Run, scene: Path) -> None:
    add(scene, '[[body]]\nname = "on it"\nmesh = "touching.obj"\n')

    assert obbtree("scene", "cell.toml", "-q").out == (
        "overlap_at_start 0.0 still on it\ncontact 1.0 slow on it\ncontact 2.0 still slow\n"
    )
    assert (
        obbtree("scene", "cell.toml", "-q", "--first").out == "overlap_at_start 0.0 still on it\n"
    )
    assert obbtree("scene", "cell.toml", "-q", "--duration", "0", "--pairs", "still,slow").out == (
        "separated\n"
    )


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ((), 0),
        (("--exit-code",), 1),
        (("--exit-code", "--first"), 1),
        (("--exit-code", "--duration", "1"), 0),
        (("--exit-code", "--pairs", "slow,far, far"), 0),
        (("--exit-code", "--max-iterations", "1"), 4),
        (("--timeout", "0"), 4),
        (("--exit-code", "--timeout", "0"), 4),
        (("--exit-code", "--method", "sampled"), 1),
    ],
)
@pytest.mark.usefixtures("scene")
def test_exit_code_tells_the_answer(options: tuple[str, ...], code: int, obbtree: Run) -> None:
    assert obbtree("scene", "cell.toml", *options).code == code


def test_separated_by_samples_is_no_proof(obbtree: Run, scene: Path) -> None:
    add(
        scene,
        '[[body]]\nname = "turning"\nmesh = "cube.stl"\npose = { translation = [0, 1.05, 0] }\n'
        "motion = { angular_velocity = [0, 0, 1.5707963267948966], pivot = [0.5, 1.55, 0] }\n",
    )
    options = ("--pairs", "still,turning", "--exit-code")

    assert obbtree("scene", "cell.toml", *options).code == 1
    ended = obbtree("scene", "cell.toml", *options, "--method", "sampled", "--steps", "4")
    assert ended.code == 4
    assert "no contact in the whole duration as sampled" in ended.out


def test_options_override_the_file(obbtree: Run, scene: Path) -> None:
    (scene / "cell.toml").write_text("accuracy = { clearance = 0.5, max_iterations = 777 }" + SCENE)

    plain = obbtree("scene", "cell.toml", "--json").json
    given = obbtree("scene", "cell.toml", "--json", "--clearance", "0", "--duration", "3").json

    assert plain["result"]["time"] == pytest.approx(1.5)
    assert plain["accuracy"]["max_iterations"] == given["accuracy"]["max_iterations"] == 777
    assert (given["result"]["time"], given["duration"]) == (2, 3)


@pytest.mark.usefixtures("scene")
def test_sampled_file_takes_steps_from_the_command_line(obbtree: Run, here: Path) -> None:
    (here / "cell.toml").write_text('accuracy = { method = "sampled" }' + SCENE)

    document = obbtree("scene", "cell.toml", "--steps", "9", "--json").json

    assert document["accuracy"]["steps"] == 9


@pytest.mark.usefixtures("scene")
def test_lists_every_pair_of_triangles(obbtree: Run) -> None:
    whole = obbtree("scene", "cell.toml", "--all-contacts", "--json").json["result"]
    cut = obbtree("scene", "cell.toml", "--all-contacts", "--limit", "3", "--json").json["result"]

    assert len(whole["contacts"]) > 3
    assert whole["contacts_complete"]
    assert cut["contacts"] == whole["contacts"][:3]
    assert not cut["contacts_complete"]


def test_limit_cuts_the_list_of_bodies(obbtree: Run, scene: Path) -> None:
    add(scene, '[[body]]\nname = "on it"\nmesh = "touching.obj"\n')

    result = obbtree("scene", "cell.toml", "--limit", "2", "--json").json["result"]

    assert [contact["body_b"] for contact in result["contacts"]] == ["on it", "on it"]
    assert not result["contacts_complete"]


@pytest.mark.usefixtures("scene")
def test_explains_what_of_each_body_was_used(obbtree: Run) -> None:
    lines = obbtree("scene", "cell.toml", "--explain").out.splitlines()

    assert " ".join(lines[-1].split()) == "far, far far.stl 12 of 12 0 of 11"


def test_scene_from_standard_input_finds_meshes_in_the_working_folder(
    obbtree: Run, scene: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with (scene / "cell.toml").open() as file:
        monkeypatch.setattr("sys.stdin", file)
        document = obbtree("scene", "-", "--json").json

    assert document["inputs"]["scene"]["path"] == "-"
    assert document["inputs"] == {
        **obbtree("scene", "cell.toml", "--json").json["inputs"],
        "scene": document["inputs"]["scene"],
    }
    assert document["result"]["time"] == 2


def test_unresolved_pairs_are_listed(obbtree: Run, scene: Path) -> None:
    ended = obbtree("scene", "cell.toml", "--timeout", "0")
    document = obbtree("scene", "cell.toml", "--timeout", "0", "--json").json

    assert "answer          a limit was reached: what touches is known before t = 1.99" in ended.out
    (one,) = document["result"]["unresolved"]
    assert (one["body_a"], one["body_b"]) == ("still", "slow")
    assert 1.9 < one["time"] < 2
    assert document["result"]["status"] == "unresolved"
    assert obbtree("scene", "cell.toml", "--timeout", "0", "-q").out.startswith("unresolved 1.99")


@pytest.mark.parametrize("lists", [(), ("--all-contacts",)])
def test_interrupt_prints_what_is_known(
    lists: tuple[str, ...], obbtree: Run, scene: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    add(scene, '[[body]]\nname = "on it"\nmesh = "touching.obj"\n')
    take_in = FirstContacts._take_in

    def interrupted(self: FirstContacts, done: Round) -> None:
        if self._best < 1 and any(item.time > 0 for item in done.gone) and not self._is_stopped:
            raise KeyboardInterrupt
        take_in(self, done)

    monkeypatch.setattr(FirstContacts, "_take_in", interrupted)

    ended = obbtree("scene", "cell.toml", "--json", *lists)

    result = ended.json["result"]
    assert ended.code == 130
    assert result["interrupted"]
    assert {contact["body_a"] for contact in result["contacts"]} == {"still"}
    assert len(result["unresolved"]) == 2
    assert (ended.error["code"], ended.error["remedy"]) == (130, "unresolved pairs: 2")


def test_threads_change_nothing_and_go_with_all_contacts_alone(obbtree: Run, scene: Path) -> None:
    add(scene, '[[body]]\nname = "on it"\nmesh = "touching.obj"\n')
    found = [obbtree("scene", "cell.toml", "--json", "--threads", n).json for n in "13"]

    assert found[0]["result"] == found[1]["result"]
    assert found[0]["result"]["contacts"]
    for other in ("--first", "--all-contacts"):
        refused = obbtree("scene", "cell.toml", "--threads", "2", other)
        assert refused.code == 2
        assert f"one question is asked at a time with {other}" in refused.err
