"""`FILE#PATTERN` on the command line: what is asked about, what answers say of parts."""

from __future__ import annotations

import json

import pytest
from claims.schemas import require_valid, require_valid_lines
from mesh_files.cube_files import objects

from obbcli import Scene, load_mesh


@pytest.fixture
def robot(here):
    """Write a file of four cubes: arm and arm#2 touch base, tip is far off."""
    text = objects(base=0.0, arm=1.0, other=-1.0, tip=10.0).replace("o other", "o arm")
    (here / "robot.obj").write_text(text)
    return here


def test_answers_are_about_the_selected_parts_and_name_them(robot, obbtree):
    answer = obbtree("collide", "robot.obj#base", "robot.obj#**[pm]", "--json").json

    assert answer["inputs"]["b"]["path"] == "robot.obj#**[pm]"
    assert answer["inputs"]["a"]["sha256"] == answer["inputs"]["b"]["sha256"]
    assert answer["inputs"]["a"]["parts"] == [
        {"path": "base", "first_triangle": 0, "triangle_count": 12}
    ]
    assert answer["inputs"]["b"]["parts"] == [
        {"path": "arm", "first_triangle": 0, "triangle_count": 12},
        {"path": "tip", "first_triangle": 12, "triangle_count": 12},
    ]
    result = answer["result"]
    assert (result["status"], result["part_a"], result["part_b"]) == (
        *("overlap_at_start", "base"),
        "arm",
    )
    assert result["witness"][1] < 12


def test_tables_name_the_parts(robot, obbtree):
    words = "collide", "robot.obj#base", "robot.obj#arm*"

    assert "base of A and arm of B" in " ".join(obbtree(*words).out.split())


def test_contacts_and_distances_name_the_parts_of_their_triangles(robot, obbtree):
    pair = "robot.obj#tip", "robot.obj#[ab]*"
    motion = "--vel", -8, 0, 0, "--duration", 2

    first = obbtree("first-contact", *pair, *motion, "--all-contacts", "--json").json["result"]
    apart = obbtree("distance", *pair, "--json").json["result"]

    assert (first["part_a"], first["part_b"], first["time"]) == ("tip", "arm", 1.0)
    # The arm ends at x = 2, the base at 1 and the other arm at 0.
    assert {(c["part_a"], c["part_b"]) for c in first["contacts"]} >= {("tip", "arm")}
    assert (apart["part_a"], apart["part_b"], apart["distance"]) == ("tip", "arm", pytest.approx(8))


def test_one_selection_names_no_part_of_the_other_body(robot, obbtree):
    result = obbtree("collide", "robot.obj#base", "cube.stl", "--json").json["result"]

    assert (result["part_a"], result["part_b"]) == ("base", None)


def test_bodies_that_are_apart_name_no_parts(robot, obbtree):
    result = obbtree("collide", "robot.obj#base", "robot.obj#tip", "--json").json["result"]

    assert (result["witness"], result["part_a"], result["part_b"]) == (None, None, None)


def test_whole_files_answer_as_before(robot, obbtree):
    answer = obbtree("collide", "robot.obj", "robot.obj", "--json").json

    assert "parts" not in answer["inputs"]["a"]
    assert "part_a" not in answer["result"]


def test_every_command_takes_a_selection(robot, obbtree):
    pair = "robot.obj#base", "robot.obj#tip"
    (robot / "q.csv").write_text("vel\n0 0 0\n9.5 0 0\n")

    assert obbtree("info", pair[0]).code == 0
    assert obbtree("info", pair[0], "--json").json["result"]["triangle_count"] == 12
    assert obbtree("view", *pair, "-o", "view.glb").code == 0
    assert obbtree("tradeoff", *pair, "--vel", 9, 0, 0, "--budget", "0.1").code in (0, 6)
    assert obbtree("stability", *pair).code == 0
    answers = obbtree("sweep", *pair, "q.csv", "-o", "r.jsonl", "--duration", 1, "--quiet")
    assert answers.code == 0
    assert len((robot / "r.jsonl").read_text().splitlines()) == 3


def test_rows_of_sweeps_name_the_parts(robot, obbtree):
    (robot / "q.csv").write_text("vel\n-1 0 0\n-8.5 0 0\nfast\n")
    words = "q.csv", "-o", "r.jsonl", "--quiet", "--force"

    obbtree("sweep", "robot.obj#tip", "robot.obj#[ab]*", *words)
    text = (robot / "r.jsonl").read_text()
    apart, meets, refused = [json.loads(line) for line in text.splitlines()[1:]]
    obbtree("sweep", "robot.obj", "robot.obj", *words)
    whole = (robot / "r.jsonl").read_text()

    assert (apart["part_a"], apart["part_b"]) == (None, None)
    assert (meets["part_a"], meets["part_b"]) == ("tip", "arm")
    assert "part_a" not in refused
    assert "part_a" not in whole
    require_valid_lines(text)
    require_valid_lines(whole)


def test_studies_and_pictures_name_the_parts(robot, obbtree):
    pair = "robot.obj#tip", "robot.obj#[ab]*", "--vel", -8.5, 0, 0, "--json"

    trade = obbtree("tradeoff", *pair, "--budget", "0.5").json
    held = obbtree("stability", *pair).json
    view = obbtree("view", *pair, "-o", "view.glb").json

    reference, rows = trade["result"]["reference"], trade["result"]["rows"]
    for answer in (reference, held["result"]["answer"], view["result"]):
        assert (answer["part_a"], answer["part_b"]) == ("tip", "arm")
    assert all("part_a" in row for row in rows)
    for document in (trade, held, view):
        require_valid(document)


def test_every_document_of_a_selection_is_as_its_schema_says(robot, obbtree):
    pair = "robot.obj#[bt]*", "robot.obj#[at]*"
    (robot / "s.toml").write_text(
        "".join(f'[[body]]\nname = "{name}"\nmesh = "{name}"\n' for name in pair)
    )

    require_valid(obbtree("collide", *pair, "--json").json)
    require_valid(obbtree("first-contact", *pair, "--all-contacts", "--json").json)
    require_valid(obbtree("distance", *pair, "--json").json)
    require_valid(obbtree("scene", "s.toml", "--json").json)


def test_sweep_of_another_selection_is_not_resumed(robot, obbtree):
    (robot / "q.csv").write_text("vel\n0 0 0\n")
    words = "q.csv", "-o", "r.jsonl", "--duration", 1, "--quiet"

    assert obbtree("sweep", "robot.obj#base", "robot.obj#tip", *words).code == 0
    again = obbtree("sweep", "robot.obj#base", "robot.obj#tip", *words, "--resume")
    other = obbtree("sweep", "robot.obj#base", "robot.obj#arm", *words, "--resume")

    assert again.code == 0
    assert other.code == 3


def test_tree_of_a_selection_keeps_its_parts(robot, obbtree):
    built = obbtree("build", "robot.obj#arm*", "-o", "arms.obbt", "--json").json
    direct = obbtree("collide", "robot.obj#arm*", "robot.obj#base", "--json").json["result"]
    through = obbtree("collide", "arms.obbt", "robot.obj#base", "--json").json

    rows = [("arm", 0, 12), ("arm#2", 12, 12)]
    assert [tuple(one.values()) for one in built["inputs"][0]["parts"]] == rows
    assert [tuple(one.values()) for one in through["inputs"]["a"]["parts"]] == rows
    assert through["result"] == direct
    assert direct["part_a"] in ("arm", "arm#2")


def test_tree_of_a_selection_needs_a_name(robot, obbtree):
    (robot / "trees").mkdir()

    for more in (), ("-o", "trees"):
        ended = obbtree("build", "robot.obj#arm", *more)
        assert ended.code == 2
        assert "robot.obj#arm: selects parts of a file, which name no tree" in ended.err
        assert "-o FILE" in ended.err


def test_tree_file_has_no_parts_to_select(robot, obbtree):
    obbtree("build", "robot.obj")

    ended = obbtree("info", "robot.obbt#arm")

    assert ended.code == 3
    assert "robot.obbt: has no parts to take 'arm' from" in ended.err
    assert "obbtree build 'MESH#PATTERN' -o FILE" in ended.err


def test_output_does_not_replace_the_file_that_parts_are_of(robot, obbtree):
    ended = obbtree("info", "robot.obj#arm", "--json", "-o", "robot.obj")

    assert ended.code == 2
    assert "is the input robot.obj, which would be lost" in ended.err


def test_scene_bodies_are_parts(robot, obbtree):
    text = ""
    for name, pattern in (("base", "base"), ("arms", "arm*"), ("first", "arm"), ("tip", "tip")):
        text += f'[[body]]\nname = "{name}"\nmesh = "robot.obj#{pattern}"\n'
    (robot / "s.toml").write_text(text)

    answer = obbtree("scene", "s.toml", "--json").json

    assert [mesh["path"] for mesh in answer["inputs"]["meshes"]] == [
        f"robot.obj#{pattern}" for pattern in ("base", "arm*", "arm", "tip")
    ]
    contacts = answer["result"]["contacts"]
    assert [(c["body_a"], c["part_a"], c["body_b"], c["part_b"]) for c in contacts] == [
        ("base", "base", "arms", contacts[0]["part_b"]),
        ("base", "base", "first", "arm"),
        ("arms", "arm", "first", "arm"),
    ]
    names = [(c.body_a, c.body_b) for c in Scene.load("s.toml").first_contacts()]
    assert names == [(c["body_a"], c["body_b"]) for c in contacts]


def test_python_takes_selections_wherever_a_path_is_taken(robot):
    import obbcli

    tree = obbcli.ObbTree.build("robot.obj#arm")
    assert (tree.triangle_count, tree.parts) == (12, (("arm", 0, 12),))
    assert obbcli.collide("robot.obj#base", tree).collides
    assert not obbcli.collide(obbcli.Body("robot.obj#base"), "robot.obj#tip").collides
    assert tree.mesh.parts == load_mesh("robot.obj#arm").parts
    found = obbcli.ObbTree.from_bytes(tree.to_bytes())
    assert (found.parts, found.mesh.parts) == (tree.parts, tree.parts)


def test_overlaps_name_the_parts_that_are_deep_in_each_other(robot, obbtree):
    words = ("overlap", "robot.obj#base", "robot.obj#**[pm]", "--translate", 0.25, 0, 0)

    result = obbtree(*words, "--json").json["result"]

    assert result["relation"] == "overlapping"
    for name in ("thickness", "protrusion_a", "protrusion_b"):
        assert (result[name]["part_a"], result[name]["part_b"]) == ("base", "arm")
    assert "(base of A and arm of B)" in obbtree(*words).out


def test_overlaps_of_whole_files_name_no_parts(here, obbtree):
    words = ("overlap", "cube.stl", "cube.stl", "--translate", 0.25, 0, 0, "--json")

    assert "part_a" not in obbtree(*words).json["result"]["thickness"]
