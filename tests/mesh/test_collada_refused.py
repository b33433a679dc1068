"""COLLADA: what is wrong in a document is refused with its line, and nothing multiplies."""

from __future__ import annotations

import pytest
from mesh_files.collada_files import (
    COLLADA_SEEDS,
    INPUT,
    document,
    geometry,
    node,
    triangles,
)

from obbcli import MeshError
from obbcli.mesh import load_mesh_bytes

SHOW = '<instance_geometry url="#g"/>'


def load(*arguments, **more):
    return load_mesh_bytes(document(*arguments, **more), ".dae")


def unit(words="", up="Z_UP"):
    return f"<asset>{words}<up_axis>{up}</up_axis></asset>"


def shaped(primitives):
    return document(geometries=geometry(primitives))


def accessed(words):
    return document(geometries=geometry(accessor=words))


BAD = {
    "number": (document().replace(b"1 1 0", b"1 1,5 0"), r":3: '1,5' in <float_array> is not a"),
    "nan": (document().replace(b"1 1 0", b"1 NaN 0"), "'NaN' in <float_array> is not a finite"),
    "underscore": (document().replace(b"1 1 0", b"1 1_0 0"), "'1_0' in <float_array>"),
    "array": (document().replace(b'count="15"', b'count="16"'), "claims 16 numbers, and has 15"),
    "stride 0": (accessed('count="5" stride="0"'), "<accessor> has stride 0, less than the 3"),
    "no stride": (accessed('count="5"'), "<accessor> has stride 1, less than the 3"),
    "accessor": (accessed('count="6" stride="3"'), "claims 6 points, more than the 15 numbers"),
    "offset": (accessed('count="5" stride="3" offset="1"'), "claims 5 points, more than"),
    "index": (shaped(triangles("0 1 5")), "<p> names vertex 5, the last one is 4"),
    "negative": (shaped(triangles("0 1 -1")), "index -1 is out of range"),
    "huge": (shaped(triangles(f"0 1 {10**30}")), "index 1000.* is out of range"),
    "word": (shaped(triangles("0 1 a")), "index 'a' is not a whole number"),
    "count": (shaped(triangles().replace('"1"', '"2"')), "claims 2 triangles, and has 1"),
    "corners": (shaped(triangles("0 1 2 3").replace("1", "1")), "has 4 corners, not 3 each"),
    "vcount": (
        shaped(f'<polylist count="1">{INPUT}<vcount>4</vcount><p>0 1 2</p></polylist>'),
        "<vcount> counts 4 corners, <p> has 3",
    ),
    "vcount overflow": (
        shaped(
            f'<polylist count="2">{INPUT}<vcount>{2**52} {2**52}</vcount><p>0 1 2</p></polylist>'
        ),
        f"<vcount> counts {2**53} corners, <p> has 3",
    ),
    "holes": (
        shaped(f'<polygons count="1">{INPUT}<ph><p>0 1 2 3</p><h>0 1 2</h></ph></polygons>'),
        "<ph> is a polygon with holes, which is not read",
    ),
    "no input": (shaped("<triangles><p>0 1 2</p></triangles>"), "has 0 inputs of vertices"),
    "unknown": (shaped("<patches/>"), "<patches> is not read"),
    "skew": (document(node("<skew>45 0 1 0 1 0 0</skew>" + SHOW)), "<skew> is not read"),
    "short": (document(node("<scale>1 2</scale>" + SHOW)), "<scale> has 2 numbers, expected 3"),
    "axis": (document(node("<rotate>0 0 0 9</rotate>" + SHOW)), "<rotate> has an axis of no len"),
    "projection": (
        document(node("<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1</matrix>" + SHOW)),
        "<matrix> has a last row that is not 0 0 0 1",
    ),
    "link": (document(node('<instance_geometry url="#q"/>')), "<geometry> 'q', which is not there"),
    "kind": (document(node('<instance_geometry url="#v"/>')), "'v', which is a <vertices>"),
    "outside": (
        document(node('<instance_geometry url="other.dae#g"/>')),
        "links to 'other.dae#g', which is not in this file; bring all into one",
    ),
    "scene": (document(scene="#q"), "<visual_scene> 'q', which is not there"),
    "ids": (document(geometries=geometry() + geometry()), "two elements have the id 'g'"),
    "itself": (
        document(node('<instance_node url="#k"/>', more='id="k"')),
        "a node holds itself, or instances nest deeper than 100",
    ),
    "unit": (document(asset=unit('<unit meter="-1"/>')), "the unit is '-1' metres long"),
    "up": (document(asset=unit(up="W_UP")), "the axis 'W_UP' is up, expected one of X_UP, Y_UP"),
    "two units": (
        document(geometries=unit('<unit meter="0.01"/>') + geometry()),
        "an <asset> inside states another unit or axis",
    ),
    "version": (document().replace(b"1.4.1", b"1.3.1"), "is COLLADA 1.3.1, only 1.4 and 1.5"),
    "entity": (
        document().replace(b"<COLLADA", b'<!DOCTYPE a [<!ENTITY b "0 0 0">]><COLLADA'),
        "declares a document type; remove the <!DOCTYPE",
    ),
    "cut": (document()[:-9], "is no whole XML: .*; it was cut short or damaged"),
    "nothing": (document(nodes=node("")), "has no faces"),
    "deep": (document(nodes="<node>" * 300 + "</node>" * 300), "nests deeper than 200 elements"),
}


@pytest.mark.parametrize(("data", "fault"), BAD.values(), ids=BAD)
def test_what_is_wrong_is_refused_with_its_line(data, fault):
    with pytest.raises(MeshError, match=fault) as told:
        load_mesh_bytes(data, ".dae")

    assert "Error" not in str(told.value)


def test_instances_that_multiply_without_end_are_refused(monkeypatch):
    monkeypatch.setattr("obbcli.mesh.formats.collada.scene.MOST_PARTS", 1000)

    def doubled(k):
        inside = f'<instance_node url="#k{k - 1}"/>' * 2 if k else SHOW
        return node(inside, more=f'id="k{k}"')

    held = "".join(map(doubled, range(30)))

    with pytest.raises(MeshError, match="shows more than 1000 nodes; split the file"):
        load(node('<instance_node url="#k29"/>'), more=f"<library_nodes>{held}</library_nodes>")


def test_every_cut_of_a_document_is_refused():
    for data in COLLADA_SEEDS:
        for end in range(60, len(data) - 1, 11):
            with pytest.raises(MeshError):
                load_mesh_bytes(data[:end], ".dae")
