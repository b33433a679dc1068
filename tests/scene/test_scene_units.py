"""Units of scenes: of the whole and of bodies, what is scaled and what is refused."""

from __future__ import annotations

import pytest
from mesh_files.cube_files import cube, obj, stl
from mesh_files.gltf_files import DOCUMENT, glb

import obbcli
from obbcli import MeshError, Scene, SceneError


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "cube.stl").write_bytes(stl(cube()))
    (tmp_path / "far.obj").write_text(obj(cube((5, 0, 0))))
    (tmp_path / "square.glb").write_bytes(glb(DOCUMENT))
    return tmp_path


def scene(folder, *bodies, top=""):
    """Write a scene of bodies, each a mesh with more keys, and return it."""
    text = top + "\n"
    for name, body in zip("abcdef", bodies, strict=False):
        text += f'[[body]]\nname = "{name}"\nmesh = {body}\n'
    (folder / "s.toml").write_text(text)
    return Scene.load(folder / "s.toml")


def pairs(made):
    return {(found.body_a, found.body_b) for found in made.first_contacts()}


def test_body_is_scaled_by_its_scale(folder):
    # From 5 to 6, from 0 to 5.5, and from 2.5 to 3: all stand on the ground.
    found = scene(folder, '"far.obj"', '"cube.stl"\nscale = 5.5', '"far.obj"\nscale = 0.5')

    assert pairs(found) == {("a", "b"), ("b", "c")}
    found = scene(folder, '"far.obj"', '"cube.stl"', '"cube.stl"\nscale = 5')
    assert pairs(found) == {("a", "c"), ("b", "c")}


def test_bodies_are_brought_to_the_unit_of_the_scene(folder):
    top = 'unit = "cm"'
    # The square is 1 m, 100 cm; the cubes are 1 cm, and 10 cm where theirs is dm to be told in mm.
    found = scene(folder, '"square.glb"', '"far.obj"', '"far.obj"\nunit = "m"', top=top)

    shapes = [body.body.shape for body in found.bodies]
    meshes = [obbcli.load_mesh(shape) for shape in shapes]
    assert [mesh.bounds.tolist() for mesh in meshes] == [
        [[0, 0, 0], [100, 100, 0]],
        [[5, 0, 0], [6, 1, 1]],
        [[500, 0, 0], [600, 100, 100]],
    ]
    assert {mesh.unit for mesh in meshes} == {"cm"}
    assert pairs(found) == {("a", "b")}
    # A body of the scene is asked about as it is taken there, by itself too.
    assert not obbcli.collide(found.bodies[1].body, found.bodies[2].body).collides


def test_unit_of_a_body_replaces_what_its_file_states(folder):
    found = scene(folder, '"square.glb"\nunit = "mm"', '"far.obj"\nunit = "mm"')

    assert pairs(found) == set()
    assert obbcli.load_mesh(found.bodies[0].body.shape).unit == "mm"


def test_one_file_in_two_units_is_two_bodies(folder, monkeypatch):
    monkeypatch.chdir(folder)
    found = scene(folder, '"cube.stl"', '"cube.stl"\nscale = 3', '"cube.stl"\nscale = 3')

    sizes = [shape.bounds.max() for shape in found.first_contacts().asked.shapes]
    assert sizes == [1, 3, 3]


def test_bodies_of_two_units_are_refused(folder):
    found = scene(folder, '"square.glb"', '"far.obj"\nunit = "mm"')

    with pytest.raises(MeshError, match="unit: a is in m, b in mm; bring both to one"):
        pairs(found)


def test_trees_of_another_unit_are_refused(folder):
    obbcli.ObbTree.build(folder / "square.glb").save(folder / "m.obbt")

    assert pairs(scene(folder, '"m.obbt"', '"square.glb"', top='unit = "m"')) == {("a", "b")}
    for body, top, told in (
        ('"m.obbt"', 'unit = "mm"', "is a tree in m, not mm"),
        ('"m.obbt"\nunit = "mm"', "", "is a tree in m, not mm"),
        ('"m.obbt"\nscale = 2', "", "is a tree file, which is not scaled"),
    ):
        made = scene(folder, body, '"cube.stl"', top=top)
        with pytest.raises(MeshError, match=told):
            pairs(made)
        with pytest.raises(MeshError, match=told):
            obbcli.collide(made.bodies[0].body, folder / "cube.stl")


@pytest.mark.parametrize(
    ("body", "top", "told"),
    [
        ("scale = 0", "", "scale: is 0; use a number above 0"),
        ("scale = -1", "", "scale: is -1.0"),
        ('scale = "2"', "", "scale: is '2'"),
        ("scale = inf", "", "scale: is inf"),
        ('unit = "ell"', "", "unit: is 'ell'; use one of m, cm, mm, um, in, ft"),
        ("unit = 3", "", "unit: is 3"),
        ('unit = "m"\nscale = 2', "", "has unit and scale"),
        ("", 'unit = "inch"', "unit: is 'inch'"),
    ],
)
def test_units_and_scales_that_are_none_are_refused(folder, body, top, told):
    with pytest.raises(SceneError, match=told):
        scene(folder, f'"cube.stl"\n{body}', top=top)
