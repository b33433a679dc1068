"""`--sag`: how far triangles may be from exact surfaces, and where it has no effect."""

from __future__ import annotations

import json

import pytest
from mesh_files.step_files import box, sphere

from obbcli.cli import main

needs_ocp = pytest.mark.needs("cadquery-ocp-novtk")
GEAR, NUT = "sample_meshes/gear.stl", "sample_meshes/nut.obj"


@pytest.fixture
def ball(tmp_path):
    path = tmp_path / "ball.step"
    path.write_bytes(sphere(1.0))
    return str(path)


def answer(capsys, *words):
    assert main([*words, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def refusal(capsys, code, *words):
    assert main([*words]) == code
    streams = capsys.readouterr()
    assert streams.out == ""
    return streams.err


@pytest.mark.parametrize("words", [("collide", GEAR, NUT), ("info", GEAR), ("build", GEAR)])
@pytest.mark.parametrize("sag", ["0", "-1", "nan", "inf", "x"])
def test_a_sag_that_is_none_is_a_usage_error(capsys, words, sag):
    assert "--sag" in refusal(capsys, 2, *words, "--sag", sag)


@pytest.mark.parametrize("command", ["collide", "first-contact", "distance", "tradeoff"])
def test_a_sag_for_two_files_of_triangles_is_a_usage_error(capsys, command):
    said = refusal(capsys, 2, command, GEAR, NUT, "--sag", "0.1")

    words = "error: --sag: cuts exact surfaces (STEP), and neither A nor B has any; leave it out"
    assert said.startswith(words)


@pytest.mark.parametrize("words", [("info", GEAR), ("info", NUT, "--parts"), ("build", GEAR)])
def test_a_sag_for_one_file_of_triangles_is_refused(capsys, words):
    said = refusal(capsys, 3, *words, "--sag", "0.1")

    fault = "holds triangles and no exact surfaces, which a sag would cut; leave out the sag"
    assert f"{words[1]}: {fault}" in said


def test_a_sag_for_a_scene_is_a_usage_error(capsys, tmp_path):
    body = '[[body]]\nname = "{}"\nmesh = "a.stl"\n'
    (tmp_path / "a.toml").write_text(body.format("a") + body.format("b"))
    scene = str(tmp_path / "a.toml")

    said = refusal(capsys, 2, "scene", scene, "--sag", "0.1")
    assert "--sag: cuts exact surfaces of a mesh file, and this is a scene; write sag = D" in said
    assert "--sag: is 0.0; use a number above 0" in refusal(capsys, 2, "scene", scene, "--sag", "0")


@needs_ocp
def test_a_sag_is_in_the_answer_and_its_note(capsys, ball):
    told = answer(capsys, "info", ball, "--sag", "0.01")

    assert told["inputs"]["file"]["sag"] == 0.01
    assert told["inputs"]["file"]["unit"] == "mm"
    assert "within 0.01 mm of them (the sag)" in told["inputs"]["file"]["notes"][0]


@needs_ocp
def test_a_sag_beside_a_file_of_triangles_is_told(capsys, ball):
    told = answer(capsys, "distance", ball, GEAR, "--sag", "0.01", "--translate", "50", "0", "0")

    assert told["inputs"]["a"]["sag"] == 0.01
    assert "sag" not in told["inputs"]["b"]
    assert "has no exact surfaces, which --sag 0.01 would cut" in told["inputs"]["b"]["notes"]


@needs_ocp
def test_two_balls_are_as_far_apart_as_their_sags_say(capsys, ball):
    words = ball, ball, "--sag", "0.01", "--translate", "3", "0", "0"
    low, high = answer(capsys, "distance", *words)["result"]["bounds"]

    assert 1.0 - 1e-12 <= low <= high <= 1.0 + 2 * 0.01


@needs_ocp
def test_a_tree_keeps_its_sag_and_takes_no_other(capsys, ball, tmp_path):
    tree = str(tmp_path / "ball.obbt")
    assert main(["build", ball, "--sag", "0.01", "--unit", "m", "-o", tree]) == 0
    capsys.readouterr()

    assert answer(capsys, "info", tree)["inputs"]["file"]["sag"] == pytest.approx(1e-5)
    said = refusal(capsys, 3, "info", tree, "--sag", "0.5")
    assert "is a tree file, of sag 1e-05; build one: obbtree build ball.step --sag 0.5" in said


@needs_ocp
def test_a_body_of_a_scene_has_its_sag(capsys, ball, tmp_path):
    body = '[[body]]\nname = "{}"\nmesh = "{}"\n{}\n'
    scene = tmp_path / "scene.toml"
    (tmp_path / "box.stp").write_bytes(box((5, 5, 5), (6, 6, 6)))
    scene.write_text(body.format("a", ball, "sag = 0.2") + body.format("b", "box.stp", ""))
    told = answer(capsys, "scene", str(scene))

    assert {name: told["inputs"]["meshes"][k].get("sag") for k, name in enumerate("ab")} == {
        "a": 0.2,
        "b": 0.0017,
    }
    scene.write_text(body.format("a", ball, "sag = 0.0") + body.format("b", "box.stp", ""))
    assert "sag" in refusal(capsys, 3, "scene", str(scene))


@needs_ocp
def test_a_scene_of_a_step_file_asks_about_its_parts(capsys, tmp_path):
    from mesh_files.step_files import ORIGIN, StepFile

    file = StepFile("mm")
    ball = file.product("ball", [file.solid([file.face_of_sphere(1.0)])])
    places = [((x, 0, 0), *ORIGIN[1:]) for x in (0, 1, 9)]
    file.assembly("top", *((name, ball, place) for name, place in zip("abc", places, strict=True)))
    path = tmp_path / "a.step"
    path.write_bytes(file.bytes())
    found = answer(capsys, "scene", str(path), "--sag", "0.05")["result"]

    touching = [(each["body_a"], each["body_b"]) for each in found["contacts"]]
    assert touching == [("top/a", "top/b")]
