"""`--unit`, `--scale` and `--scale-b`: what is scaled, noted and refused."""

from __future__ import annotations

import pytest
from mesh_files.cube_files import cube, obj
from mesh_files.gltf_files import DOCUMENT, glb

from obbcli import notes as notes_of

MOTION = "--vel", 0, 0, 0


@pytest.fixture
def files(here):
    """Write a square in metres, and cubes in no unit: as large, and a thousand times as large."""
    (here / "m.glb").write_bytes(glb(DOCUMENT))
    (here / "one.obj").write_text(obj(cube()))
    (here / "mm.obj").write_text(obj([tuple(1000 * x for x in corner) for corner in cube()]))
    (here / "far.obj").write_text(obj(cube((5000, 0, 0))))
    return here


def notes(answer, side):
    return answer["inputs"][side]["notes"]


def test_sizes_far_apart_are_told(files, obbtree):
    answer = obbtree("collide", "one.obj", "mm.obj", "--json").json

    assert notes(answer, "a") == []
    assert notes(answer, "b") == [
        "is 1,000 times the size of A: is one of them in another unit? See --unit, --scale"
    ]
    swapped = obbtree("collide", "mm.obj", "one.obj").out
    assert "A: is 1,000 times the size of B" in swapped
    assert notes(obbtree("collide", "one.obj", "cube.stl", "--json").json, "b") == []


def test_scale_multiplies_one_body(files, obbtree):
    same = obbtree("distance", "mm.obj", "far.obj", "--json").json
    scaled = obbtree("distance", "one.obj", "far.obj", "--scale", 1000, "--json").json
    of_b = obbtree("distance", "far.obj", "one.obj", "--scale-b", 1000, "--json").json

    assert scaled["result"] == same["result"]
    assert of_b["result"]["distance"] == same["result"]["distance"]
    assert notes(scaled, "a")[0] == "coordinates times 1000.0"


def test_one_file_may_be_scaled_once(files, obbtree):
    answer = obbtree("distance", "far.obj", "far.obj", "--scale-b", 2, "--json").json

    assert answer["result"]["distance"] == pytest.approx(10_000 - 5_001)


def test_unit_scales_what_states_another_and_takes_the_rest_to_be_in_it(files, obbtree):
    answer = obbtree("collide", "m.glb", "mm.obj", "--unit", "mm", "--json").json

    assert notes(answer, "a") == ["from m to mm: coordinates times 1000"]
    assert notes(answer, "b") == []
    assert [answer["inputs"][side]["unit"] for side in "ab"] == ["mm", "mm"]
    assert answer["result"]["status"] == "overlap_at_start"
    plain = obbtree("collide", "m.glb", "one.obj", "--unit", "m", "--json").json
    assert (notes(plain, "a"), plain["inputs"]["a"]["unit"]) == ([], "m")


def test_unit_beside_none_is_told(files, obbtree):
    answer = obbtree("collide", "m.glb", "one.obj", "--json").json

    assert notes(answer, "b") == ["states no unit of length, A is in m: see --unit, --scale"]
    assert "unit" not in answer["inputs"]["b"]


def test_trees_keep_the_unit_and_refuse_another(files, obbtree):
    built = obbtree("build", "m.glb", "--unit", "mm", "-o", "mm.obbt", "--json").json
    direct = obbtree("collide", "m.glb", "one.obj", "--unit", "mm", "--json").json
    through = obbtree("collide", "mm.obbt", "one.obj", "--unit", "mm", "--json").json
    other = obbtree("collide", "mm.obbt", "one.obj", "--unit", "m")
    scaled = obbtree("collide", "mm.obbt", "one.obj", "--scale", 2)
    mixed = obbtree("collide", "mm.obbt", "m.glb")

    assert built["inputs"][0]["unit"] == "mm"
    assert through["result"] == direct["result"]
    assert (other.code, scaled.code, mixed.code) == (3, 3, 3)
    assert "mm.obbt: is a tree in mm, not m; build one: obbtree build m.glb --unit m" in other.err
    assert "is not scaled; build one: obbtree build m.glb --scale 2.0 -o FILE" in scaled.err
    assert "A is in mm, B in m; bring both to one: --unit U" in mixed.err


def test_every_command_tells_of_units_and_sizes(files, obbtree):
    (files / "q.csv").write_text("vel\n0 0 0\n")
    more = {"sweep": ("q.csv", "-o", "r.jsonl", "--force"), "view": ("-o", "v.glb", "--force")}
    more["tradeoff"] = ("--budget", "0.1")
    commands = "collide", "first-contact", "distance", "sweep", "tradeoff", "stability", "view"

    for pair in ("one.obj", "mm.obj"), ("one.obj", "m.glb"):
        wanted = [text.split(" ", 1)[1].split("ee ")[0] for text in notes_of(*pair)]
        assert len(wanted) == 1
        for command in commands:
            ended = obbtree(command, *pair, *more.get(command, ()), "--json")
            told = [note for side in "ab" for note in notes(ended.json, side)]
            assert [text.split("ee ")[0] for text in told] == wanted, command


def test_every_command_refuses_two_units(files, obbtree):
    obbtree("build", "m.glb", "--unit", "mm", "-o", "mm.obbt")
    (files / "q.csv").write_text("vel\n0 0 0\n")
    more = {"sweep": ("q.csv", "-o", "r.jsonl"), "view": ("-o", "v.glb")}

    for command in "collide", "first-contact", "distance", "sweep", "tradeoff", "stability", "view":
        ended = obbtree(command, "mm.obbt", "m.glb", *more.get(command, ()))
        assert ended.code == 3, command
        assert "unit: A is in mm, B in m; bring both to one" in ended.err, command
    assert obbtree("collide", "mm.obbt", "m.glb", "--all-pairs").code == 3
    assert not (files / "r.jsonl").exists()


def test_tree_of_a_scaled_mesh_says_so(files, obbtree):
    obbtree("build", "one.obj", "--scale", 1000, "--unit", "mm", "-o", "s.obbt")

    info = obbtree("info", "s.obbt", "--json").json

    assert info["inputs"]["file"]["notes"] == ["coordinates times 1000.0"]
    assert info["inputs"]["file"]["unit"] == "mm"
    assert info["result"]["bounds"] == [[0, 0, 0], [1000, 1000, 1000]]


@pytest.mark.parametrize("command", ["collide", "first-contact", "distance", "stability"])
def test_commands_about_two_take_units(files, obbtree, command):
    ended = obbtree(command, "one.obj", "far.obj", "--unit", "mm", "--scale", 10, "--json")

    assert ended.code == 0
    assert ended.json["inputs"]["a"]["unit"] == "mm"


def test_other_commands_take_units(files, obbtree):
    (files / "q.csv").write_text("vel\n0 0 0\n")
    pair = "one.obj", "far.obj", "--scale", 10

    assert obbtree("view", *pair, "-o", "v.glb").code == 0
    assert obbtree("tradeoff", *pair, "--vel", 1, 0, 0, "--budget", "0.1").code in (0, 6)
    words = "sweep", "one.obj", "far.obj", "q.csv", "-o", "r.jsonl", "--duration", 1, "--quiet"
    assert obbtree(*words, "--scale", 10).code == 0
    assert obbtree(*words, "--resume").code == 3


def test_scales_and_units_that_are_none_are_usage_errors(files, obbtree):
    for words in ("--scale", 0), ("--scale-b", -1), ("--scale", "nan"), ("--unit", "ell"):
        assert obbtree("collide", "one.obj", "far.obj", *words).code == 2
    assert obbtree("build", "one.obj", "--scale", 0).code in (2, 3)
    ended = obbtree("collide", "one.obj", "far.obj", "--scale", "1e308")
    assert ended.code in (0, 3)


def test_scene_tells_files_without_a_unit_beside_others(files, obbtree):
    text = "".join(f'[[body]]\nname = "{name}"\nmesh = "{name}"\n' for name in ("m.glb", "one.obj"))
    (files / "s.toml").write_text(text)
    (files / "t.toml").write_text('unit = "m"\n' + text)

    plain = obbtree("scene", "s.toml", "--json").json["inputs"]["meshes"]
    told = obbtree("scene", "t.toml", "--json").json["inputs"]["meshes"]

    assert [mesh["notes"] for mesh in plain] == [
        ["is in m, 1 other file states no unit of length: see unit and scale of scenes"],
        [],
    ]
    assert [(mesh["notes"], mesh["unit"]) for mesh in told] == [([], "m"), ([], "m")]


def test_scene_tells_every_scale_of_a_file(files, obbtree):
    bodies = [f'[[body]]\nname = "{k}"\nmesh = "one.obj"\nscale = {k}\n' for k in (2, 3)]
    (files / "s.toml").write_text("".join(bodies))

    (mesh,) = obbtree("scene", "s.toml", "--json").json["inputs"]["meshes"]

    assert mesh["notes"] == ["coordinates times 2.0", "coordinates times 3.0"]


def test_info_shows_the_unit_and_takes_another(files, obbtree):
    built = obbtree("build", "m.glb", "--unit", "mm", "--scale", 3, "-o", "t.obbt", "--json")
    of_tree = obbtree("info", "t.obbt", "--unit", "mm", "--json").json["result"]
    of_mesh = obbtree("info", "m.glb", "--unit", "mm", "--scale", 3, "--json").json
    table = obbtree("info", "m.glb", "--unit", "cm").out

    assert built.code == 0
    assert of_mesh["result"]["bounds"] == of_tree["bounds"] == [[0, 0, 0], [3, 3, 0]]
    assert of_mesh["inputs"]["file"]["unit"] == "mm"
    assert "\nunit        cm\nc" in table
    assert "bounds      0 0 0  to  100 100 0\n" in table
    assert "note        from m to cm: coordinates times 100\n" in table
    assert "\nunit        m\n" in obbtree("info", "m.glb").out
    assert "\nunit        not stated\n" in obbtree("info", "one.obj").out


def test_info_refuses_to_scale_trees_and_lists_of_parts(files, obbtree):
    obbtree("build", "one.obj", "--unit", "mm", "-o", "t.obbt")

    scaled = obbtree("info", "t.obbt", "--scale", 2)
    other = obbtree("info", "t.obbt", "--unit", "m")

    assert (scaled.code, other.code) == (3, 3)
    assert "t.obbt: is a tree in mm, not m; build one: obbtree build one.obj" in other.err
    for words in ("--unit", "mm"), ("--scale", 2), ("--weld", 1e-9):
        listed = obbtree("info", "m.glb", "--parts", *words)
        assert (listed.code, listed.out) == (2, "")
        assert (
            f"{words[0]}: changes one mesh, and --parts lists the parts as they are" in listed.err
        )
    assert obbtree("info", "one.obj", "--scale", 0).code == 2
