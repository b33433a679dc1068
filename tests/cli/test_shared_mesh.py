"""`overlap --mesh` and `view --overlap`: what both share, by manifold3d, against what is proven."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from claims.png_files import pixels_of
from mesh_files.cube_files import cube, obj

needs_manifold = pytest.mark.needs("manifold3d")
CORNER = ("cube.stl", "cube.stl", "--translate-b", 0.5, 0.75, 0.875)
SMALL = ("--size", 160, 120)


@pytest.fixture
def without_package(monkeypatch):
    """Let manifold3d seem not to be installed."""
    monkeypatch.setattr("obbcli.view.shared_solid.find_spec", lambda _: None)


def opened(here):
    """Write a cube without its last triangle, and return its name."""
    text = obj(cube()).rstrip("\n").rpartition("\n")[0]
    (here / "opened.obj").write_text(text + "\n")
    return "opened.obj"


@needs_manifold
def test_mesh_of_what_both_share_is_written_and_held_against_the_proof(here, obbtree):
    ended = obbtree("overlap", *CORNER, "--mesh", "shared.glb", "--json")

    told = ended.json["result"]["mesh"]
    mesh = trimesh.load(here / "shared.glb", force="mesh")
    assert ended.code == 0
    assert told["file"] == "shared.glb"
    assert told["byte_count"] == (here / "shared.glb").stat().st_size
    assert told["triangle_count"] == len(mesh.faces) == 12
    assert told["is_proven"] is False
    assert told["volume"] == pytest.approx(0.5 * 0.25 * 0.125, rel=1e-12)
    assert told["off_by"] == 0
    assert np.allclose(mesh.bounds, [(0.5, 0.75, 0.875), (1, 1, 1)])
    assert mesh.volume == pytest.approx(told["volume"], rel=1e-6)


@needs_manifold
def test_table_says_that_the_mesh_is_not_proven(here, obbtree):
    ended = obbtree("overlap", *CORNER, "--mesh", "shared.glb")

    assert "12 triangles by manifold3d, not proven" in ended.out
    assert "0.015625, as proven" in ended.out


@needs_manifold
def test_volume_that_is_off_is_told(here, obbtree, monkeypatch):
    from obbcli.view import shared_solid

    whole = shared_solid.shared_solid
    monkeypatch.setattr(
        shared_solid, "shared_solid", lambda bodies: whole(bodies)._replace(volume=1.0)
    )

    ended = obbtree("overlap", *CORNER, "--mesh", "shared.glb")

    assert "off by 0.984375 beyond what is proven" in ended.out


@needs_manifold
def test_bodies_that_share_nothing_leave_no_file(here, obbtree):
    words = ("overlap", "cube.stl", "cube.stl", "--translate-b", 3, 0, 0, "--mesh", "shared.glb")

    assert obbtree(*words, "--json").json["result"]["mesh"]["file"] is None
    assert "none written" in obbtree(*words).out
    assert not (here / "shared.glb").exists()


@needs_manifold
def test_solid_turned_inward_shares_what_it_does_turned_outward(here, obbtree):
    lines = (here / "apart.obj").read_text().splitlines()
    turned = [
        " ".join(["f", *reversed(line.split()[1:])]) if line.startswith("f") else line
        for line in obj(cube()).splitlines()
    ]
    (here / "inward.obj").write_text("\n".join(turned) + "\n")
    assert lines

    told = obbtree(
        "overlap", "inward.obj", "cube.stl", *CORNER[2:], "--mesh", "shared.glb", "--json"
    ).json["result"]["mesh"]

    assert told["volume"] == pytest.approx(0.015625, rel=1e-12)
    assert told["off_by"] == 0


def test_without_the_package_there_is_one_error_with_its_remedy(here, obbtree, without_package):
    asked = obbtree("overlap", *CORNER, "--mesh", "shared.glb")
    drawn = obbtree("view", *CORNER, "--overlap", "-o", "shared.png")

    for ended in (asked, drawn):
        assert ended.code != 0
        assert ended.out == ""
        assert "manifold3d" in ended.err
        assert "pip install manifold3d" in ended.err
    assert not (here / "shared.png").exists()


@needs_manifold
@pytest.mark.parametrize(
    ("file", "found"),
    [("shared.stl", ".glb"), ("cube.stl", ".glb"), ("no/shared.glb", "folder")],
)
def test_file_that_cannot_be_written_is_refused_first(here, obbtree, file, found):
    ended = obbtree("overlap", *CORNER, "--mesh", file)

    assert ended.code != 0
    assert found in ended.err


@needs_manifold
@pytest.mark.parametrize(
    "words", [("overlap", "--mesh", "x.glb"), ("view", "--overlap", "-o", "x.png")]
)
def test_surface_that_does_not_close_has_no_shared_solid(here, obbtree, words):
    ended = obbtree(words[0], opened(here), "cube.stl", *words[1:])

    assert ended.code == 3
    assert "opened.obj" in ended.err
    assert not (here / words[-1]).exists()


@needs_manifold
def test_picture_shows_what_both_share_in_full(here, obbtree):
    ended = obbtree("view", *CORNER, "--overlap", *SMALL, "-o", "shared.png", "--json")

    document = ended.json
    drawn = document["result"].pop("drawn")
    asked = obbtree("overlap", *CORNER, "--json").json
    pixels = pixels_of((here / "shared.png").read_bytes()).astype(int)
    red = (pixels[..., 0] > 90) & (pixels[..., 1] < 80) & (pixels[..., 2] < 80)
    assert document["schema"] == "obbtree/view/1"
    assert document["result"] == asked["result"]
    assert drawn["what"] == "overlap"
    assert drawn["triangle_count"] == 12
    assert red.sum() > 20
    # Both bodies are faint: nothing else is as dark.
    assert np.median(pixels[~red].min(axis=-1)) > 150


@needs_manifold
@pytest.mark.parametrize("kind", ["html", "glb"])
def test_picture_of_other_formats_holds_both_and_what_they_share(here, obbtree, kind):
    obbtree("view", *CORNER, "--overlap", "-o", f"shared.{kind}")

    if kind == "glb":
        scene = trimesh.load(here / "shared.glb")
        assert set(scene.geometry) == {"A", "B", "overlap of A and B"}
        assert scene.geometry["A"].visual.material.baseColorFactor[3] < 128
        assert scene.geometry["overlap of A and B"].visual.material.baseColorFactor[3] == 255
    else:
        text = (here / "shared.html").read_text()
        assert "red: what both share, not proven" in text


@needs_manifold
def test_picture_of_bodies_that_share_nothing_says_so(here, obbtree):
    words = ("view", "cube.stl", "cube.stl", "--translate-b", 3, 0, 0, "--overlap", *SMALL)

    ended = obbtree(*words, "-o", "shared.png", "--exit-code")

    assert ended.code == 0
    assert "share no solid" in ended.out


@needs_manifold
@pytest.mark.parametrize(
    "words", [("--ghosts", 2), ("--level", 2), ("--solid",), ("--vel", 1, 0, 0)], ids=str
)
def test_options_without_meaning_are_refused(here, obbtree, words):
    ended = obbtree("view", *CORNER, "--overlap", *words, "-o", "shared.png")

    assert ended.code == 2
    assert str(words[0]) in ended.err


def test_overlap_of_one_body_is_refused(here, obbtree):
    ended = obbtree("view", "cube.stl", "--overlap", "-o", "shared.png")

    assert ended.code == 2
    assert "there is no B" in ended.err
