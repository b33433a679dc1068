"""What stays with meshio: every keyword is known, and as many cells are taken as are listed."""

from __future__ import annotations

import meshio
import pytest

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes
from obbcli.mesh.formats.through_meshio import claimed_counts

FLAC3D = b"""* made by hand
G 1 0 0 0
G 2 1 0 0
G 3 1 1 0
G 4 0 1 0
F T3 1 1 2 3
F T3 2 1 3 4
"""
NETGEN = b"""mesh3d
dimension
3
# a comment
geomtype
0
surfaceelements
2
 1 1 0 0 3 1 2 3
 1 1 0 0 3 1 3 4
points
4
0 0 0
1 0 0
1 1 0
0 1 0
materials
1
1 default
endmesh
"""
DOLFIN = b"""<?xml version="1.0"?>
<dolfin xmlns:dolfin="http://fenicsproject.org">
<mesh celltype="triangle" dim="2">
<vertices size="4">
<vertex index="0" x="0" y="0"/><vertex index="1" x="1" y="0"/>
<vertex index="2" x="1" y="1"/><vertex index="3" x="0" y="1"/>
</vertices>
<cells size="2">
<triangle index="0" v0="0" v1="1" v2="2"/><triangle index="1" v0="0" v1="2" v2="3"/>
</cells>
<data><data_set name="odd"/></data>
</mesh>
</dolfin>
"""
KEPT = {".f3grid": FLAC3D, ".vol": NETGEN, ".xml": DOLFIN}


@pytest.mark.parametrize("suffix", KEPT)
def test_formats_that_meshio_keeps_are_read(suffix):
    mesh = load_mesh_bytes(KEPT[suffix], suffix)

    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]


@pytest.mark.parametrize(
    ("suffix", "old", "new", "fault"),
    [
        (".f3grid", b"F T3 2 1 3 4", b"P T3 2 1 3 4", r":7: 'P' is no keyword that is read"),
        (".f3grid", b"G 4 0 1 0", b"G 3 0 1 0", r":5: grid point 3 is there twice"),
        (".f3grid", b"* made by", b"\0* made by", r"is a binary FLAC3D grid"),
        (".vol", b"materials", b"curvedelements", r":17: 'curvedelements' is no keyword"),
        (".vol", b"elements\n2", b"elements\n-2", r":8: surfaceelements claims -2 of something"),
        (".vol", b"elements\n2", b"elements\n1", r"claims 1 cells|cannot read it"),
        (".xml", b"<data>", b"<hexahedron/><data>", r":11: 'hexahedron' is no keyword"),
        (".xml", b'<vertex index="3"', b'<vertex index="4"', r":6: vertex 3 of the file has ano"),
        (".xml", b'size="4"', b'size="5"', r":7: claims 5 vertices, and 4 follow"),
        (".xml", b'cells size="2"', b'cells size="3"', r":10: claims 3 cells, and 2 follow"),
        (".xml", b"</mesh>", b"", r":13: is no whole XML: mismatched tag"),
        (".xml", b"<dolfin", b"<!DOCTYPE x><dolfin", r"declares a document type"),
    ],
)
def test_what_meshio_would_pass_over_is_refused(suffix, old, new, fault):
    assert old in KEPT[suffix]

    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(KEPT[suffix].replace(old, new, 1), suffix)


@pytest.mark.parametrize(
    ("suffix", "table", "word"),
    [
        *((".f3grid", "_FLAC3D", word) for word in ("G", "F")),
        (".vol", "_NETGEN_CELLS", "surfaceelements"),
        *((".vol", "_NETGEN_OTHERS", word) for word in ("points", "materials", "geomtype")),
        *((".xml", "_DOLFIN", word) for word in ("mesh", "vertex", "triangle")),
    ],
)
def test_a_keyword_that_is_not_listed_is_refused(suffix, table, word, monkeypatch):
    monkeypatch.setattr(claimed_counts, table, getattr(claimed_counts, table) - {word})

    with pytest.raises(MeshError, match=f"'{word}' is no keyword that is read"):
        load_mesh_bytes(KEPT[suffix], suffix)


def test_cells_that_the_library_drops_are_missed(monkeypatch):
    read = meshio.flac3d.read

    def short(path):
        mesh = read(path)
        mesh.cells[0].data = mesh.cells[0].data[:1]
        return mesh

    monkeypatch.setattr("meshio.flac3d.read", short)
    with pytest.raises(MeshError, match="claims 2 cells, but 1 could be read"):
        load_mesh_bytes(FLAC3D, ".f3grid")


def test_formats_that_libraries_read_wrongly_are_refused_by_name():
    with pytest.raises(MeshError, match="is no Gmsh file; Fluent's files of the same suffix are"):
        load_mesh_bytes(b'(0 "a comment")\n(2 3)\n', ".msh")
    with pytest.raises(MeshError, match=r"is a Kratos model \(MDPA\), whose elements do not say"):
        load_mesh_bytes(b"// x\nBegin ModelPartData\nEnd ModelPartData\n")
