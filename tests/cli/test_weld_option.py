"""`--weld` of all commands that read meshes, and `weld` of scenes: what closes and is told."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from mesh_files.cube_files import cube, obj

CLOSED = "welded within 1e-12: 5 vertices moved by at most 2.4492935982947064e-16"


@pytest.fixture
def files(here):
    """Write a drum whose seam is open by the sine of 2 pi, and a pebble inside it."""
    turns = [2 * math.pi * k / 16 for k in range(17)]
    ring = [(math.cos(a), math.sin(a)) for a in turns]
    facets = []
    for (x, y), (u, v) in pairwise(ring):
        facets += [[(x, y, -1), (u, v, -1), (u, v, 1)], [(x, y, -1), (u, v, 1), (x, y, 1)]]
        facets += [[(0, 0, 1), (x, y, 1), (u, v, 1)], [(0, 0, -1), (u, v, -1), (x, y, -1)]]
    corners = [corner for facet in facets for corner in facet]
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in corners]
    lines += [f"f {k} {k + 1} {k + 2}" for k in range(1, len(corners), 3)]
    (here / "drum.obj").write_text("\n".join(lines) + "\n")
    pebble = [(0.4 * x, 0.4 * y, 0.4 * z) for x, y, z in cube((-0.5, -0.5, -0.5))]
    (here / "pebble.obj").write_text(obj(pebble))
    return here


def test_welded_drum_holds_the_pebble(files, obbtree):
    plain = obbtree("collide", "drum.obj", "pebble.obj", "--solid")
    ended = obbtree(
        "collide", "drum.obj", "pebble.obj", "--solid", "--weld", 1e-12, "--json", "--exit-code"
    )

    assert plain.code == 3
    assert (ended.code, ended.json["result"]["status"]) == (1, "overlap_at_start")
    assert ended.json["inputs"]["a"]["notes"] == [CLOSED]
    assert ended.json["inputs"]["b"]["notes"] == ["welded within 1e-12: no vertex moved"]


def test_info_and_trees_tell_the_welding(files, obbtree):
    info = obbtree("info", "drum.obj", "--weld", 1e-12, "--json").json
    obbtree("build", "drum.obj", "--weld", 1e-12, "-o", "d.obbt")
    tree = obbtree("info", "d.obbt", "--json").json
    through = obbtree("collide", "d.obbt", "pebble.obj", "--solid", "--json").json
    again = obbtree("collide", "d.obbt", "pebble.obj", "--weld", 1e-12)

    assert info["result"]["is_watertight"] is True
    for record in info, tree:
        assert record["inputs"]["file"]["notes"] == [CLOSED]
    assert through["result"]["status"] == "overlap_at_start"
    assert again.code == 3
    remedy = "is not welded; build one: obbtree build drum.obj --weld 1e-12 -o FILE"
    assert remedy in again.err


def test_distance_is_in_the_unit_of_the_file_before_it_is_scaled(files, obbtree):
    ended = obbtree(
        "distance", "drum.obj", "pebble.obj", "--scale", 1000, "--weld", 1e-12, "--json"
    )

    assert ended.json["inputs"]["a"]["notes"][:2] == [CLOSED, "coordinates times 1000.0"]


@pytest.mark.parametrize("command", ["collide", "first-contact", "distance", "stability"])
def test_commands_about_two_weld(files, obbtree, command):
    ended = obbtree(command, "drum.obj", "pebble.obj", "--weld", 1e-12, "--json")

    assert (ended.code, ended.json["inputs"]["a"]["notes"]) == (0, [CLOSED])


def test_pictures_weld_and_refuse_what_is_of_no_body(files, obbtree):
    both = obbtree("view", "drum.obj", "pebble.obj", "--solid", "--weld", 1e-12, "-o", "v.glb")
    one = obbtree("view", "drum.obj", "--weld", 1e-12, "-o", "w.glb", "--json")
    none = obbtree("view", "drum.obj", "--scale-b", 2, "-o", "x.glb")

    assert (both.code, one.code, none.code) == (0, 0, 2)
    assert one.json["inputs"]["a"]["notes"] == [CLOSED]
    assert "--scale-b: is about two bodies, and there is no B" in none.err


def test_sweep_remembers_the_welding(files, obbtree):
    (files / "q.csv").write_text("vel\n0 0 0\n")
    words = "sweep", "drum.obj", "pebble.obj", "q.csv", "-o", "r.jsonl", "--duration", 1, "--quiet"

    assert obbtree(*words, "--weld", 1e-12).code == 0
    assert obbtree(*words, "--resume").code == 3


def test_scene_welds_a_body(files, obbtree):
    body = '[[body]]\nname = "{0}"\nmesh = "{0}.obj"\n'
    text = body.format("drum") + "weld = 1e-12\n" + body.format("pebble")
    (files / "s.toml").write_text(text)

    meshes = obbtree("scene", "s.toml", "--json").json["inputs"]["meshes"]

    assert [mesh["notes"] for mesh in meshes] == [[CLOSED], []]
    (files / "s.toml").write_text(text.replace("1e-12", "0"))
    refused = obbtree("scene", "s.toml")
    assert refused.code == 3
    assert "body[0] 'drum'.weld: is 0; use a number above 0" in refused.err
    (files / "s.toml").write_text(text.replace("drum.obj", "d.obbt"))
    obbtree("build", "drum.obj", "-o", "d.obbt")
    assert "is a tree file, which is not welded" in obbtree("scene", "s.toml").err


def test_distances_too_large_or_none_are_refused(files, obbtree):
    wide = obbtree("info", "drum.obj", "--weld", 1.2)
    parts = obbtree("info", "drum.obj", "--weld", 1, "--parts")

    assert wide.code == 3
    assert "drum.obj: weld: 1.2 joins vertices " in wide.err
    assert "by steps, and they are 2.0 apart" in wide.err or "apart; use a smaller" in wide.err
    assert parts.code == 2
    for number in 0, -1, "nan":
        assert obbtree("info", "drum.obj", "--weld", number).code == 2
