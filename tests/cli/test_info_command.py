"""`obbtree info`: what it says of meshes and trees, and what `--check` finds."""

from __future__ import annotations

import hashlib
import json
import math

import pytest
from mesh_files.cube_files import CUBE_FACES, as_input, cube, obj, objects
from meshes.surfaces import geodesic


def test_info_of_a_mesh(here, obbtree):
    document = obbtree("info", "cube.stl", "--json").json

    assert list(document) == ["schema", "tool_version", "inputs", "result", "stats"]
    assert document["schema"] == "obbtree/info/1"
    assert document["inputs"]["file"] == as_input(here / "cube.stl")
    assert document["result"] == {
        "kind": "mesh",
        "triangle_count": 12,
        "vertex_count": 36,
        "bounds": [[0, 0, 0], [1, 1, 1]],
        "size": math.sqrt(3),
        "surface_centroid": [0.5, 0.5, 0.5],
        "is_watertight": True,
        "self_overlap": {
            "overlaps_itself": False,
            "volume": [pytest.approx(1.0, abs=1e-12)] * 2,
            "excess": [0, pytest.approx(0.0, abs=1e-11)],
            "reason": None,
        },
        "degenerate_count": 0,
        "duplicate_count": 0,
        "accuracy": {
            "digits": "float32",
            "spacing": 2.0**-23,
            "shortest_edge": 1.0,
            "smallest_altitude": pytest.approx(math.sqrt(0.5)),
            "largest_aspect": pytest.approx(2.0),
            "sliver_count": 0,
            "extents_ratio": 1.0,
            "warnings": [],
        },
        "tree": None,
        "check": None,
    }


def test_info_counts_what_is_odd(here, obbtree):
    lines = obj(cube()).splitlines()
    # The first face goes, the second comes twice, and one has two corners at one place.
    faces = [line for line in lines if line.startswith("f")]
    odd = [line for line in lines if line != faces[0]] + [faces[1], "f 1 1 2"]
    (here / "odd.obj").write_text("\n".join(odd) + "\n")

    result = obbtree("info", "odd.obj", "--json").json["result"]

    assert result["triangle_count"] == len(CUBE_FACES) + 1
    assert result["is_watertight"] is False
    assert result["duplicate_count"] == 1
    assert result["degenerate_count"] == 1


def test_info_warns_of_digits_slivers_and_extents(here, obbtree):
    def warnings(*corners):
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in corners] + ["f 1 2 3"]
        (here / "thin.obj").write_text("\n".join(lines) + "\n")
        document = obbtree("info", "thin.obj", "--json").json
        found = document["result"]["accuracy"]["warnings"]
        assert obbtree("info", "thin.obj").out.count("\nwarning") == len(found)
        return found

    assert not warnings((0, 0, 0), (1, 0, 0), (0, 1, 1))
    # Ten steps of float32 at 2^20, which are 2^-3 each.
    (grid,) = warnings((2**20, 0, 0), (2**20, 1.25, 0), (2**20 + 1.25, 0, 1.25))
    assert "grid of 0.12 (float32)" in grid
    assert " steps of it" in grid
    (sliver,) = warnings((0, 0, 0), (1.1, 0, 0), (0.5, 2**-11, 0))
    assert sliver.startswith("slivers: 1, up to 2.25e+03 times")
    # As far as doubles reach there are digits enough, but hardly a height.
    assert len(warnings((0, 0, 0), (1.1, 0, 0), (0, 1, 1e-7))) == 1
    flat = ["degenerate triangles: 1, which have no normal"]
    assert warnings((0, 0, 0), (1.1, 0, 0), (0.3, 0, 0)) == flat
    # On the line (1, 3, 5) exactly; rounded differences make an area of it, which is no sliver.
    line = (0.03372333922048387, 0.6369616873214543, 0.0012804226230060944)
    assert warnings(*((x, 3 * x, 5 * x) for x in line)) == flat


def test_info_of_a_tree(here, obbtree):
    obbtree("build", "cube.stl", "--leaf-size", 2)

    result = obbtree("info", "cube.obbt", "--json").json["result"]

    tree = result["tree"]
    assert result["kind"] == "tree"
    assert result["is_watertight"] is True
    assert (tree["fit"], tree["split"], tree["leaf_size"]) == ("triangles", "compact", 2)
    assert tree["source"] == "cube.stl"
    assert tree["source_sha256"] == hashlib.sha256((here / "cube.stl").read_bytes()).hexdigest()
    assert tree["source_state"] == "unchanged"
    assert sum(level["box_count"] for level in tree["levels"]) == tree["node_count"]
    assert tree["levels"][0]["box_count"] == 1
    # Some box holds the cube, and none that is fitted to it is much larger.
    assert 1 <= tree["levels"][0]["volume"] < 3 * math.sqrt(3)
    assert tree["bytes_per_triangle"] == tree["nbytes"] / 12


def test_info_of_a_mesh_and_of_its_tree_agree(here, obbtree):
    obbtree("build", "touching.obj")
    of_mesh = obbtree("info", "touching.obj", "--json").json["result"]
    of_tree = obbtree("info", "touching.obbt", "--json").json["result"]

    for result in (of_mesh, of_tree):
        for key in ("kind", "tree"):
            del result[key]
    assert json.dumps(of_mesh) == json.dumps(of_tree)


@pytest.mark.parametrize(
    ("change", "state", "shown"),
    [
        (lambda path: path.write_bytes(path.read_bytes() + b" "), "changed", "CHANGED since"),
        (lambda path: path.unlink(), "not found", "not found beside the tree"),
        (lambda _: None, "unchanged", "unchanged since"),
    ],
)
def test_info_says_what_became_of_the_source(here, obbtree, change, state, shown):
    obbtree("build", "touching.obj")
    change(here / "touching.obj")

    assert shown in obbtree("info", "touching.obbt").out
    document = obbtree("info", "touching.obbt", "--json").json
    assert document["result"]["tree"]["source_state"] == state


@pytest.mark.parametrize("name", ["cube.stl", "cube.obbt"])
def test_info_check_passes_on_what_is_sound(here, obbtree, name):
    obbtree("build", "cube.stl")

    assert obbtree("info", name, "--check", "--json").json["result"]["check"] == "passed"
    assert (
        "passed: every triangle lies in all boxes above it" in obbtree("info", name, "--check").out
    )


def test_info_check_finds_every_flipped_byte(here, obbtree):
    obbtree("build", "cube.stl")
    data = (here / "cube.obbt").read_bytes()

    for position in range(len(data)):
        flipped = bytearray(data)
        flipped[position] ^= 0x40
        (here / "flipped.obbt").write_bytes(flipped)
        ended = obbtree("info", "flipped.obbt", "--check", "--no-verify")
        assert ended.code == 3, position
        assert ended.out == ""
        assert ended.err.startswith("error: flipped.obbt")


def test_info_of_sizes_beyond_a_double_has_no_infinity(here, obbtree):
    (here / "vast.obj").write_text("v -1.7e308 0 0\nv 1.7e308 1 0\nv 0 1.7e308 0\nf 1 2 3\n")

    ended = obbtree("info", "vast.obj", "--json")

    assert ended.json["result"]["size"] is None
    assert "beyond the largest double" in obbtree("info", "vast.obj").out


def test_info_table_shows_names_as_they_are(here, obbtree):
    name = "[red]gér:smile:.obj"
    (here / name).write_text(obj(cube()))

    assert f"{name} (mesh)" in obbtree("info", name).out


def test_info_never_replaces_what_it_reads(here, obbtree):
    before = (here / "cube.stl").read_bytes()

    ended = obbtree("info", "cube.stl", "-o", "cube.stl")

    assert ended.code == 2
    assert (here / "cube.stl").read_bytes() == before


def test_info_tells_the_volume_and_that_nothing_overlaps(here, obbtree):
    part = obbtree("info", "cube.stl", "--json").json["result"]["self_overlap"]

    assert part["overlaps_itself"] is False
    assert part["reason"] is None
    assert part["volume"][0] <= 1 <= part["volume"][1] <= 1 + 1e-12
    assert 0 == part["excess"][0] <= part["excess"][1] < 1e-11
    assert "none with itself" in obbtree("info", "cube.stl").out


def test_info_tells_that_a_mesh_overlaps_itself(here, obbtree):
    # Two unit cubes that share half of each: the volume counts that half twice.
    (here / "doubled.obj").write_text(objects(left=0.0, right=0.5))

    part = obbtree("info", "doubled.obj", "--json").json["result"]["self_overlap"]

    assert part["overlaps_itself"] is True
    assert part["volume"][0] <= 2 <= part["volume"][1]
    assert part["excess"][0] <= 1 <= part["excess"][1] <= 1 + 1e-9
    assert "WITH ITSELF: up to 0.25 of its volume" in obbtree("info", "doubled.obj").out


def test_info_of_an_open_mesh_has_no_volume(here, obbtree):
    lines = (here / "apart.obj").read_text().splitlines()
    (here / "open.obj").write_text("\n".join(lines[:-1]) + "\n")

    part = obbtree("info", "open.obj", "--json").json["result"]["self_overlap"]

    nothing = dict.fromkeys(("overlaps_itself", "volume", "excess"))
    assert part == nothing | {"reason": "the surface does not close"}


def test_info_looks_at_a_large_mesh_only_where_asked(here, obbtree):
    vertices, faces = geodesic(20_480)
    rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    rows += [f"f {i + 1} {j + 1} {k + 1}" for i, j, k in faces.tolist()]
    (here / "ball.obj").write_text("\n".join(rows) + "\n")

    left, asked = (
        obbtree("info", "ball.obj", "--json", *words).json["result"]["self_overlap"]
        for words in ((), ("--overlaps-itself",))
    )

    assert left["volume"] is left["overlaps_itself"] is None
    assert "--overlaps-itself" in left["reason"]
    assert asked["overlaps_itself"] is False
    assert 4.18 < asked["volume"][0] <= asked["volume"][1] < 4 / 3 * math.pi


def test_info_of_parts_says_nothing_of_overlap(here, obbtree):
    ended = obbtree("info", "cube.stl", "--parts", "--overlaps-itself")

    assert ended.code == 2
    assert "--overlaps-itself" in ended.err
