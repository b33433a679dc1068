"""The laws of parts, for every format that knows them: names, places, order, what is decoded."""

from __future__ import annotations

import numpy as np
import pytest
from claims.parts import corners, require_whole
from mesh_files.cube_files import CUBE_FACES, cube
from mesh_files.part_files import DECODED_ALONE, PLACING, WRITERS

from obbcli import MeshError, load_mesh, load_parts
from obbcli.mesh.formats import FORMATS

NAMES = ["arm", "arm", "a/b", "x#*[", "arm#2", "c\\d", "e f"]
PATHS = ["arm", "arm#2", "a/b", "x#*[", "arm#2#2", "c\\d", "e f"]
PLACES = [(0.0, 0.0, 0.0), (0.25, 0.5, 4.0), (-3.0, 0.1, 0.3), (0.7, 1e3, 0.0)]


@pytest.fixture(params=list(WRITERS))
def kind(request):
    return request.param


def write(folder, kind, names, places=None):
    found = [PLACES[k % len(PLACES)] for k in range(len(names))] if places is None else places
    return WRITERS[kind](folder, list(zip(names, found, strict=True)))


def expected(place):
    # As every format rounds: one sum a coordinate.
    return (np.array(cube()) + np.array(place))[np.array(CUBE_FACES)]


def test_every_format_with_parts_is_here():
    with_parts = {form.name for form in FORMATS.values() if form.parts}

    # Products of STEP are no triangles, and superelements of Nastran have numbers for names: they
    # have tests of their own.
    others = {"STEP", "Nastran"}
    assert {name.partition(",")[0] for name in with_parts} - others == set(WRITERS)


def test_paths_are_the_names_in_order_and_equal_ones_are_numbered(tmp_path, kind):
    path = write(tmp_path, kind, NAMES)

    assert [part.path for part in load_parts(path)] == PATHS


def test_parts_without_names_are_numbered(tmp_path, kind):
    path = write(tmp_path, kind, ["", "a", ""])

    # A block of VTK without a name has its number, a node of COLLADA the name of its geometry.
    own = {"VTK": ["0", "a", "2"], "COLLADA": ["g shape", "a", "g shape#2"]}
    assert [part.path for part in load_parts(path)] == own.get(kind, ["", "a", "#2"])


@pytest.mark.parametrize(
    ("pattern", "taken"),
    [
        ("arm", [0]),
        ("arm*", [0, 1, 4]),
        ("arm#2", [1]),
        ("a", [2]),
        ("a/b", [2]),
        ("*/b", [2]),
        ("b", None),
        ("**/b", [2]),
        (r"x#\*\[", [3]),
        (r"x\*", None),
        (r"c\\d", [5]),
        ("c?d", [5]),
        ("[!a]*", [3, 5, 6]),
        ("**", [0, 1, 2, 3, 4, 5, 6]),
        ("e f", [6]),
    ],
)
def test_patterns_take_parts_where_they_stand(tmp_path, kind, pattern, taken):
    path = write(tmp_path, kind, NAMES)

    if taken is None:
        with pytest.raises(MeshError, match="matches none of 7 parts"):
            load_mesh(f"{path}#{pattern}")
        return
    mesh = load_mesh(f"{path}#{pattern}")
    wanted = np.concatenate([expected(PLACES[k % len(PLACES)]) for k in taken])
    assert corners(mesh).tobytes() == wanted.tobytes()
    assert [tuple(rows) for rows in mesh.parts] == [
        (PATHS[k], 12 * number, 12) for number, k in enumerate(taken)
    ]
    assert [part.path for part in load_parts(f"{path}#{pattern}")] == [PATHS[k] for k in taken]


def test_whole_file_is_the_join_of_its_parts_bit_for_bit(tmp_path, kind):
    require_whole(write(tmp_path, kind, NAMES))


def test_placed_copies_share_a_mesh(tmp_path, kind):
    parts = load_parts(write(tmp_path, kind, NAMES)).parts

    shapes = {id(part.mesh) for part in parts}
    assert len(shapes) == (1 if kind in PLACING else len(NAMES))
    if kind in PLACING:
        assert parts[0].mesh.vertices.tolist() == [list(corner) for corner in cube()]
        assert parts[1].pose.translation.tolist() == list(PLACES[1])


def test_file_whose_own_name_holds_the_sign_wins(tmp_path, kind):
    path = write(tmp_path, kind, ["a", "b"])
    other = path.with_name(f"{path.stem}#a{path.suffix}")
    other.write_bytes(path.read_bytes())

    assert len(load_mesh(other).triangles) == 24
    assert len(load_mesh(f"{other}#a").triangles) == 12


def test_damaged_part_beside_those_that_are_asked_about(tmp_path, kind):
    path = write(tmp_path, kind, ["good", "bad", "also good"], [PLACES[0], None, PLACES[1]])

    with pytest.raises(MeshError) as whole:
        load_mesh(path)
    if kind not in DECODED_ALONE:
        with pytest.raises(MeshError) as one:
            load_mesh(f"{path}#good")
        assert str(one.value) == str(whole.value)
        return
    good = load_mesh(f"{path}#*good")
    assert corners(good).tobytes() == b"".join(expected(p).tobytes() for p in PLACES[:2])
    with pytest.raises(MeshError) as bad:
        load_mesh(f"{path}#bad")
    assert str(bad.value) == str(whole.value)


# Blocks of VTK are read when they are listed: only the file of each tells whether it has surface.
@pytest.mark.parametrize("kind", [name for name in DECODED_ALONE if name != "VTK"])
def test_parts_are_decoded_when_they_are_asked_for(tmp_path, kind):
    path = write(tmp_path, kind, ["good", "bad"], [PLACES[0], None])

    good, bad = load_parts(path)

    assert (good.is_decoded, bad.is_decoded) == (False, False)
    assert len(good.mesh.triangles) == 12
    assert (good.is_decoded, bad.is_decoded) == (True, False)
    with pytest.raises(MeshError):
        _ = bad.mesh
