"""COLLADA: what the scene shows, in which unit and with which axis up, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from mesh_files.collada_files import (
    ASSET,
    EVERY_KIND,
    INPUT,
    SKIN,
    document,
    geometry,
    node,
    triangles,
)

from obbcli import MeshError, load_mesh, load_parts
from obbcli.mesh import load_mesh_bytes

SHOW = '<instance_geometry url="#g"/>'
SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
TOP = [0, 0, 1]


def load(*arguments, **more):
    return load_mesh_bytes(document(*arguments, **more), ".dae")


def unit(words="", up="Z_UP"):
    return f"<asset>{words}<up_axis>{up}</up_axis></asset>"


def placed(transforms):
    """Return where the points 1, 2 and 3 along x, y and z go by a node's transforms."""
    points = "0 0 0 1 0 0 0 2 0 0 0 3 0 0 0"
    shape = geometry(triangles("0 1 2 0 2 3"), points=points)
    return load(node(transforms + SHOW), shape).vertices[:4].tolist()


def test_a_node_shows_its_geometry():
    found = load()

    assert found.vertices.tolist() == [*SQUARE, TOP]
    assert found.triangles.tolist() == [[0, 1, 2]]
    assert (found.unit, found.notes) == ("m", ())


def test_every_kind_of_surface_becomes_triangles_in_the_order_of_the_file():
    found = load(geometries=geometry(EVERY_KIND))

    assert found.triangles.tolist() == [
        *([0, 1, 2], [0, 2, 3]),  # triangles
        *([0, 1, 2], [0, 2, 3], [0, 1, 4]),  # polylist
        *([0, 1, 2], [0, 2, 3]),  # polygons
        *([0, 1, 2], [0, 2, 3]),  # trifans
        *([0, 1, 3], [3, 1, 2]),  # tristrips
    ]


def test_corners_stand_among_the_numbers_of_other_inputs():
    other = '<input semantic="NORMAL" source="#v" offset="0"/>'
    corner = INPUT.replace('offset="0"', 'offset="1"')

    shape = f'<triangles count="1">{other}{corner}<p>9 0 9 1 9 4</p></triangles>'

    assert load(geometries=geometry(shape)).triangles.tolist() == [[0, 1, 4]]


def test_concave_polygons_are_cut_within_themselves_and_told():
    points = "2 0 0 4 4 0 2 1 0 0 4 0 0 0 0"
    shape = f'<polylist count="1">{INPUT}<vcount>4</vcount><p>1 2 3 0</p></polylist>'

    found = load(geometries=geometry(shape, points=points))

    a, b, c = (found.vertices[found.triangles[:, k], :2] for k in range(3))
    areas = 0.5 * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    # A triangle of base 4 and height 4, less a notch of the same base and height 3.
    assert areas.sum() == 8 - 6
    assert found.notes == ("1 concave polygon cut within itself into 2 triangles",)


def test_polygons_of_two_corners_have_no_surface():
    shape = f'<polylist count="2">{INPUT}<vcount>2 3</vcount><p>0 1 0 1 2</p></polylist>'

    found = load(geometries=geometry(shape))

    assert found.triangles.tolist() == [[0, 1, 2]]
    assert found.notes == ("1 polygon of fewer than three corners left out: without surface",)


@pytest.mark.parametrize(
    ("transforms", "expected"),
    [
        ("<translate>1 2 3</translate>", [[1, 2, 3], [2, 2, 3], [1, 4, 3], [1, 2, 6]]),
        ("<scale>2 3 4</scale>", [[0, 0, 0], [2, 0, 0], [0, 6, 0], [0, 0, 12]]),
        ("<rotate>0 0 1 90</rotate>", [[0, 0, 0], [0, 1, 0], [-2, 0, 0], [0, 0, 3]]),
        ("<rotate>0 5 0 -90</rotate>", [[0, 0, 0], [0, 0, 1], [0, 2, 0], [-3, 0, 0]]),
        ("<rotate>1 0 0 450</rotate>", [[0, 0, 0], [1, 0, 0], [0, 0, 2], [0, -3, 0]]),
        ("<rotate>0 0 0 0</rotate>", [[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]]),
        (
            "<matrix>0 1 0 5 0 0 1 6 1 0 0 7 0 0 0 1</matrix>",
            [[5, 6, 7], [5, 6, 8], [7, 6, 7], [5, 9, 7]],
        ),
        # It looks from (0, 0, 5) along -x with y up: its own z looks back, along x.
        (
            "<lookat>0 0 5 -1 0 5 0 1 0</lookat>",
            [[0, 0, 5], [0, 0, 4], [0, 2, 5], [3, 0, 5]],
        ),
        # The last one is applied first.
        (
            "<translate>10 0 0</translate><rotate>0 0 1 90</rotate><scale>2 2 2</scale>",
            [[10, 0, 0], [10, 2, 0], [6, 0, 0], [10, 0, 6]],
        ),
    ],
)
def test_transforms_place_a_node(transforms, expected):
    assert placed(transforms) == expected


def test_a_turn_of_any_angle_is_that_of_its_sine_and_cosine():
    found = placed("<rotate>0 0 3 30</rotate>")[1]

    assert found == pytest.approx([3**0.5 / 2, 0.5, 0], rel=0, abs=1e-15)


@pytest.mark.parametrize(
    ("up", "turned"),
    [
        ("Z_UP", lambda x, y, z: [x, y, z]),
        ("Y_UP", lambda x, y, z: [x, -z, y]),
        ("X_UP", lambda x, y, z: [-y, -z, x]),
    ],
)
def test_what_is_up_becomes_z(up, turned):
    found = load(asset=unit(up=up))

    assert found.vertices.tolist() == [turned(*point) for point in [*SQUARE, TOP]]
    notes = () if up == "Z_UP" else (f"turned from {up[0]} up to Z up",)
    assert found.notes == notes


def test_y_is_up_where_nothing_else_is_said():
    assert load(asset="").notes == ("turned from Y up to Z up",)


@pytest.mark.parametrize(
    ("metres", "name"),
    [
        *(("1", "m"), ("0.01", "cm"), ("0.001", "mm"), ("1e-6", "um")),
        *(("0.0254", "in"), ("0.3048", "ft"), ("0.0099999998", "cm")),
    ],
)
def test_the_unit_is_the_one_that_is_stated(metres, name):
    found = load(asset=unit(f'<unit meter="{metres}"/>'))

    assert found.unit == name
    assert found.vertices.tolist() == [*SQUARE, TOP]
    assert found.notes == ()


def test_a_unit_without_a_name_of_ours_is_brought_to_metres_and_told():
    found = load(asset=unit('<unit name="cubit" meter="0.5"/>'))

    assert found.vertices.max() == 0.5
    assert found.unit == "m"
    assert found.notes == ("from units of 0.5 m to m: coordinates times that",)


def test_parts_are_called_by_the_names_of_their_nodes(tmp_path):
    inner = node(SHOW, "", 'id="hand"') + node(SHOW + SHOW, "")
    nodes = node("<translate>5 0 0</translate>" + SHOW + inner, "arm") + node(SHOW, "arm")
    path = tmp_path / "robot.dae"
    path.write_bytes(document(nodes))

    parts = load_parts(path).parts

    paths = ["arm", "arm/hand", "arm/g shape", "arm/g shape#2", "arm#2"]
    assert [part.path for part in parts] == paths
    assert all(part.mesh is parts[0].mesh for part in parts)
    assert [part.placed_bounds()[0].tolist() for part in parts] == [[5, 0, 0]] * 4 + [[0, 0, 0]]
    assert len(load_mesh(f"{path}#arm").triangles) == 4


def test_instances_of_nodes_stand_where_they_are_named():
    held = node("<translate>0 0 2</translate>" + SHOW, "k", 'id="k"')
    nodes = node('<translate>1 0 0</translate><instance_node url="#k"/>')

    found = load(nodes, more=f"<library_nodes>{held}</library_nodes>")

    assert found.vertices[0].tolist() == [1, 0, 2]


def test_skins_stand_in_their_bind_shape_and_say_so():
    nodes = node('<translate>0 9 0</translate><instance_controller url="#c"/>')

    found = load(nodes, more=SKIN)

    assert found.vertices[0].tolist() == [7, 0, 0]
    assert found.notes == ("skins stand in their bind shape: their joints are not applied",)


@pytest.mark.parametrize("weight", ["0", "0.5"])
def test_morphs_are_read_at_rest_alone(weight):
    morph = (
        '<library_controllers><controller id="c"><morph source="#g">'
        f'<source id="w"><float_array id="wa" count="1">{weight}</float_array></source>'
        '<targets><input semantic="MORPH_WEIGHT" source="#w"/></targets></morph></controller>'
        "</library_controllers>"
    )
    data = document(node('<instance_controller url="#c"/>'), more=morph)

    if weight == "0":
        assert load_mesh_bytes(data, ".dae").vertices.tolist() == [*SQUARE, TOP]
    else:
        with pytest.raises(MeshError, match="<morph> has weights, which is not read"):
            load_mesh_bytes(data, ".dae")


def test_a_document_without_a_scene_shows_what_it_has_and_says_so():
    assert load(scene="").notes == ("has no <scene>: its one visual scene is taken",)

    plain = document(scene="").replace(b"visual_scene", b"other_scene")
    assert load_mesh_bytes(plain, ".dae").notes == (
        "has no scene: its geometries are taken where they were modelled",
    )


def test_lines_beside_a_surface_are_passed_over():
    lines = geometry(f'<lines count="1">{INPUT}<p>0 1</p></lines>', "h")

    found = load(node(SHOW + '<instance_geometry url="#h"/>'), geometry() + lines)

    assert len(found.triangles) == 1


@pytest.mark.parametrize("suffix", [".stl", ".xml", ""])
@pytest.mark.parametrize("before", ["", "<!-- a --><!-- b -->\n"])
def test_content_tells_a_collada_document(tmp_path, suffix, before):
    path = tmp_path / f"part{suffix}"
    path.write_bytes(document().replace(b"<COLLADA", before.encode() + b"<COLLADA"))

    assert load_mesh(path).notes == ("is a COLLADA document by its content, and is read as such",)


def test_comments_that_do_not_end_take_no_long_time():
    with pytest.raises(MeshError):
        load_mesh_bytes(b"<!-- --> " * 7000 + b"<x>", ".dae")


def test_text_in_utf_16_is_read():
    data = document(asset=ASSET).decode().replace("utf-8", "utf-16").encode("utf-16")

    assert load_mesh_bytes(data, ".dae").vertices.tolist() == [*SQUARE, TOP]


def test_an_id_that_two_elements_have_is_no_fault_where_nothing_links_to_it():
    cameras = '<library_cameras><camera id="c"/><camera id="c"/></library_cameras>'

    assert len(load(more=cameras).triangles) == len(load().triangles) > 0
