"""ASCII STL as exporters write it: comments, colours, closing words as two, several solids."""

from __future__ import annotations

import pytest

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes
from obbcli.mesh.formats import stl as stl_module

FIRST = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]
ASCII = b"""solid part
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid part
"""

REMARKS = [
    ASCII.replace(b"endsolid part", b"end solid"),
    ASCII.replace(b"endsolid part", b"End  Solid part"),
    ASCII.replace(b"endfacet", b"end facet").replace(b"endloop", b"end\tloop"),
    ASCII.replace(b"solid part\nfacet", b"solid part\ncolor 0.5 0.5 0.5\nfacet"),
    ASCII.replace(b"endfacet", b"endfacet\n  COLOUR 1 0 0"),
    b"# made by a script; do not edit: solid b facet normal\n" + ASCII,
    b"; made by a script\r\n// and by another\r\n" + ASCII.replace(b"\n", b"\r\n"),
    ASCII.replace(b"outer loop", b"outer loop\n# facet normal 1 2 3\n#\n"),
    ASCII + b"# the end\n",
    ASCII.replace(b"\n", b"\r").replace(b"facet", b"# solid\rfacet", 1),
    ASCII.replace(b"vertex 1 0 0", b"vertex\n1 0 0\n# half way\n"),
]


@pytest.mark.parametrize("data", REMARKS)
def test_ascii_stl_passes_over_comments_and_colours_and_takes_closing_words_as_two(data):
    mesh = load_mesh_bytes(data, ".stl")

    assert mesh.vertices.tolist() == FIRST
    assert mesh.notes == ()


@pytest.mark.parametrize("data", REMARKS)
def test_ascii_stl_with_remarks_reads_the_same_by_columns_and_by_words(data, monkeypatch):
    monkeypatch.setattr(stl_module, "_read_regular", lambda _: None)

    assert load_mesh_bytes(data, ".stl").vertices.tolist() == FIRST


def test_ascii_stl_takes_all_solids_with_colours_and_comments_between():
    second = ASCII.replace(b"part", b"end solid # of two").replace(b"0 1 0", b"0 3 0")
    data = ASCII + b"# the other one\n" + second.replace(b"\nfacet", b"\ncolor 1 1 1\nfacet", 1)

    mesh = load_mesh_bytes(data, ".stl")

    assert mesh.vertices.tolist() == [*FIRST, [0, 0, 0], [1, 0, 0], [0, 3, 0]]


@pytest.mark.parametrize(
    ("data", "fault"),
    [
        (b"facet normal 0 0 1\n" * 20, r":1: is text, but no STL: found 'facet', expected 'solid'"),
        (b"# one\n\nxolid a\n" + b"x" * 200, r":3: is text, but no STL: found 'xolid'"),
        (b"# one\n# two\n" * 20, "holds comments alone, expected 'solid'"),
        (
            ASCII.replace(b"endloop", b"vertex 0 0 1\nendloop"),
            r":7: found 'vertex', expected",
        ),
        (ASCII.replace(b"1 0 0", b"1,0 0 0"), r":5: '1,0' is not a number"),
        (
            ASCII.replace(b"part", b"a" * 200, 1).replace(b"1 0 0", b"\x011 0 0"),
            r":5: '\?1' is not a number",
        ),
        (b"# one\n" + ASCII.replace(b"1 0 0", b"x 0 0"), r":6: 'x' is not a number"),
        (ASCII.replace(b"outer loop", b"colours 1\nouter loop"), r":3: found 'colours'"),
    ],
)
def test_ascii_stl_refuses_what_is_neither_shape_nor_remark_and_names_the_line(data, fault):
    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(data, ".stl")
