"""`obbtree distance`: answers, documents, exit codes, and options that are never ignored."""

from __future__ import annotations

import json
from dataclasses import fields

import pytest
from mesh_files.cube_files import as_input, cube, obj

from obbcli import Accuracy, __version__
from obbcli.report.distance import distance_bare

KEYS = ["schema", "tool_version", "inputs", "motion", "accuracy", "result", "stats"]
RESULT = ["distance", "bounds", "point_a", "point_b", "triangle_a", "triangle_b", "complete"]


def test_distance_document_holds_what_was_asked_and_answered(here, obbtree):
    words = ("distance", "cube.stl", "touching.obj", "--translate-b", 0.5, 0, 0, "--json")

    ended = obbtree(*words)

    document = ended.json
    assert ended.code == 0
    assert ended.err == ""
    assert list(document) == KEYS
    assert document["schema"] == "obbtree/distance/1"
    assert document["tool_version"] == __version__
    assert document["inputs"]["a"] == as_input(here / "cube.stl")
    assert document["motion"]["duration"] == 0.0
    assert document["motion"]["b"]["pose"]["translation"] == [0.5, 0, 0]
    assert document["accuracy"] == Accuracy().as_dict()
    assert set(document["stats"]["seconds"]) == {"load", "query"}
    result = document["result"]
    assert list(result) == RESULT
    assert result["bounds"][0] <= 0.5 <= result["bounds"][1] == result["distance"]
    assert result["bounds"][1] - result["bounds"][0] <= 2**-51
    assert result["point_a"][0] == 1.0
    assert result["point_b"][0] == 1.5
    assert result["complete"] is True


def test_distance_of_cubes_that_touch_is_zero(here, obbtree):
    result = obbtree("distance", "cube.stl", "touching.obj", "--json").json["result"]

    assert result["distance"] == 0
    assert result["bounds"] == [0, 0]
    assert result["point_a"] == result["point_b"]
    assert result["point_a"][0] == 1.0


def test_distance_of_cubes_a_hair_apart_is_the_hair(here, obbtree):
    low, high = obbtree("distance", "cube.stl", "apart.obj", "--json").json["result"]["bounds"]

    assert low <= 2**-40 <= high
    assert high - low <= 2**-90


def test_distance_table_tells_it_to_people(here, obbtree):
    ended = obbtree("distance", "cube.stl", "touching.obj", "--translate-b", 3, 0, 0)

    lines = dict(line.split("  ", 1) for line in ended.out.splitlines())
    assert float(lines["distance"]) == pytest.approx(3.0, rel=1e-15)
    assert lines["bounds"].strip().endswith("proven")
    assert "cube.stl (12 triangles)" in ended.out
    assert lines["point of A"].strip().startswith("1 ")
    assert lines["point of B"].strip().startswith("4 ")


def test_distance_table_says_that_they_touch(here, obbtree):
    out = obbtree("distance", "cube.stl", "touching.obj").out

    assert "0.0 (they touch)" in out
    assert "bounds" not in out


def test_distance_quiet_answers_in_one_number(here, obbtree):
    out = obbtree("distance", "cube.stl", "touching.obj", "-q", "--translate-b", 0, 0, 2).out

    assert float(out) == pytest.approx(1.0, rel=1e-15)
    assert out.count("\n") == 1


@pytest.mark.parametrize(
    ("shift", "line"),
    [((3, 0, 0), "3.0\n"), ((3, 5, 0), "5.0\n"), ((0.5, 0, 0), "0.5\n"), ((0, 0, 0), "0.0\n")],
)
def test_distance_quiet_is_the_middle_of_its_bounds(here, obbtree, shift, line):
    # Unit cubes that share a face before the shift; 5 is the hypotenuse over gaps of 3 and 4.
    words = ("distance", "cube.stl", "touching.obj", "--translate-b", *shift)

    low, high = obbtree(*words, "--json").json["result"]["bounds"]

    assert obbtree(*words, "--quiet").out == line
    assert low <= float(line) <= high


@pytest.mark.parametrize(
    ("bounds", "told"), [([1.0, 5.0], "5.0"), ([5.0, 7.0], "5.0"), ([4.0, 7.0], "5.5")]
)
def test_distance_quiet_is_a_bound_that_the_printed_points_have(bounds, told):
    points = {"point_a": [1.0, 0.0, 2.0], "point_b": [1.0, 3.0, -2.0]}

    assert distance_bare({"result": {"bounds": bounds, **points}}) == f"{told}\n"


@pytest.mark.parametrize(
    ("other", "words", "code"),
    [
        ("touching.obj", (), 0),
        ("touching.obj", ("--exit-code",), 1),
        ("apart.obj", ("--exit-code",), 0),
        ("apart.obj", ("--exit-code", "--max-depth", "0"), 0),
        ("apart.obj", ("--max-iterations", "1"), 4),
        ("apart.obj", ("--exit-code", "--max-iterations", "1"), 4),
    ],
)
def test_distance_exit_codes(here, obbtree, other, words, code):
    assert obbtree("distance", "cube.stl", other, *words).code == code


def test_distance_at_a_limit_says_so(here, obbtree):
    words = ("distance", "cube.stl", "apart.obj", "--max-iterations", 1)

    assert "proven; a limit was reached" in obbtree(*words).out
    result = obbtree(*words, "--json").json["result"]
    assert result["complete"] is False
    assert result["bounds"][0] <= 2**-40 <= result["bounds"][1]


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        (("--vel", "1", "0", "0"), "--vel: moves bodies; the distance is that at t = 0"),
        (("--omega-b", "0", "0", "0"), "--omega-b: moves bodies"),
        (("--pivot", "0", "0", "0"), "--pivot: moves bodies"),
        (("--duration", "0"), "--duration: moves bodies"),
        (("--clearance", "0.5"), "--clearance: says nothing about a distance"),
        (("--time-tolerance", "1"), "--time-tolerance: says nothing about a distance"),
        (("--method", "sampled"), "--method: says nothing about a distance"),
        (("--steps", "5"), "--steps: says nothing about a distance"),
        (("--integrator", "rk4"), "--integrator: says nothing about a distance"),
        (("--solid",), "No such option"),
        (("--distance-tolerance", "-1"), "at least 0"),
        (("--max-depth-a", "-1"), "is not a whole number of at least 0"),
        (("--translate", "nan", "0", "0"), "'nan' is not a finite number"),
        (("extra.stl",), "unexpected extra argument"),
    ],
)
def test_distance_refuses_usage_that_means_nothing(here, obbtree, words, fault):
    ended = obbtree("distance", "cube.stl", "touching.obj", *words)

    assert ended.code == 2
    assert ended.out == ""
    assert ended.err.count("\n") == 1
    assert fault in ended.err


def test_distance_uses_the_accuracy_that_applies(here, obbtree):
    words = {
        "distance_tolerance": 0.25,
        "max_depth_a": 3,
        "max_depth_b": 4,
        "leaves": "boxes",
        "max_iterations": 1000,
        "timeout": 5.0,
    }
    options = [f"--{name.replace('_', '-')}={value}" for name, value in words.items()]

    used = obbtree("distance", "cube.stl", "apart.obj", *options, "--json").json["accuracy"]

    assert used == Accuracy(**words).as_dict()


def test_distance_help_names_every_field_of_accuracy_or_hides_it(obbtree):
    out = obbtree("distance", "--help").out

    shown = {f.name for f in fields(Accuracy) if f"--{f.name.replace('_', '-')}" in out}
    assert shown == {
        "distance_tolerance", "max_depth_a", "max_depth_b", "leaves", "max_iterations", "timeout",
    }  # fmt: skip
    assert "--vel" not in out
    assert "--translate-b" in out


def test_distance_is_the_same_on_meshes_and_trees(here, obbtree):
    obbtree("build", "cube.stl", "touching.obj")
    words = ("--rotate-b", 0.3, 0.2, 0.1, "--translate-b", 3, 0.25, 0, "--json")
    kinds = [(a, b) for a in ("cube.stl", "cube.obbt") for b in ("touching.obj", "touching.obbt")]

    documents = [obbtree("distance", a, b, *words).json for a, b in kinds]

    for document in documents:
        del document["stats"]
        del document["inputs"]
    assert all(json.dumps(one) == json.dumps(documents[0]) for one in documents)


def test_distance_out_of_range_names_the_option(here, obbtree):
    ended = obbtree("distance", "cube.stl", "touching.obj", "--translate-b", 1.7e308, 0, 0)

    assert ended.code == 2
    assert ended.err.startswith("error: --translate-b: ")


def test_distance_of_a_file_to_itself(here, obbtree):
    (here / "one.obj").write_text(obj(cube((5, 5, 5))))

    assert obbtree("distance", "one.obj", "one.obj", "-q").out == "0.0\n"


def test_distance_never_overwrites_an_input(here, obbtree):
    before = (here / "cube.stl").read_bytes()

    ended = obbtree("distance", "cube.stl", "touching.obj", "-o", "./cube.stl")

    assert ended.code == 2
    assert "is the input cube.stl, which would be lost" in ended.err
    assert (here / "cube.stl").read_bytes() == before
