"""Gmsh files of versions 2 and 4, text and binary, by hand and against meshio."""

from __future__ import annotations

import struct

import meshio
import numpy as np
import pytest
from mesh_files.cell_files import POINTS, write

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes
from obbcli.mesh.formats.cells.surface import Block, surface
from obbcli.mesh.formats.gmsh import reader as gmsh
from obbcli.mesh.source import Source

NODES = [(10, 0.0, 0.0, 0.0), (7, 1.0, 0.0, 0.0), (3, 0.0, 1.0, 0.0), (12, 0.0, 0.0, 1.0)]
PLACES = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
ROWS = [[0, 1, 2], [1, 3, 2], [0, 3, 1]]
#: Tags of the nodes of three triangles, the middle one without tags of its own in version 2.
TRIANGLES = [[10, 7, 3], [7, 12, 3], [10, 12, 7]]


def section(name, body):
    return b"$%b\n%b\n$End%b\n" % (name, body, name)


def text(*lines):
    return "\n".join(lines).encode()


def version_2_text():
    nodes = text("4", *(" ".join(map(repr, node)) for node in NODES))
    elements = text(
        *("5", "1 2 2 5 6 10 7 3", "2 2 0 7 12 3", "3 15 2 5 6 10", "4 1 2 5 6 10 7"),
        "9 2 3 5 6 1 10 12 7",
    )
    return (
        section(b"MeshFormat", b"2.2 0 8")
        + section(b"Nodes", nodes)
        + section(b"Elements", elements)
    )


def version_2_binary(order):
    nodes = b"4\n" + b"".join(struct.pack(f"{order}i3d", *node) for node in NODES)
    elements = b"4\n" + struct.pack(f"{order}3i7i", 2, 1, 2, 1, 5, 6, 10, 7, 3, 0)[:-4]
    elements += struct.pack(f"{order}3i2i", 15, 1, 0, 2, 10)
    elements += struct.pack(f"{order}3i10i", 2, 2, 1, 3, 5, 7, 12, 3, 4, 5, 10, 12, 7)
    return (
        section(b"MeshFormat", b"2.2 1 8\n" + struct.pack(f"{order}i", 1))
        + section(b"Nodes", nodes)
        + section(b"Elements", elements)
    )


def version_40_text():
    nodes = text("2 4", "1 2 0 1", "10 0 0 0", "1 2 0 3", "7 1 0 0", "3 0 1 0", "12 0 0 1")
    elements = text("2 4", "1 0 15 1", "1 10", "1 2 2 3", "2 10 7 3", "3 7 12 3", "4 10 12 7")
    return (
        section(b"MeshFormat", b"4 0 8".replace(b"4 0", b"4.0 0"))
        + section(b"Nodes", nodes)
        + section(b"Elements", elements)
    )


def version_40_binary(order):
    nodes = struct.pack(f"{order}2Q3iQ", 1, 4, 1, 2, 0, 4)
    nodes += b"".join(struct.pack(f"{order}i3d", *node) for node in NODES)
    elements = struct.pack(f"{order}2Q3iQ", 1, 3, 1, 2, 2, 3)
    for number, tags in enumerate(TRIANGLES):
        elements += struct.pack(f"{order}4i", number, *tags)
    return (
        section(b"MeshFormat", b"4.0 1 8\n" + struct.pack(f"{order}i", 1))
        + section(b"Nodes", nodes)
        + section(b"Elements", elements)
    )


def version_41_text(parametric=0):
    more = " 0.25 0.5" if parametric else ""
    tags = ["10"], ["7", "3", "12"]
    nodes = text(
        *("2 4 3 12", "0 1 0 1", *tags[0], "0 0 0", f"2 1 {parametric} 3", *tags[1]),
        *(f"1 0 0{more}", f"0 1 0{more}", f"0 0 1{more}"),
    )
    elements = text("2 4 1 4", "0 1 15 1", "1 10", "2 1 2 3", "2 10 7 3", "3 7 12 3", "4 10 12 7")
    return (
        section(b"MeshFormat", b"4.1 0 8")
        + section(b"Comments", b"$ nothing\nMade by hand")
        + section(b"PhysicalNames", b'1\n2 1 "skin"')
        + section(b"Nodes", nodes)
        + section(b"Elements", elements)
    )


def version_41_binary(order):
    nodes = struct.pack(f"{order}4Q3iQ", 1, 4, 3, 12, 2, 1, 0, 4)
    nodes += struct.pack(f"{order}4Q", *(node[0] for node in NODES))
    nodes += b"".join(struct.pack(f"{order}3d", *node[1:]) for node in NODES)
    elements = struct.pack(f"{order}4Q3iQ", 1, 3, 1, 3, 2, 1, 2, 3)
    for number, tags in enumerate(TRIANGLES):
        elements += struct.pack(f"{order}4Q", number, *tags)
    return (
        section(b"MeshFormat", b"4.1 1 8\n" + struct.pack(f"{order}i", 1))
        + section(b"Nodes", nodes)
        + section(b"Elements", elements)
    )


FILES = {
    "2 text": version_2_text(),
    "2 binary": version_2_binary("<"),
    "2 binary, big-endian": version_2_binary(">"),
    "4.0 text": version_40_text(),
    "4.0 binary": version_40_binary("<"),
    "4.1 text": version_41_text(),
    "4.1 text, parametric": version_41_text(1),
    "4.1 binary": version_41_binary("<"),
    "4.1 binary, big-endian": version_41_binary(">"),
    "4 for 4.1": version_41_text().replace(b"4.1 0 8", b"4 0 8"),
    "2 for 2.2": version_2_text().replace(b"2.2 0 8", b"2 0 8"),
    "Windows' line ends": version_41_text().replace(b"\n", b"\r\n"),
}


@pytest.mark.parametrize("name", FILES)
def test_every_version_gives_the_triangles_of_the_file(name):
    mesh = load_mesh_bytes(FILES[name], ".msh")

    assert mesh.vertices.tolist() == PLACES
    assert mesh.triangles.tolist() == ROWS
    assert mesh.notes == ()


CELLS = {
    "triangle": [[0, 1, 2], [4, 5, 6]],
    "quad": [[0, 1, 5, 4]],
    "tetra": [[0, 1, 2, 5], [0, 2, 3, 7]],
    "hexahedron": [[0, 1, 2, 3, 4, 5, 6, 7]],
    "wedge": [[0, 3, 1, 4, 7, 5]],
    "pyramid": [[4, 5, 6, 7, 8]],
}


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("form", ["gmsh22", "gmsh"])
@pytest.mark.parametrize("kind", CELLS)
def test_files_of_meshio_are_the_cells_that_meshio_reads(kind, form, binary, tmp_path):
    cells = [(kind, np.array(CELLS[kind]))]
    path = write(tmp_path / "a.msh", cells, POINTS, file_format=form, binary=binary)
    theirs = meshio.read(path)
    blocks = [Block(block.type, block.data) for block in theirs.cells]

    ours = load_mesh(path)

    wanted = surface(Source("x", "x", b""), theirs.points, blocks)
    assert ours.triangles.tolist() == wanted.tolist()
    assert np.array_equal(ours.vertices, theirs.points)


def test_tags_may_be_any_numbers():
    data = version_41_text().replace(b"12", b"4000000000000")

    assert load_mesh_bytes(data, ".msh").triangles.tolist() == ROWS


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        (b"2 10 7 3", b"2 10 8 3", r":2\d: an element uses node 8, which the file does not have"),
        (b"2 10 7 3", b"2 10 0 3", r"an element uses node 0, which"),
        (b"2 10 7 3", b"2 10 -7 3", r"an element uses node -7, which"),
        (b"2 10 7 3", b"2 10 7.5 3", r"\$Elements holds a number that is not whole"),
        (b"2 10 7 3", b"2 10 x 3", r"\$Elements holds a word that is no number"),
        (b"2 10 7 3\n", b"", r"\$Elements 12 numbers are claimed, and 8 follow"),
        (b"2 10 7 3\n", b"2 10 7 3\n9 10 7 3\n", r"3|something more follow"),
        (b"2 4 1 4", b"2 5 1 4", r"\$Elements claims 5 elements, and 4 follow"),
        (b"2 4 3 12", b"2 5 3 12", r"\$Nodes claims 5 nodes, and 4 follow"),
        (b"2 1 2 3", b"2 1 21 3", r"elements of Gmsh's type 21 are not read \(third order"),
        (b"7\n3\n12", b"7\n10\n12", r"node 10 is there twice"),
        (b"2 1 0 3", b"2 1 0 -3", r"\$Nodes claims -3 of something"),
        (b"4.1 0 8", b"4.2 0 8", r"is of version 4\.2, 2 and 4\.0 to 4\.1 are read; save it again"),
        (b"4.1 0 8", b"3.0 0 8", r"is of version 3\.0, 2 and"),
        (b"4.1 0 8", b"4.1 1 8", r"has no number 1 that tells the order of its bytes"),
        (b"4.1 0 8", b"new", r"has no version, file type and data size"),
        (b"$EndElements", b"", r"section \$Elements does not end; it was cut short"),
        (b"$Elements", b"$Parts", r"section \$Parts does not end|has no section \$Elements"),
        (b"0 1 0\n0 0 1", b"0 1 0\n0 0 nan", r"vertex 3: z is nan"),
    ],
)
def test_faults_are_told_with_their_line(old, new, fault):
    data = version_41_text()
    assert old in data

    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(data.replace(old, new, 1), ".msh")


@pytest.mark.parametrize("name", [b"Nodes", b"Elements"])
def test_second_sections_are_refused(name):
    data = version_41_text()
    start, end = data.index(b"$" + name), data.index(b"$End" + name) + len(name) + 5

    with pytest.raises(MeshError, match=rf":\d+: has a second section \${name.decode()}; merge"):
        load_mesh_bytes(data + data[start:end], ".msh")


def test_version_1_is_told_as_such():
    with pytest.raises(MeshError, match=r"is of Gmsh's version 1; save it again as version 4\.1"):
        load_mesh_bytes(b"$NOD\n1\n1 0 0 0\n$ENDNOD\n$EndNOD\n$ELM\n0\n$EndELM\n", ".msh")


@pytest.mark.parametrize("name", FILES)
def test_files_that_are_cut_short_are_refused(name):
    data = FILES[name]

    for size in range(1, len(data) - len(b"$EndElements\n") + 1, 7):
        with pytest.raises(MeshError):
            load_mesh_bytes(data[:size], ".msh")


@pytest.mark.parametrize("number", [2, 15])
def test_types_that_are_not_known_are_refused(number, monkeypatch):
    monkeypatch.delitem(gmsh._ELEMENTS, number)

    with pytest.raises(MeshError, match=f"elements of Gmsh's type {number} are not read"):
        load_mesh_bytes(version_41_text(), ".msh")
