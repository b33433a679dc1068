"""COLLADA documents made by hand."""

from __future__ import annotations

#: Five points: a unit square in the plane z = 0, and one above its first corner.
POINTS = "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1"
TRIANGLE = '<triangles count="1">{}<p>0 1 2</p></triangles>'
INPUT = '<input semantic="VERTEX" source="#v" offset="0"/>'
ASSET = "<asset><up_axis>Z_UP</up_axis></asset>"


def triangles(numbers="0 1 2"):
    count = len(numbers.split()) // 3
    return f'<triangles count="{count}">{INPUT}<p>{numbers}</p></triangles>'


def geometry(primitives=None, key="g", accessor=None, points=POINTS):
    """Return a geometry; ids of its sources are free where its own is not "g"."""
    mark = "" if key == "g" else key
    accessor = accessor or 'count="5" stride="3"'
    params = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")
    primitives = (triangles() if primitives is None else primitives).replace("#v", f"#{mark}v")
    return (
        f'<geometry id="{key}" name="{key} shape"><mesh><source id="{mark}s">\n'
        f'<float_array id="{mark}a" count="{len(points.split())}">{points}</float_array>\n'
        f'<technique_common><accessor source="#{mark}a" {accessor}>{params}</accessor>'
        f"</technique_common></source>"
        f'<vertices id="{mark}v"><input semantic="POSITION" source="#{mark}s"/></vertices>\n'
        f"{primitives}</mesh></geometry>"
    )


def node(content='<instance_geometry url="#g"/>', name="n", more=""):
    named = f'name="{name}"' if name else ""
    return f"<node {named} {more}>{content}</node>"


def document(nodes=None, geometries=None, asset=ASSET, more="", scene="#scene"):
    shown = f'<scene><instance_visual_scene url="{scene}"/></scene>' if scene else ""
    return (
        '<?xml version="1.0" encoding="utf-8"?>\n'
        '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">'
        f"{asset}<library_geometries>{geometry() if geometries is None else geometries}"
        f'</library_geometries>\n{more}<library_visual_scenes><visual_scene id="scene">'
        f"{node() if nodes is None else nodes}</visual_scene></library_visual_scenes>"
        f"{shown}</COLLADA>"
    ).encode()


EVERY_KIND = (
    triangles("0 1 2 0 2 3")
    + f'<polylist count="2">{INPUT}<vcount>4 3</vcount><p>0 1 2 3 0 1 4</p></polylist>'
    + f'<polygons count="1">{INPUT}<p>0 1 2 3</p></polygons>'
    + f'<trifans count="1">{INPUT}<p>0 1 2 3</p></trifans>'
    + f'<tristrips count="1">{INPUT}<p>0 1 3 2</p></tristrips>'
    + f'<lines count="1">{INPUT}<p>0 1</p></lines>'
)
SKIN = (
    '<library_controllers><controller id="c"><skin source="#g"><bind_shape_matrix>'
    "1 0 0 7 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix></skin></controller>"
    "</library_controllers>"
)
EVERY_TRANSFORM = (
    "<lookat>0 0 0 0 0 -1 0 1 0</lookat><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix>"
    "<translate>1 2 3</translate><rotate>0 0 1 90</rotate><scale>2 2 2</scale>"
)
COLLADA_SEEDS = [
    document(),
    document(asset='<asset><unit meter="0.01"/></asset>', geometries=geometry(EVERY_KIND)),
    document(node(EVERY_TRANSFORM + node() + '<instance_geometry url="#g"/>')),
    document(node('<instance_controller url="#c"/>'), more=SKIN),
    document(
        node('<instance_node url="#k"/>'),
        more="<library_nodes>" + node(more='id="k"') + "</library_nodes>",
    ),
]
