"""STEP: closed forms within the sag, names, placements and units of the file, bit for bit."""

from __future__ import annotations

import gzip
import os
import subprocess
import sys

import numpy as np
import pytest
from mesh_files.step_files import CONVERTED, ORIGIN, UNITS, StepFile, box, sphere

from obbcli import ObbTree, load_mesh, load_parts
from obbcli.mesh import load_mesh_bytes

pytestmark = pytest.mark.needs("cadquery-ocp-novtk")

QUARTER = ((1, 2, 3), (0, 0, 1), (0, 1, 0))
#: Barycentric weights of points all over a triangle.
WEIGHTS = np.random.default_rng(7).dirichlet((1, 1, 1), 40)


def load(data, **more):
    return load_mesh_bytes(data, ".step", **more)


def written(tmp_path, data, name="a.step"):
    path = tmp_path / name
    path.write_bytes(data)
    return path


def assembly():
    """Return an assembly of two boxes and a ball, with a box inside an assembly inside it."""
    file = StepFile("in")
    bolt = file.product("bolt", [file.solid(file.faces_of_box((0, 0, 0), (0.1, 0.2, 0.3)))])
    ball = file.product("ball", [file.solid([file.face_of_sphere(0.5)])])
    pair = file.assembly(
        "pair", ("left", bolt, ((0.1, 0.7, 0.3), *ORIGIN[1:])), ("", bolt, QUARTER)
    )
    file.assembly("top", ("a", pair, ORIGIN), ("x", ball, ((5, 5, 5), *ORIGIN[1:])),
                  ("a", pair, ((10, 0, 0), (0, 0, 1), (0, -1, 0))))  # fmt: skip
    return file.bytes()


def points_of(mesh):
    return np.einsum("wk,fkd->fwd", WEIGHTS, mesh.vertices[mesh.triangles]).reshape(-1, 3)


def test_a_box_is_its_corners_bit_for_bit():
    found = load(box((0.1, 0.2, 0.3), (1.7, 2.9, 3.1)))

    assert found.bounds.tolist() == [[0.1, 0.2, 0.3], [1.7, 2.9, 3.1]]
    assert (len(found.vertices), len(found.triangles)) == (8, 12)
    assert found.is_watertight
    corners = found.vertices[found.triangles]
    volume = np.einsum("fd,fd->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert volume == pytest.approx(1.6 * 2.7 * 2.8, rel=1e-14)
    assert found.unit == "mm"


@pytest.mark.parametrize("sag", [None, 3.0, 0.3, 0.05, 0.01])
def test_a_sphere_is_within_the_sag(sag):
    found = load(sphere(10.0, (100, 0, -50)), sag=sag)
    away = found.vertices - [100, 0, -50]

    assert np.abs(np.linalg.norm(away, axis=1) - 10).max() < 1e-12
    inside = 10 - np.linalg.norm(points_of(found) - [100, 0, -50], axis=1)
    assert inside.min() > -1e-12
    assert 0 < inside.max() <= found.sag
    assert found.sag == (0.034 if sag is None else sag)
    assert found.is_watertight
    assert found.notes[-1].endswith(f"within {found.sag!r} mm of them (the sag)")


def test_the_default_sag_is_a_thousandth_of_the_size_rounded_down():
    found = load(sphere(10.0))

    assert 0.9e-3 * found.size <= found.sag <= 1e-3 * found.size


def test_a_finer_sag_makes_more_triangles():
    counts = [len(load(sphere(), sag=sag).triangles) for sag in (0.5, 0.1, 0.02)]

    assert counts == sorted(set(counts))


@pytest.mark.parametrize("unit", [*UNITS, "in", "ft"])
def test_coordinates_are_in_the_unit_of_the_file(unit):
    found = load(box((0, 0, 0), (0.1, 0.2, 0.3), unit))

    assert found.bounds.tolist() == [[0, 0, 0], [0.1, 0.2, 0.3]]
    assert found.unit == unit


def test_a_unit_of_no_name_is_turned_into_mm():
    found = load(box((0, 0, 0), (1, 2, 3), "fathom"))

    assert found.unit == "mm"
    assert found.bounds[1] == pytest.approx(np.array([1, 2, 3]) * 1828.8, rel=1e-12)
    assert "states a unit of 1828.8 mm: its coordinates are turned into mm" in found.notes
    assert CONVERTED["fathom"] == (1.8288, "m")


def test_a_file_without_a_unit_states_none():
    found = load(box(unit=None))

    assert found.unit is None
    assert found.bounds.tolist() == [[0, 0, 0], [1, 2, 3]]


def test_products_in_other_units_are_brought_to_the_first_with_a_note(tmp_path):
    file = StepFile("mm")
    inches = file.lengths("in")
    file.product("one", [file.solid(file.faces_of_box((0, 0, 0), (1, 1, 1)))])
    file.product("two", [file.solid(file.faces_of_box((0, 0, 0), (1, 1, 1)))], context=inches)
    one, two = load_parts(written(tmp_path, file.bytes()))

    assert one.mesh.bounds[1].tolist() == [1, 1, 1]
    assert two.mesh.bounds[1] == pytest.approx([25.4] * 3, rel=1e-12)
    assert "coordinates in in are turned into mm" in two.mesh.notes


def test_parts_are_instances_with_their_names_and_places(tmp_path):
    found = load_parts(written(tmp_path, assembly()))

    paths = ["top/a/left", "top/a/bolt", "top/x", "top/a#2/left", "top/a#2/bolt"]
    assert [part.path for part in found] == paths
    assert {part.unit for part in found} == {"in"}
    left, turned, ball, moved, both = found
    assert left.pose.translation.tolist() == [0.1, 0.7, 0.3]
    assert left.pose.rotation.tolist() == np.eye(3).tolist()
    assert turned.pose.rotation.tolist() == [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    assert turned.pose.translation.tolist() == [1, 2, 3]
    assert ball.pose.translation.tolist() == [5, 5, 5]
    assert moved.pose.translation.tolist() == [0.7 + 10, -0.1, 0.3]
    assert both.pose.rotation.tolist() == np.eye(3).tolist()
    assert both.pose.translation.tolist() == [12, -1, 3]


def test_instances_share_a_mesh_and_are_what_the_whole_file_is(tmp_path):
    path = written(tmp_path, assembly())
    parts = load_parts(path)
    whole = load_mesh(path)

    assert len({id(part.mesh) for part in parts}) == 2
    assert np.vstack([part.vertices() for part in parts]).tobytes() == whole.vertices.tobytes()
    assert sum(len(part.mesh.triangles) for part in parts) == len(whole.triangles)
    some = load_mesh(f"{path}#top/a#2")
    assert [rows.path for rows in some.parts] == ["top/a#2/left", "top/a#2/bolt"]
    assert some.vertices.tobytes() == whole.vertices[-16:].tobytes()
    assert some.sag == 0.00037
    assert whole.sag == parts["top/x"].mesh.sag == 0.0017
    assert parts["top/a/left"].mesh.sag == 0.00037


def test_equal_products_are_numbered_and_names_of_any_letters_kept(tmp_path):
    file = StepFile()
    for name in ("ball", "ball", r"\X2\00DC\X0\ber", "a#b [1]*"):
        file.product(name, [file.solid([file.face_of_sphere(1.0)])])
    found = load_parts(written(tmp_path, file.bytes()))

    assert [part.path for part in found] == ["ball", "ball#2", "Über", "a#b [1]*"]


def test_several_solids_of_a_product_are_one_part_and_sheets_are_surfaces():
    file = StepFile()
    faces = file.faces_of_box((0, 0, 0), (1, 1, 1))
    inner = file.solid(file.faces_of_box((2, 2, 2), (3, 3, 3)))
    file.product("two", [file.solid(faces), inner])
    open_faces = file.faces_of_box((5, 5, 5), (6, 6, 6))[:4]
    sheet = file.sheet(open_faces)
    file.product("open", [sheet], "MANIFOLD_SURFACE_SHAPE_REPRESENTATION")
    found = load(file.bytes())

    assert len(found.triangles) == 12 + 12 + 8
    assert not found.is_watertight
    assert not any("close" in note for note in found.notes)


def test_points_and_empty_products_are_passed_over(tmp_path):
    file = StepFile()
    file.product("nothing", [file.point((9, 9, 9))], "SHAPE_REPRESENTATION")
    file.product("ball", [file.solid([file.face_of_sphere(1.0)])])

    assert [part.path for part in load_parts(written(tmp_path, file.bytes()))] == ["ball"]


def test_units_scale_the_sag_and_trees_keep_it(tmp_path):
    path = written(tmp_path, sphere(1.0))
    mesh = load_mesh(path, sag=0.02)
    tree = ObbTree.build(mesh.in_unit("um"))
    tree.save(tmp_path / "a.obbt")

    assert mesh.in_unit("um").sag == 0.02 * 1000
    assert mesh.scaled(2.0).sag == 0.04
    assert mesh.welded(1e-9).sag == 0.02
    assert ObbTree.open(tmp_path / "a.obbt").sag == tree.sag == 0.02 * 1000
    assert ObbTree.open(tmp_path / "a.obbt").mesh.sag == 0.02 * 1000


@pytest.mark.parametrize("name", ["a.step.gz", "a.stp.gz", "a.stpz"])
def test_packed_files_are_read(tmp_path, name):
    found = load_mesh(written(tmp_path, gzip.compress(box()), name))

    assert len(found.triangles) == 12
    assert not any("gzip" in note for note in found.notes)


def test_content_counts_before_the_suffix():
    assert load_mesh_bytes(box(), ".stl").notes[0] == (
        "is a STEP file by its content, and is read as such"
    )
    assert load_mesh_bytes(box()).unit == "mm"


def test_the_same_file_gives_the_same_bits():
    first, second = load(assembly()), load(assembly())

    assert first.vertices.tobytes() == second.vertices.tobytes()
    assert first.triangles.tobytes() == second.triangles.tobytes()


def test_a_fork_cuts_with_a_worker_of_its_own(tmp_path):
    parts = load_parts(written(tmp_path, assembly()))
    child = os.fork()
    if child == 0:
        os._exit(len(parts["top/x"].mesh.triangles) % 251)
    _, status = os.waitpid(child, 0)

    assert os.waitstatus_to_exitcode(status) == len(parts["top/x"].mesh.triangles) % 251


def test_the_library_says_nothing_and_leaves_no_process(tmp_path):
    bad = box().replace(b"EDGE_LOOP", b"EDGE_LOOB", 1)
    code = (
        "import sys, obbcli\n"
        "try: obbcli.load_mesh(sys.argv[1])\n"
        "except obbcli.MeshError as fault: print('refused')\n"
        "else: print('read')\n"
    )
    for data, word in ((box(), "read"), (bad, "refused")):
        words = [sys.executable, "-W", "error", "-c", code, written(tmp_path, data)]
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        assert (done.stdout, done.stderr) == (f"{word}\n", "")
