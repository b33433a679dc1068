"""Tecplot files that are refused: each error names the line, what was found, and what to do."""

from __future__ import annotations

import pytest

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes

TEXT = """VARIABLES = "X", "Y", "Z"
ZONE T="a", N=3, E=1, F=FEPOINT, ET=TRIANGLE
0 0 0
1 0 0
0 1 0
1 2 3
"""
ZONE = "ZONE" + TEXT.partition("ZONE")[2]


def tecplot(text):
    return load_mesh_bytes(text.encode(), ".dat")


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("1 2 3\n", "1 2 4\n", ":2: a cell uses point 4 of 3; points are counted from 1 in each"),
        ("1 2 3\n", "1 2 0\n", ":2: a cell uses point 0 of 3"),
        ("1 2 3\n", "1 2 2.5\n", ":2: a cell uses point 2.5 of 3"),
        ("1 2 3\n", "1 2\n", ":2: the zone has 11 numbers, 12 wanted; it was cut short"),
        ("1 2 3\n", "1 2 3 1\n", ":2: the zone has 13 numbers or more, 12 wanted; correct its"),
        ("0 1 0\n", "0 x 0\n", ":5: 'x' is not a number"),
        ("0 1 0\n", "0 1_0 0\n", ":5: '1_0' is not a number"),
        ("0 1 0\n", "nan 1 0\n", ":2: point 3 is not finite; coordinates must be finite"),
        ("0 1 0\n", "9*0 1 0\n", ":2: the zone has 20 numbers or more, 12 wanted"),
        ("0 1 0\n", "99999999999999*0\n", ":5: '99999999999999[*]0' repeats more numbers than"),
        ("N=3, ", "", ":2: the zone has no NODES or N; write its counts"),
        ("N=3", "N=4000000000", ":2: NODES or N=4000000000, but the file has"),
        ("N=3", "N=-3", ":2: NODES or N=-3, but the file has"),
        ("N=3", "N=" + "1" * 5000, ":2: NODES or N=1.*, but the file has"),
        ("N=3", "Q=1, N=3", ":2: the key Q of a zone is not known; remove it if it says nothing"),
        ("N=3", "N=3 point", ":2: 'point,' in the words of a zone; write KEY = VALUE, then"),
        ("ET=TRIANGLE", "ET=PRISM", ":2: a zone of type FEPRISM is not read; save it as tri"),
        ("ET=TRIANGLE", "ZONETYPE=FEPOLYGON", ":2: a zone of type FEPOLYGON is not read"),
        ("ET=TRIANGLE", "ZONETYPE=FEPOLYHEDRON", ":2: a zone of type FEPOLYHEDRON is not read"),
        (", ET=TRIANGLE", "", ":2: a zone of type FEPOINT is not read"),
        ("F=FEPOINT", "F=FEROW", ":2: the packing FEROW is not known; POINT or BLOCK"),
        ("F=FEPOINT, ", "", ":2: the zone names no DATAPACKING; write DATAPACKING=POINT or BLOCK"),
        ("F=FEPOINT", "F=FEPOINT VARLOCATION=([3]=CELLCENTERED)", ":2: values at cell centres in"),
        ("F=FEPOINT", "VARLOCATION=([4]=NODAL)", ":2: .* is no list of variables; write it as"),
        ("F=FEPOINT", "VARLOCATION=([1-x]=NODAL)", ":2: VARLOCATION=.* is no list of variables"),
        ("F=FEPOINT", "VARLOCATION=([1,1]=NODAL)", ":2: VARLOCATION=.* is no list of variables"),
        ("F=FEPOINT", "VARLOCATION=([1]=THERE)", ":2: VARLOCATION=.* is no list of variables"),
        ("F=FEPOINT", "VARSHARELIST=([1]=1)", ":2: a zone shares what zone '1' has, which does"),
        ("F=FEPOINT", "D=(1)", ":2: a zone shares what zone '' has, which does not stand before"),
        ("F=FEPOINT", "F=FEPOINT, CONNECTIVITYSHAREZONE=1", ":2: the zone has 12 numbers or more"),
        (
            ZONE,
            "",
            " has no ZONE, which a mesh in a Tecplot file has; a Tecplot file has VARIABLES",
        ),
        ("VARIABLES", "FILETYPE = SOLUTION\nVARIABLES", ":1: is a Tecplot solution, whose grid"),
        ('"X"', '"U"', ":2: no variable or more than one is X, of U, Y, Z; call the coordinates"),
        ('"Z"', '"x"', ":2: no variable or more than one is X, of X, Y, x"),
        ('"Z"', '"Zc"', ":2: no variable or more than one is Z, of X, Y, Zc; call the"),
        (
            TEXT,
            TEXT.replace("TRIANGLE", "TETRAHEDRON")
            .replace('"Z"', '"P"')
            .replace("1 2 3", "1 2 3 3"),
            ":2: a zone of volumes has no variable Z",
        ),
        (TEXT, f'{TEXT}VARIABLES="X" "Y"\n{ZONE}', ":7: VARIABLES change after the first zone"),
        (
            ZONE,
            "ZONE N=3, E=1, F=FEPOINT, ET=LINESEG\n0 0 0\n1 1 1\n2 2 2\n1 2\n",
            " has no surface: 1 zone of points and lines, no face",
        ),
        (
            ZONE,
            ZONE.replace("N=3", "VARLOCATION=([3]=CELLCENTERED), N=3")
            .replace("POINT", "BLOCK")
            .replace("0 1 0", "0"),
            ":2: coordinates are not given at the points",
        ),
        (
            ZONE,
            ZONE.replace("N=3", "PASSIVEVARLIST=[3], N=3").replace("0 1 0\n", ""),
            ":2: coordinates are not g",
        ),
        (
            TEXT,
            TEXT + ZONE.replace("N=3", "VARSHARELIST=([1-3]=1), N=4").split("0 0 0")[0] + "1 2 3\n",
            ":7: a zone of 4 points shares 3 coordinates",
        ),
        (
            TEXT,
            TEXT + ZONE.replace("E=1", "E=2, CONNECTIVITYSHAREZONE=1").replace("1 2 3\n", ""),
            ":7: a zone shares the connectivity of one of another size or type",
        ),
        (
            TEXT,
            TEXT + ZONE.replace("E=1", "E=1, CONNECTIVITYSHAREZONE=2").replace("1 2 3\n", ""),
            ":7: CONNECTIVITYSHAREZONE=2 is no zone before it",
        ),
        (
            TEXT,
            TEXT.replace("N=3", "STRANDID=1, SOLUTIONTIME=0, N=3")
            + ZONE.replace("N=3", "STRANDID=1, SOLUTIONTIME=1, N=3").replace("0 1 0", "0 2 0"),
            ":7: the mesh of strand 1 differs between solution times; save one solution time",
        ),
    ],
)
def test_files_are_refused_with_line_and_remedy(old, new, fault):
    assert old in TEXT

    with pytest.raises(MeshError, match=rf"^<stdin>:?{fault}"):
        tecplot(TEXT.replace(old, new, 1))


@pytest.mark.parametrize("suffix", [".plt", ".dat", ".tec"])
@pytest.mark.parametrize("magic", [b"#!TDV112", b"#!SZPLT "])
def test_binary_files_are_refused_by_name(suffix, magic):
    with pytest.raises(MeshError, match="is a binary Tecplot file, which is not read; save it as"):
        load_mesh_bytes(magic + bytes(100), suffix)


def test_a_grid_that_could_be_packed_either_way_is_refused():
    rows = "0 0 0\n1 0 0\n1 1 0\n"

    with pytest.raises(MeshError, match="names no DATAPACKING"):
        tecplot(TEXT.replace("F=FEPOINT, ", ""))
    with pytest.raises(MeshError, match="names no DATAPACKING"):
        tecplot(f'VARIABLES="X" "Y" "Z"\nZONE I=3, J=3\n{rows.replace(chr(10), " ")}{rows * 2}')


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_a_file_cut_short_is_refused(end):
    text = (TEXT + ZONE).replace("\n", end)
    for size in range(1, len(text) - len(end)):
        try:
            mesh = tecplot(text[:size])
        except MeshError:
            continue
        assert len(mesh.triangles) == 1
