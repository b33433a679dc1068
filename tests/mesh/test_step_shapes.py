"""STEP: what makes a product's shape, by closed forms, and what Open CASCADE would get wrong."""

from __future__ import annotations

import numpy as np
import pytest
from mesh_files.step_files import ORIGIN, StepFile, box, sphere

from obbcli import MeshError, load_parts
from obbcli.mesh import load_mesh_bytes

pytestmark = pytest.mark.needs("cadquery-ocp-novtk")


def load(file, **more):
    data = file if isinstance(file, bytes) else file.bytes()
    return load_mesh_bytes(data, ".step", name="a.step", **more)


def volume(mesh):
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    return np.einsum("fd,fd->", a, np.cross(b, c)) / 6


def mapped(file, *targets):
    """Add a product of a box of 1 x 2 x 3, mapped to axes or by operators."""
    cube = file.solid(file.faces_of_box((0, 0, 0), (1, 2, 3)))
    drawn = f"({cube},{file.axes(*ORIGIN)}),{file.context}"
    drawn = file.add(f"ADVANCED_BREP_SHAPE_REPRESENTATION('',{drawn})")
    source = file.add(f"REPRESENTATION_MAP({file.axes(*ORIGIN)},{drawn})")
    items = [file.add(f"MAPPED_ITEM('',{source},{target})") for target in targets]
    file.product("mapped", items, "SHAPE_REPRESENTATION")
    return file


def operator(file, scale="$", z=None):
    x, y = file.direction((1, 0, 0)), file.direction((0, 1, 0))
    z = "$" if z is None else file.direction(z)
    at = file.point((3, 0, 0))
    return file.add(f"CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',{x},{y},{at},{scale},{z})")


def test_a_hollow_solid_is_its_outside_less_its_inside():
    file = StepFile()
    outside, inside = (
        file.add(f"CLOSED_SHELL('',{file.list(file.faces_of_box(low, high))})")
        for low, high in (((0, 0, 0), (4, 4, 4)), ((1, 1, 1), (2, 2, 2)))
    )
    turned = file.add(f"ORIENTED_CLOSED_SHELL('',*,{inside},.F.)")
    file.product("hollow", [file.add(f"BREP_WITH_VOIDS('',{outside},({turned}))")])
    found = load(file)

    assert volume(found) == pytest.approx(4**3 - 1)
    assert found.is_watertight


def test_a_faceted_solid_is_its_polygons():
    file = StepFile()
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    names = [file.point(corner) for corner in corners]
    faces = []
    for rows in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)):
        a, b, c = (np.array(corners[row]) for row in rows)
        loop = file.add(f"POLY_LOOP('',{file.list([names[row] for row in rows])})")
        plane = file.add(f"PLANE('',{file.axes(a, np.cross(b - a, c - a), b - a)})")
        bound = file.add(f"FACE_OUTER_BOUND('',{loop},.T.)")
        faces.append(file.add(f"FACE_SURFACE('',({bound}),{plane},.T.)"))
    shell = file.add(f"CLOSED_SHELL('',{file.list(faces)})")
    body = file.add(f"FACETED_BREP('',{shell})")
    file.product("tetrahedron", [body], "FACETED_BREP_SHAPE_REPRESENTATION")
    found = load(file)

    assert len(found.triangles) == 4
    assert volume(found) == pytest.approx(1 / 6)


def test_a_trimmed_surface_of_a_set_is_a_face():
    file = StepFile()
    plane = file.add(f"PLANE('',{file.axes(*ORIGIN)})")
    trims = "0.,1.,0.,2.,.T.,.T."
    patch = file.add(f"RECTANGULAR_TRIMMED_SURFACE('',{plane},{trims})")
    kind = "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION"
    file.product("patch", [file.add(f"GEOMETRIC_SET('',({patch}))")], kind)

    assert load(file).bounds.tolist() == [[0, 0, 0], [1, 2, 0]]


def test_mapped_items_are_parts_that_share_a_mesh(tmp_path):
    file = StepFile()
    mapped(file, *(file.axes((x, 0, 0), *ORIGIN[1:]) for x in (0, 5)), operator(file))
    path = tmp_path / "a.step"
    path.write_bytes(file.bytes())
    found = load_parts(path)

    assert [part.path for part in found] == ["mapped", "mapped#2", "mapped#3"]
    assert [part.vertices()[:, 0].min() for part in found] == [0, 5, 3]


@pytest.mark.parametrize(("scale", "z"), [("2.", None), ("0.5", None), ("$", (0, 0, -1))])
def test_a_scaled_or_mirrored_shape_is_refused(scale, z):
    file = StepFile()
    mapped(file, operator(file, scale, z))

    words = r"#\d+: CARTESIAN_TRANSFORMATION_OPERATOR_3D scales or mirrors a shape"
    with pytest.raises(MeshError, match=words):
        load(file)


def test_what_no_product_uses_is_no_part_of_it():
    file = StepFile()
    file.faces_of_box((7, 7, 7), (8, 8, 8))
    operator(file, "2.")
    file.product("box", [file.solid(file.faces_of_box((0, 0, 0), (1, 2, 3)))])

    assert load(file).bounds.tolist() == [[0, 0, 0], [1, 2, 3]]


def test_a_shape_of_no_product_is_refused():
    file = StepFile()
    lost = file.solid(file.faces_of_box((7, 7, 7), (8, 8, 8)))
    file.add(f"ADVANCED_BREP_SHAPE_REPRESENTATION('',({lost}),{file.context})")
    file.product("box", [file.solid(file.faces_of_box((0, 0, 0), (1, 2, 3)))])

    with pytest.raises(MeshError, match=r"#\d+: .* cannot be made, the first of 13: it would be"):
        load(file)


def test_a_solid_that_lacks_a_face_is_told():
    file = StepFile()
    file.product("open", [file.solid(file.faces_of_box((0, 0, 0), (1, 2, 3))[:5])])
    found = load(file)

    assert "solids that do not close, taken as surfaces: 1 of 1" in found.notes
    assert not found.is_watertight


@pytest.mark.parametrize(("size", "unit"), [(1e-4, "m"), (3e-5, "m"), (50.0, "um"), (1e4, "um")])
def test_small_lengths_in_large_units_are_the_file_s_bits(size, unit):
    corners = (0.1 * size, 0.2 * size, 0.3 * size), (1.1 * size, 2.2 * size, 3.3 * size)
    found = load(box(*corners, unit))

    assert found.bounds.tolist() == [list(corner) for corner in corners]
    assert found.is_watertight


def test_a_sphere_of_a_tenth_of_a_millimetre_in_metres_is_within_its_sag():
    found = load(sphere(1e-4, unit="m"))
    middles = found.vertices[found.triangles].mean(axis=1)

    assert found.sag <= 1e-3 * 2e-4 * 3**0.5
    assert np.abs(np.linalg.norm(middles, axis=1) - 1e-4).max() <= found.sag
