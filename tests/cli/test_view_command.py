"""`obbtree view`: documents, exit codes, files, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from claims.png_files import pixels_of

from obbcli import ObbTree

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
LINKS = SAMPLES / "chain_link_a.off", SAMPLES / "chain_link_b.ply"
SMALL = ("--size", 160, 120)
KEYS = ["schema", "tool_version", "inputs", "motion", "accuracy", "solid", "result", "stats"]


def pixels(path):
    """Return the pixels of a PNG file, 0 to 255."""
    return pixels_of(Path(path).read_bytes())


def test_contact_document_has_the_answer_and_what_was_drawn(here, obbtree):
    words = (*LINKS, "--vel-b", 1, 0, 0, "--duration", 5)

    ended = obbtree("view", *words, *SMALL, "--ghosts", 1, "-o", "contact.png", "--json")

    document, result = ended.json, dict(ended.json["result"])
    assert (ended.code, ended.err) == (0, "")
    assert list(document) == KEYS
    assert document["schema"] == "obbtree/view/1"
    assert result.pop("drawn") == {
        "file": "contact.png",
        "format": "png",
        "byte_count": (here / "contact.png").stat().st_size,
        "size": [160, 120],
        "what": "contact",
        "time": 2.0,
        "ghost_times": [0.0, 1.0],
        "ghosts_of": ["b"],
        "marks": ["point", "normal", "triangle_a", "triangle_b"],
    }
    asked = obbtree("first-contact", *words, "--json").json
    assert result == asked["result"]
    for part in ("inputs", "motion", "accuracy"):
        assert document[part] == asked[part]


def test_tree_document_counts_boxes(here, obbtree):
    ended = obbtree("view", LINKS[0], "--level", 5, *SMALL, "-o", "boxes.png", "--json")

    document, drawn = ended.json, ended.json["result"]["drawn"]
    levels = ObbTree.build(LINKS[0]).levels
    assert list(document) == ["schema", "tool_version", "inputs", "result", "stats"]
    assert document["inputs"]["a"]["triangle_count"] == 1216
    assert (drawn["what"], drawn["level"], drawn["node"]) == ("boxes", 5, None)
    assert drawn["box_count"] == levels[5].box_count == len(drawn["nodes"])
    assert drawn["depths"] == [{"depth": 5, "box_count": levels[5].box_count}]


def test_boxes_under_a_node_are_drawn(here, obbtree):
    ended = obbtree("view", LINKS[0], "--node", 0, *SMALL, "-o", "boxes.png", "--json")

    drawn = ended.json["result"]["drawn"]
    assert (drawn["level"], drawn["node"]) == (None, 0)
    assert len(drawn["depths"]) > 1
    assert sum(depth["box_count"] for depth in drawn["depths"]) == drawn["box_count"]


def test_level_is_3_where_none_is_given(here, obbtree):
    ended = obbtree("view", LINKS[0], *SMALL, "-o", "boxes.png")

    lines = [line.split() for line in ended.out.splitlines()]
    assert ["levels", "8", "at", "3"] in lines
    assert ["picture", "boxes.png", "(160", "x", "120", "pixels)"] in lines


def test_last_level_is_drawn_of_a_tree_that_does_not_go_to_3(here, obbtree):
    corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    (here / "tetra.obj").write_text(corners + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")

    ended = obbtree("view", "tetra.obj", *SMALL, "-o", "boxes.png", "--json")

    drawn = ended.json["result"]["drawn"]
    assert (ended.code, drawn["depths"]) == (0, [{"depth": drawn["level"], "box_count": 1}])
    assert 0 < drawn["level"] < 3


def test_tables_say_what_was_drawn(here, obbtree):
    ended = obbtree("view", *LINKS, "--vel-b", 1, 0, 0, "--duration", 5, *SMALL, "-o", "c.png")

    rows = dict(line.split(maxsplit=1) for line in ended.out.splitlines() if line)
    assert rows["status"] == "contact"
    assert rows["drawn"] == "A and B at t = 2.0 s"
    assert rows["faintly"] == "B at t = 0 and 3 times on the way"
    assert rows["marked"] == "point, normal, triangle a, triangle b"


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("--vel-b", 1, 0, 0, "--duration", 5), "contact 2.0\n"),
        (("--vel-b", 1, 0, 0), "separated\n"),
        (("--translate-b", 3, 0, 0), "overlap_at_start 0.0\n"),
    ],
)
def test_bare_answer_is_that_of_first_contact(here, obbtree, words, expected):
    assert obbtree("view", *LINKS, *words, *SMALL, "-o", "c.png", "--quiet").out == expected


def test_bare_answer_of_a_tree_counts_boxes(here, obbtree):
    assert obbtree("view", "cube.stl", "--level", 1, *SMALL, "-o", "c.png", "-q").out == "2\n"


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("--exit-code", "--vel-b", 1, 0, 0, "--duration", 5), 1),
        (("--exit-code",), 0),
        (("--exit-code", "--vel-b", 1, 0, 0, "--method", "sampled", "--steps", 2), 4),
        (("--vel-b", 1, 0, 0, "--omega", 0, 1, 0, "--max-iterations", 1), 4),
    ],
)
def test_exit_code_is_that_of_first_contact(here, obbtree, words, code):
    assert obbtree("view", *LINKS, *words, *SMALL, "-o", "c.png").code == code
    assert (here / "c.png").is_file()


def test_picture_shows_both_bodies_and_the_marks(here, obbtree):
    # Large enough for the dot at the contact to have pixels of one colour.
    words = (*LINKS, "--vel-b", 1, 0, 0, "--duration", 5, "--size", 320, 240)
    assert obbtree("view", *words, "-o", "contact.png").code == 0

    red, green, blue = pixels("contact.png").reshape(-1, 3).T

    assert np.count_nonzero((blue > red + 50) & (blue > green + 20)) > 800
    assert np.count_nonzero((red > blue + 60) & (red > green + 20)) > 800
    assert np.count_nonzero((red > 130) & (green < 60)) > 5
    assert np.count_nonzero((red == 255) & (green == 255) & (blue == 255)) > 5000


def test_direction_and_zoom_change_the_picture(here, obbtree):
    def picture(*words):
        assert obbtree("view", *LINKS, *words, *SMALL, "-o", "c.png", "--force").code == 0
        return pixels("c.png")

    one = picture()
    assert (picture("--from", 0, 0, 5) != one).any()
    assert (picture("--zoom", 3) != one).any()
    assert (picture("--ghosts", 0) == one).all()


def test_glb_and_html_hold_the_bodies(here, obbtree):
    words = (*LINKS, "--vel-b", 1, 0, 0, "--duration", 5)

    assert obbtree("view", *words, "-o", "c.glb").code == 0
    assert obbtree("view", *words, "-o", "c.html", "--from", 1, 0, 0).code == 0

    scene = trimesh.load(here / "c.glb", process=False)
    assert {"A at t = 2 s", "B at t = 2 s", "B at t = 0 s", "contact point"} <= set(scene.geometry)
    assert "orange: B, chain_link_b.ply" in (here / "c.html").read_text(encoding="utf-8")


def test_tree_file_is_drawn_as_its_mesh_is(here, obbtree):
    obbtree("build", "cube.stl", "--quiet")
    for name in ("cube.stl", "cube.obbt"):
        assert obbtree("view", name, "--level", 2, *SMALL, "-o", f"{name}.png").code == 0

    assert (pixels("cube.stl.png") == pixels("cube.obbt.png")).all()


def test_picture_that_exists_is_replaced_by_force_alone(here, obbtree):
    (here / "c.png").write_text("precious")

    refused = obbtree("view", "cube.stl", "-o", "c.png", *SMALL)
    kept = (here / "c.png").read_text()
    forced = obbtree("view", "cube.stl", "-o", "c.png", *SMALL, "--force")

    assert (refused.code, kept) == (5, "precious")
    assert refused.err == "error: c.png: exists already; add --force to replace it\n"
    assert forced.code == 0
    assert pixels("c.png").shape == (120, 160, 3)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("cube.stl",), "-o: is needed: a picture is a .glb, .html or .png file; add -o FILE"),
        (("cube.stl", "-o", "c.jpg"), "-o c.jpg: is no .glb, .html or .png file; name one that is"),
        (("cube.stl", "-o", "-"), "this goes to a file, not to standard output"),
        (("cube.stl", "-o", "c.glb", *SMALL), "--size: has no meaning for a .glb file"),
        (("cube.stl", "-o", "c.html", "--zoom", 2), "--zoom: has no meaning for a .html file"),
        (("cube.stl", "-o", "c.glb", "--from", 1, 0, 0), "--from: has no meaning for a .glb file"),
        (("cube.stl", "-o", "c.png", "--from", 0, 0, 0), "--from: is no direction"),
        (
            ("cube.stl", "-o", "c.png", "--size", 9000, 9),
            "'9' is not a whole number of at least 16",
        ),
        (("cube.stl", "-o", "c.png", "--size", 9000, 99), "--size: is beyond 8192 pixels"),
        (("cube.stl", "-o", "c.png", "--zoom", 2e6), "--zoom: is beyond 1,000,000; take less"),
        (("cube.stl", "-o", "c.png", "--vel", 1, 0, 0), "--vel: is about two bodies, and there is"),
        (("cube.stl", "-o", "c.png", "--solid"), "--solid: is about two bodies, and there is no B"),
        (("cube.stl", "-o", "c.png", "--ghosts", 2), "--ghosts: is about two bodies"),
        (("cube.stl", "-o", "c.png", "--timeout", 2), "--timeout: is about two bodies"),
        (
            ("cube.stl", "-o", "c.png", "--level", 1, "--node", 1),
            "--node: cannot be drawn together",
        ),
        (("cube.stl", "apart.obj", "-o", "c.png", "--level", 1), "--level: is about the boxes of"),
        (("cube.stl", "apart.obj", "-o", "c.png", "--ghosts", 101), "--ghosts: is beyond 100"),
        (("cube.stl", "apart.obj", "-o", "c.png", "--pivot", 1, 0, 0), "--pivot: is where an axis"),
    ],
)
def test_what_cannot_be_drawn_is_a_usage_error(here, obbtree, words, message):
    before = sorted(here.iterdir())

    ended = obbtree("view", *words)

    assert ended.code == 2
    assert message in ended.err
    assert ended.out == ""
    assert sorted(here.iterdir()) == before


def test_input_is_not_painted_over(here, obbtree):
    (here / "cube.png").write_bytes((here / "cube.stl").read_bytes())

    ended = obbtree("view", "cube.stl", "cube.png", "-o", "cube.png", "--force")

    assert ended.code == 2
    assert "is the input cube.png, which would be lost" in ended.err


def test_missing_folder_and_missing_level_are_told(here, obbtree):
    lost = obbtree("view", "cube.stl", "-o", "nowhere/c.png")
    deep = obbtree("view", "cube.stl", "--level", 40, "-o", "c.png")

    assert (lost.code, deep.code) == (5, 3)
    assert "nowhere/c.png: cannot be written: its folder is not there" in lost.err
    assert deep.err.startswith("error: level 40: the tree does not go there: its last level is ")
    assert not (here / "c.png").exists()


def test_file_that_format_cannot_hold_leaves_nothing(here, obbtree):
    far = "1e45"

    ended = obbtree("view", "cube.stl", "apart.obj", "--translate", far, 0, 0, "-o", "c.glb")

    assert ended.code == 3
    assert ended.err.startswith("error: c.glb: holds numbers as float32")
    assert not (here / "c.glb").exists()
