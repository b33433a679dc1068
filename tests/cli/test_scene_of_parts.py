"""Mesh files of every format with parts in place of scenes: all parts at rest, decoded if asked."""

from __future__ import annotations

import pytest
from mesh_files.part_files import DECODED_ALONE, PLACING, WRITERS

#: The arm meets the frame, and the lid neither.
PLACES = {"frame": (0.0, 0.0, 0.0), "arm": (0.5, 0.25, 0.0), "lid": (0.0, 0.0, 9.0)}


def written(folder, kind, **places):
    return WRITERS[kind](folder, list((places or PLACES).items())).name


@pytest.mark.parametrize("kind", list(WRITERS))
def test_mesh_file_is_a_scene_of_its_parts_at_rest(here, obbtree, kind):
    name = written(here, kind)

    answer = obbtree("scene", name, "--json").json

    assert [body["name"] for body in answer["bodies"]] == list(PLACES)
    assert answer["duration"] == 0
    assert [(c["body_a"], c["body_b"]) for c in answer["result"]["contacts"]] == [("frame", "arm")]
    assert answer["result"]["contacts"][0]["status"] == "overlap_at_start"
    meshes = 1 if kind in PLACING else 3
    assert answer["stats"]["meshes_possible"] == answer["stats"]["meshes_decoded"] == meshes
    assert answer["inputs"]["meshes"][0]["triangle_count"] == 36
    assert obbtree("scene", name, "--exit-code").code == 1
    assert obbtree("scene", f"{name}#[fl]*", "--exit-code").code == 0


@pytest.mark.parametrize("kind", list(WRITERS))
def test_explain_shows_what_of_the_parts_was_decoded(here, obbtree, kind):
    ended = obbtree("scene", written(here, kind), "--pairs", "frame,lid", "--explain")

    assert ended.code == 0
    decoded = "1 of 1" if kind in PLACING else "2 of 3"
    assert f"meshes decoded: {decoded}, which copies share" in ended.out


@pytest.mark.parametrize("kind", DECODED_ALONE)
def test_damaged_part_does_not_matter_where_others_are_asked_about(here, obbtree, kind):
    name = written(here, kind, frame=(0, 0, 0), arm=(0.5, 0.25, 0), bad=None)
    # Blocks of VTK are read when they are listed, as only their files tell whether they have faces.
    words = (f"{name}#[fa]*",) if kind == "VTK" else (name, "--pairs", "frame,arm")

    assert obbtree("scene", *words, "--exit-code").code == 1
    assert obbtree("scene", name).code == 3


@pytest.mark.parametrize("kind", list(WRITERS))
def test_info_lists_the_parts_of_every_format(here, obbtree, kind):
    result = obbtree("info", written(here, kind), "--parts", "--json").json["result"]

    assert [(part["path"], part["triangle_count"]) for part in result["parts"]] == [
        (name, 12) for name in PLACES
    ]
    for part, (x, y, z) in zip(result["parts"], PLACES.values(), strict=True):
        assert part["bounds"] == [[x, y, z], [x + 1, y + 1, z + 1]]
        assert part["is_watertight"]
        assert part["unit"] == {"glTF": "m", "COLLADA": "m", "3MF": "mm"}.get(kind)


@pytest.mark.parametrize("kind", list(WRITERS))
def test_parts_of_every_format_are_asked_about_by_name(here, obbtree, kind):
    name = written(here, kind)

    result = obbtree("collide", f"{name}#frame", f"{name}#[al]*", "--json").json["result"]

    assert (result["status"], result["part_a"], result["part_b"]) == (
        *("overlap_at_start", "frame"),
        "arm",
    )
    apart = obbtree("distance", f"{name}#arm", f"{name}#lid", "--json").json["result"]
    low, high = apart["bounds"]
    assert low <= 8 <= high < 8 + 1e-12
