"""What of VTK's files is walked before a library reads them: each keyword and element is known."""

from __future__ import annotations

import base64
import struct
import zlib

import numpy as np
import pytest

from obbcli.errors import MeshError
from obbcli.mesh.formats.vtk import legacy_guard as vtk_legacy_guard
from obbcli.mesh.formats.vtk import legacy_values as vtk_legacy_values
from obbcli.mesh.formats.vtk import xml_walk as vtk_xml_walk
from obbcli.mesh.formats.vtk.legacy_guard import walk_legacy
from obbcli.mesh.formats.vtk.xml_guard import walk_xml
from obbcli.mesh.source import Source

HEAD = "# vtk DataFile Version {}\nmade by hand\nASCII\n"
GRID = """FIELD FieldData 2
TIME 1 1 double
0.5
names 2 3 int
1 2 3 4 5 6
METADATA
INFORMATION 0

DATASET UNSTRUCTURED_GRID
POINTS 4 float
0 0 0 1 0 0 0 1 0
nan 1e3 -Inf
METADATA
INFORMATION 1
NAME L2_NORM_RANGE LOCATION vtkDataArray
DATA 2 0 1.5

"""
CELLS = "CELLS 2 7\n3 0 1 2 2 0 1\nCELL_TYPES 2\n5\n3\n"
CELLS_51 = (
    "CELLS 3 5\nOFFSETS vtktypeint64\n0 3 5\nCONNECTIVITY vtktypeint64\n0 1 2 0 1\n"
    "CELL_TYPES 2\n5\n3\n"
)
AFTER = "POINT_DATA 4\nSCALARS any float\nLOOKUP_TABLE default\n1 2 3 4\nanything at all\n"
LEGACY = {
    "grid": HEAD.format("3.0") + GRID + CELLS + AFTER,
    "grid 5.1": HEAD.format("5.1") + GRID + CELLS_51 + AFTER,
    "surface": HEAD.format("3.0")
    + "DATASET POLYDATA\nPOINTS 3 double\n0 0 0 1 0 0 0 1 0\nVERTICES 1 2\n1 0\nLINES 1 3\n2 0 1\n"
    "POLYGONS 1 4\n3 0 1 2\nTRIANGLE_STRIPS 1 4\n3 0 1 2\n",
    "image": HEAD.format("3.0")
    + "DATASET STRUCTURED_POINTS\nDIMENSIONS 2 3 1\nORIGIN 0 0 0\nSPACING 1 1 1\n",
    "structured": HEAD.format("3.0")
    + "DATASET STRUCTURED_GRID\nDIMENSIONS 2 1 1\nPOINTS 2 int\n0 0 0 1 0 0\n",
    "rectilinear": HEAD.format("3.0")
    + "DATASET RECTILINEAR_GRID\nDIMENSIONS 2 1 1\nX_COORDINATES 2 float\n0 1\n"
    "Y_COORDINATES 1 float\n0\nZ_COORDINATES 1 float\n0\n",
}
COUNTS = {
    "grid": (4, 2),
    "grid 5.1": (4, 2),
    "surface": (3, 4),
    "image": (6, 2),
    "structured": (2, 1),
    "rectilinear": (2, 1),
}


def walked(text):
    return walk_legacy(Source("x", "x", text.encode() if isinstance(text, str) else text))


@pytest.mark.parametrize("ends", ["\n", "\r\n"])
@pytest.mark.parametrize("name", LEGACY)
def test_legacy_files_are_counted(name, ends):
    found = walked(LEGACY[name].replace("\n", ends))

    assert (found.point_count, found.cell_count) == COUNTS[name]


def test_attributes_are_cut_off():
    text = LEGACY["grid"]

    assert text[walked(text).end :] == AFTER


@pytest.mark.parametrize(
    ("name", "word"),
    [
        *(("grid", word) for word in ("CELLS",)),
        *(("surface", word) for word in ("VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS")),
    ],
)
def test_lists_of_cells_that_are_not_known_are_refused(name, word, monkeypatch):
    monkeypatch.setattr(vtk_legacy_guard, "_CELLS", vtk_legacy_guard._CELLS - {word.lower()})

    with pytest.raises(MeshError, match=f"'{word.lower()}' is nothing that "):
        walked(LEGACY[name])


@pytest.mark.parametrize(("name", "kind"), [("grid", "float"), ("surface", "double")])
def test_types_of_values_that_are_not_known_are_refused(name, kind, monkeypatch):
    monkeypatch.delitem(vtk_legacy_values.KINDS, kind)

    with pytest.raises(MeshError, match=f"type {kind} "):
        walked(LEGACY[name])


@pytest.mark.parametrize(
    ("name", "old", "new", "fault"),
    [
        ("grid 5.1", "0 3 5", "0 4 3", r":24: offsets of CELLS do not fit its 5 points"),
        ("grid 5.1", "0 3 5", "1 3 5", r"offsets of CELLS do not fit"),
        ("grid 5.1", "0 3 5", "0 3 4", r"offsets of CELLS do not fit"),
        ("grid 5.1", "CONNECTIVITY", "POINTS", r"found 'points', expected CONNECTIVITY"),
        ("grid", "names 2 3 int", "names 2 4 int", r":7: 8 numbers are claimed, and 6 follow"),
        ("grid", "names 2 3 int", "names 2 3 string", r"values of type string|type string is"),
        ("grid", "CELL_TYPES 2\n5\n3", "", r"claims 2 cells and 0 types of them"),
        ("image", "2 3 1", "2 -3 1", r":5: claims -3 of something"),
        ("structured", "2 1 1", "3 1 1", r"DIMENSIONS do not fit its points"),
        ("structured", "DIMENSIONS 2 1 1\n", "", r"is a grid without DIMENSIONS"),
        ("rectilinear", "2 1 1", "1 2 1", r"DIMENSIONS do not fit its points"),
        ("rectilinear", "X_COORDINATES", "W_COORDINATES", r"'w_coordinates' is nothing that REC"),
        ("surface", "DATASET POLYDATA", "", r":5: 'points' is nothing that a file without DATA"),
        ("surface", "DATASET POLYDATA", "DATASET TABLE", r"DATASET TABLE is not read; export its"),
        ("surface", "# vtk", "# vtx", r"does not begin with '# vtk DataFile Version' and a title"),
    ],
)
def test_faults_of_legacy_files_are_told_with_their_line(name, old, new, fault):
    assert old in LEGACY[name]

    with pytest.raises(MeshError, match=fault):
        walked(LEGACY[name].replace(old, new, 1))


def test_binary_legacy_files_are_walked_by_bytes():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], ">f4").tobytes()
    cells = struct.pack(">4i", 3, 0, 1, 2)
    head = HEAD.format("3.0").replace("ASCII", "BINARY").encode()
    data = head + b"DATASET POLYDATA\nPOINTS 3 float\n" + points + b"\nPOLYGONS 1 4\n" + cells

    found = walked(data)

    assert (found.point_count, found.cell_count) == (3, 1)
    for size in range(data.index(b" float\n"), len(data)):
        if size - data.index(b"\nPOLYGONS") not in (0, 1):  # where no list begins, and none ends
            with pytest.raises(MeshError):
                walked(data[:size])


def array(values, kind, name, form="ascii", header="<u4"):
    """Return a DataArray of a VTK XML file."""
    attributes = f'type="{kind}" Name="{name}" format="{form.split()[0]}"'
    if name == "Points":
        attributes += ' NumberOfComponents="3"'
    if form == "ascii":
        return f"<DataArray {attributes}>{' '.join(map(str, values))}</DataArray>"
    number = {"Float32": "<f4", "Int64": "<i8", "UInt8": "u1", "Int32": "<i4"}[kind]
    content = np.array(values, number).tobytes()
    size = np.dtype(header).type
    if form == "binary":
        text = base64.b64encode(size(len(content)).tobytes() + content)
    else:
        packed = zlib.compress(content)
        numbers = np.array([1, len(content), 0, len(packed)], header).tobytes()
        text = base64.b64encode(numbers) + base64.b64encode(packed)
    return f"<DataArray {attributes}>{text.decode()}</DataArray>"


def xml(form="ascii", packed="", **other):
    """Return a grid of two triangles."""
    values = {
        "Points": [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0],
        "connectivity": [0, 1, 2, 0, 2, 3],
        "offsets": [3, 6],
        "types": [5, 5],
    } | other
    compressor = ' compressor="vtkZLibDataCompressor"' if packed else ""
    cells = "".join(
        array(values[name], kind, name, packed or form)
        for name, kind in (("connectivity", "Int64"), ("offsets", "Int32"), ("types", "UInt8"))
    )
    return (
        f'<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"{compressor}>\n'
        "<UnstructuredGrid><FieldData><Odd/></FieldData>\n"
        '<Piece NumberOfPoints="4" NumberOfCells="2">\n'
        f"<PointData><Anything><At/></Anything></PointData>\n"
        f"<Points>{array(values['Points'], 'Float32', 'Points', packed or form)}</Points>\n"
        f"<Cells>{cells}</Cells>\n</Piece></UnstructuredGrid></VTKFile>\n"
    )


@pytest.mark.parametrize(("form", "packed"), [("ascii", ""), ("binary", ""), ("", "binary packed")])
def test_xml_files_are_counted(form, packed):
    found = walk_xml(Source("x", "x", xml(form, packed).encode()))

    assert found[:4] == ("UnstructuredGrid", 1, 4, 2)
    assert b"Odd" not in found.text


@pytest.mark.parametrize(
    "word", ["Piece", "Points", "Cells", "DataArray", "UnstructuredGrid", "PointData"]
)
def test_elements_that_are_not_known_are_refused(word, monkeypatch):
    inside = {parent: names - {word} for parent, names in vtk_xml_walk._INSIDE.items()}
    monkeypatch.setattr(vtk_xml_walk, "_INSIDE", inside)

    with pytest.raises(MeshError, match=rf":\d: <{word}> is nothing that <\w+> has; remove it"):
        walk_xml(Source("x", "x", xml().encode()))


@pytest.mark.parametrize("form", [("ascii", ""), ("binary", ""), ("", "binary packed")])
@pytest.mark.parametrize(
    ("other", "fault"),
    [
        ({"offsets": [3, 7]}, r"offsets of <Cells> do not fit 6 points"),
        ({"offsets": [6, 3]}, r"offsets of <Cells> do not fit"),
        ({"offsets": [3]}, r"array 'offsets' has 1 values, not 2"),
        ({"types": [5]}, r"array 'types' has 1 values, not 2"),
        ({"Points": [0] * 11}, r"array 'Points' has 11 values, not 12"),
    ],
)
def test_arrays_are_held_against_the_counts_of_their_piece(form, other, fault):
    with pytest.raises(MeshError, match=fault):
        walk_xml(Source("x", "x", xml(*form, **other).encode()))


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ('OfPoints="4"', 'OfPoints="-4"', r":3: NumberOfPoints is '-4', which the file cannot"),
        ('OfPoints="4"', 'OfPoints="4e9"', r"NumberOfPoints is '4e9'"),
        ('OfPoints="4"', f'OfPoints="{10**17}"', r"NumberOfPoints is '1000"),
        ('Components="3"', 'Components="4"', r":5: array 'Points' has 4 components"),
        ('Name="types"', 'Name="kinds"', r"<Cells> has an array 'kinds', which is not read"),
        ('"UnstructuredGrid" v', '"Table" v', r":1: holds a 'Table', which is not read"),
        ("<UnstructuredGrid>", "<PolyData>", r"holds <PolyData>, but says that it is Unstr"),
        ("</Piece>", "", r"is no whole XML: mismatched tag; it was cut short"),
        ("<VTKFile", "<!DOCTYPE a><VTKFile", r"declares a document type; remove the"),
        ('type="Float32"', 'type="Float16"', r"array 'Points' is of a type that is not read"),
        ('format="ascii"', 'format="appended"', r"lies in appended data, and there are none"),
        ("0 1 2 0 2 3", "0 1 2 0 2 x", r"array 'connectivity' holds a word that is no number"),
    ],
)
def test_faults_of_xml_files_are_told_with_their_line(old, new, fault):
    assert old in xml()

    with pytest.raises(MeshError, match=fault):
        walk_xml(Source("x", "x", xml().replace(old, new, 1).encode()))


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        (
            'WholeExtent="0 1 0 2 0 0"',
            'WholeExtent="0 9 0 2 0 0"',
            r"WholeExtent has 18 cells, and",
        ),
        ('WholeExtent="0 1 0 2 0 0"', "", r"has no WholeExtent of six whole numbers"),
        (
            'Extent="0 1 0 2 0 0"><',
            f'Extent="0 {10**8} 0 2 0 0"><',
            r"is a grid of 100000001 x 3 x 1",
        ),
        ('Spacing="1 1 1"', 'Spacing="1 nan 1"', r":2: Spacing is not 3 numbers"),
        ('Origin="0 0 0"', 'Origin="0 0"', r":2: Origin is not 3 numbers"),
    ],
)
def test_extents_of_grids_are_held_against_their_pieces(old, new, fault):
    text = (
        '<VTKFile type="ImageData" version="0.1" byte_order="LittleEndian">\n'
        '<ImageData WholeExtent="0 1 0 2 0 0" Origin="0 0 0" Spacing="1 1 1">'
        '<Piece Extent="0 1 0 2 0 0"></Piece></ImageData></VTKFile>\n'
    )
    assert walk_xml(Source("x", "x", text.encode()))[:4] == ("ImageData", 1, 6, 2)
    assert old in text

    with pytest.raises(MeshError, match=fault):
        walk_xml(Source("x", "x", text.replace(old, new, 1).encode()))


def test_packed_sizes_beyond_the_file_are_refused_before_they_are_taken():
    text = xml("", "binary packed")
    start = text.index(">", text.index('Name="Points"')) + 1
    numbers = np.array([2**28, 2**31, 0, 5], "<u4").tobytes()
    changed = text[:start] + base64.b64encode(numbers).decode() + text[start + 24 :]

    with pytest.raises(MeshError, match="array 'Points' claims 268435456 blocks"):
        walk_xml(Source("x", "x", changed.encode()))


def test_values_that_are_not_packed_in_a_known_way_are_refused():
    text = xml("", "binary packed").replace("vtkZLibDataCompressor", "vtkOtherCompressor")

    with pytest.raises(MeshError, match="array 'Points' is packed by vtkOtherCompressor"):
        walk_xml(Source("x", "x", text.encode()))
