"""Medit files, text and binary, by hand and against meshio."""

from __future__ import annotations

import struct

import meshio
import numpy as np
import pytest
from mesh_files.cell_files import POINTS, write

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes
from obbcli.mesh.formats import medit
from obbcli.mesh.formats.cells.surface import Block, surface
from obbcli.mesh.source import Source

PLACES = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1]]
TEXT = """MeshVersionFormatted 2
# made by hand
Dimension
3
Vertices 5
0 0 0 1
1 0 0 1 1 1 0 1 # two rows on a line, and Triangles in a comment
0 1 0
1
.5 .5 1.0D0 1
Corners 1
1
Triangles
2
1 2 5 7
2 3 5 7
RequiredTriangles
1
1
Quadrilaterals 1 1 2 3 4 9
Normals
1
0 0 1
End
what follows is of no file
""".replace("1.0D0", "1.0e0")
ROWS = [[0, 1, 4], [1, 2, 4], [0, 1, 2], [0, 2, 3]]


def keyword(order, version, code, body, at):
    """Return one keyword of a binary file; it begins at the byte `at`."""
    position = "q" if version >= 3 else "i"
    size = 4 + struct.calcsize(f"={position}") + len(body)
    return struct.pack(f"{order}i{position}", code, at + size) + body


def binary(order, version):
    """Return a binary file of the same cells, with marks of corners between them."""
    whole, real = "q" if version == 4 else "i", "f" if version == 1 else "d"
    vertices = struct.pack(f"{order}{whole}", len(PLACES))
    for place in PLACES:
        vertices += struct.pack(f"{order}3{real}{whole}", *place, 1)
    data = struct.pack(f"{order}2i", 1, version)
    for code, body in (
        (3, struct.pack(f"{order}i", 3)),
        (4, vertices),
        (13, struct.pack(f"{order}2{whole}", 1, 1)),
        (6, struct.pack(f"{order}9{whole}", 2, 1, 2, 5, 7, 2, 3, 5, 7)),
        (7, struct.pack(f"{order}6{whole}", 1, 1, 2, 3, 4, 9)),
    ):
        data += keyword(order, version, code, body, len(data))
    return data + struct.pack(f"{order}i", 54)


FILES = {
    "text": (".mesh", TEXT.encode()),
    "Windows' line ends": (".mesh", TEXT.replace("\n", "\r\n").encode()),
    "small letters": (".mesh", TEXT.lower().encode()),
    **{
        f"binary {version} {order}": (".meshb", binary(order, version))
        for version in (1, 2, 3, 4)
        for order in "<>"
    },
}


@pytest.mark.parametrize("name", FILES)
def test_files_give_the_triangles_of_the_file(name):
    suffix, data = FILES[name]

    mesh = load_mesh_bytes(data, suffix)

    assert mesh.vertices.tolist() == PLACES
    assert mesh.triangles.tolist() == ROWS
    assert mesh.notes == ()


def test_comments_change_nothing_wherever_they_stand():
    lines = TEXT.splitlines()
    for place in range(1, len(lines)):
        text = "\n".join([*lines[:place], "# Tetrahedra 5 $", *lines[place:]])

        assert load_mesh_bytes(text.encode(), ".mesh").triangles.tolist() == ROWS


def test_flat_files_lie_at_zero():
    text = "MeshVersionFormatted 1 Dimension 2 Vertices 3 0 0 0 1 0 0 0 1 0 Triangles 1 1 2 3 0"

    mesh = load_mesh_bytes(text.encode(), ".mesh")

    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


CELLS = {
    "triangle": [[0, 1, 2], [4, 5, 6]],
    "quad": [[0, 1, 5, 4]],
    "tetra": [[0, 1, 2, 5], [0, 2, 3, 7]],
    "hexahedron": [[0, 1, 2, 3, 4, 5, 6, 7]],
    "wedge": [[0, 3, 1, 4, 7, 5]],
    "pyramid": [[4, 5, 6, 7, 8]],
}


@pytest.mark.parametrize("suffix", [".mesh", ".meshb"])
@pytest.mark.parametrize("kind", CELLS)
def test_files_of_meshio_are_the_cells_that_meshio_reads(kind, suffix, tmp_path):
    if suffix == ".mesh" and kind == "pyramid":
        kind = "tetra"  # which meshio writes as text, and pyramids it does not
    path = write(tmp_path / f"a{suffix}", [(kind, np.array(CELLS[kind]))], POINTS)
    theirs = meshio.read(path)
    blocks = [Block(block.type, block.data) for block in theirs.cells]

    ours = load_mesh(path)

    wanted = surface(Source("x", "x", b""), theirs.points, blocks)
    assert ours.triangles.tolist() == wanted.tolist()
    assert np.allclose(ours.vertices, theirs.points, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("1 2 5 7", "1 2 6 7", r":13: triangles 1 uses vertex 6 of 5; vertices are counted from 1"),
        ("1 2 5 7", "0 2 5 7", r":13: triangles 1 uses vertex 0 of 5"),
        ("1 2 5 7", "1 2.5 5 7", r"triangles 1 uses vertex 2\.5 of 5"),
        ("1 2 5 7", "1 2 5", r":13: triangles claims 2 rows of 4 numbers, and 7 numbers follow"),
        ("1 2 5 7", "1 2 5 7 8", r"claims 2 rows of 4 numbers, and 9 numbers follow"),
        ("1 2 5 7", "1 2 5 7x", r":13: a word under triangles is no number"),
        ("Vertices 5", "Vertices 500000000", r":5: vertices claims 500000000 rows of 4 numbers"),
        ("Vertices 5", "Vertices -5", r":5: vertices claims -5 rows"),
        ("Dimension\n3", "Dimension\n4", r":3: dimension is not one number, 2 or 3"),
        ("Dimension\n3", "", r"has vertices before their dimension"),
        ("Quadrilaterals", "HexahedraQ2", r":20: 'hexahedraq2' is no keyword that is read"),
        ("Quadrilaterals", "Polygons", r"'polygons' is no keyword that is read; remove it if"),
        ("MeshVersionFormatted", "3 MeshVersionFormatted", r"does not begin with a keyword"),
        ("0 1 0\n", "0 nan 0\n", r"vertex 3: y is nan"),
    ],
)
def test_faults_are_told_with_their_line(old, new, fault):
    assert old in TEXT

    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(TEXT.replace(old, new, 1).encode(), ".mesh")


@pytest.mark.parametrize("name", [name for name in FILES if name.startswith("binary")])
def test_binary_files_that_are_cut_short_are_refused(name):
    data = FILES[name][1]

    for size in range(1, len(data), 7):
        with pytest.raises(MeshError):
            load_mesh_bytes(data[:size], ".meshb")


@pytest.mark.parametrize("word", ["triangles", "quadrilaterals"])
def test_cells_that_are_not_known_are_refused(word, monkeypatch):
    monkeypatch.delitem(medit._CELLS, word)
    monkeypatch.delitem(medit._CODES, {"triangles": 6, "quadrilaterals": 7}[word])

    for suffix, data in FILES.values():
        with pytest.raises(MeshError, match="is no keyword that is read"):
            load_mesh_bytes(data, suffix)


@pytest.mark.parametrize("word", ["corners", "requiredtriangles", "normals"])
def test_keywords_that_are_passed_over_are_listed(word, monkeypatch):
    monkeypatch.delitem(medit._PASSED_OVER, word)

    with pytest.raises(MeshError, match=f"'{word}' is no keyword that is read"):
        load_mesh_bytes(TEXT.encode(), ".mesh")
