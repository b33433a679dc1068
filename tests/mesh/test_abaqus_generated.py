"""Nodes and elements that a deck generates: values by hand from Abaqus' definitions."""

from __future__ import annotations

import numpy as np
import pytest
from mesh_files.abaqus_decks import deck

from obbcli.errors import MeshError
from obbcli.mesh.formats.abaqus import generated as abaqus_generated

SQUARE = "*NODE\n1, 0, 0, 0\n5, 4, 0, 2\n101, 0, 1, 0\n105, 4, 1, 2\n"
TRIANGLE = "*ELEMENT, TYPE=S3\n1, 1, {}, 101\n"


def test_ngen_divides_the_line_between_two_nodes():
    mesh = deck(f"{SQUARE}*NGEN, NSET=low\n1, 5, 2\n101, 105\n{TRIANGLE.format(103)}")

    corners = mesh.vertices[mesh.triangles[0]].tolist()
    assert corners == [[0, 0, 0], [2, 1, 1], [0, 1, 0]]
    generated = mesh.vertices[-7:].tolist()
    assert [2, 0, 1] in generated
    assert [[at, 1, at / 2] for at in (1, 2, 3)] == [row for row in generated if row[1:2] == [1]][
        1:4
    ]


@pytest.mark.parametrize("middle", ["7", ", 1, 1, 5"])
def test_ngen_divides_an_arc_about_a_node_or_a_place(middle):
    nodes = "*NODE\n1, 3, 1, 5\n4, 1, 3, 5\n7, 1, 1, 5\n"

    mesh = deck(
        f"{nodes}*NGEN, LINE=C, NSET=rim\n1, 4, 1, {middle}\n*ELEMENT, TYPE=S3\n1, 2, 3, 7\n"
    )

    # From angle 0 to 90 degrees at radius 2 about (1, 1, 5): at 30 and 60 degrees.
    half, root = 1, np.sqrt(3)
    expected = [[1 + root, 1 + half, 5], [1 + half, 1 + root, 5], [1, 1, 5]]
    np.testing.assert_allclose(mesh.vertices[mesh.triangles[0]], expected, atol=1e-15)


def test_ncopy_turns_several_times():
    copied = f"{SQUARE}*NSET, NSET=s\n5\n*NCOPY, CHANGE NUMBER=10, OLD SET=s, SHIFT, MULTIPLE=3\n"

    mesh = deck(f"{copied}1, 0, 0\n0, 0, 0, 0, 0, 1, 30\n{TRIANGLE.format(15)}")

    np.testing.assert_allclose(mesh.vertices[-1], [0, 5, 2], atol=1e-15)


def test_ngen_may_count_down():
    mesh = deck(f"{SQUARE}*NGEN\n5, 1, -1\n{TRIANGLE.format(4)}")

    assert mesh.vertices[mesh.triangles[0]].tolist()[1] == [3, 0, 1.5]


@pytest.mark.parametrize("sets", ["*NGEN, NSET=LOW\n1, 5\n*NGEN, NSET=HIGH\n101, 105\n", None])
def test_nfill_fills_between_two_sets(sets):
    sets = sets or "*NSET, NSET=Low\n5, 1\n*NSET, NSET=one\n101\n*NSET, NSET=High\none\n105,\n"

    mesh = deck(f"{SQUARE}{sets}*NFILL\nlow, high, 4, 25\n{TRIANGLE.format(80)}")

    assert mesh.vertices[mesh.triangles[0]].tolist()[1] == [4, 0.75, 2]


def test_nfill_keeps_the_order_of_unsorted_sets():
    sets = "*NSET, NSET=a\n1, 5\n*NSET, NSET=b, UNSORTED\n105, 101\n"

    mesh = deck(f"{SQUARE}{sets}*NFILL, NSET=all\na, b, 2, 50\n{TRIANGLE.format(51)}")

    # Half way from node 1 at (0, 0, 0) to node 105 at (4, 1, 2).
    assert mesh.vertices[mesh.triangles[0]].tolist()[1] == [2, 0.5, 1]


def test_sets_may_be_generated():
    sets = "*NSET, NSET=a, GENERATE\n1, 5, 4\n*NSET, NSET=b, GEN\n101, 105, 4\n"

    mesh = deck(f"{SQUARE}{sets}*NFILL\na, b, 2, 50\n{TRIANGLE.format(55)}")

    assert mesh.vertices[mesh.triangles[0]].tolist()[1] == [4, 0.5, 2]


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ("1, 2, 3", [5, 2, 5]),
        ("0, 0, 0\n1, 0, 0, 1, 0, 9, 90", [1, 3, 2]),
        # Moved first, then turned.
        ("1, 2, 3\n1, 0, 0, 1, 0, 9, 90", [-1, 4, 5]),
        ("\n0, 0, 0, 0, 0, 1, 180", None),
    ],
)
def test_ncopy_moves_or_turns_a_set(lines, expected):
    copied = f"{SQUARE}*NSET, NSET=s\n5\n*NCOPY, CHANGE NUMBER=10, OLD SET=s, SHIFT, NEW SET=t\n"
    text = f"{copied}{lines}\n{TRIANGLE.format(15)}"

    if expected is None:  # a line that is blank is none: seven numbers are no translation
        with pytest.raises(MeshError, match=r":10: \*NCOPY wants a translation and"):
            deck(text)
    else:
        np.testing.assert_allclose(deck(text).vertices[-1], expected, atol=1e-15)


GRID = "*NODE\n" + "".join(f"{1 + x + 10 * y}, {x}, {y}\n" for y in range(4) for x in range(5))
QUAD = "*ELEMENT, TYPE=S4, ELSET=first\n1, 1, 2, 12, 11\n"


def test_elgen_makes_rows_and_planes():
    mesh = deck(f"{GRID}{QUAD}*ELGEN, ELSET=all\n1, 4, 1, 1, 3, 10, 100\n")

    assert len(mesh.triangles) == 2 * 4 * 3
    assert mesh.bounds.tolist() == [[0, 0, 0], [4, 3, 0]]
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    assert np.cross(b - a, c - a)[:, 2].sum() / 2 == 12


def test_elgen_makes_layers():
    nodes = "".join(
        f"{1 + x + 10 * y + 100 * z}, {x}, {y}, {z}\n"
        for z in range(3)
        for y in range(3)
        for x in range(3)
    )
    brick = "*ELEMENT, TYPE=C3D8\n1, 1, 2, 12, 11, 101, 102, 112, 111\n"

    mesh = deck(f"*NODE\n{nodes}{brick}*ELGEN\n1, 2, 1, 1, 2, 10, 10, 2, 100, 100\n")

    # A block of 2 x 2 x 2: 24 squares outside.
    assert len(mesh.triangles) == 48
    assert mesh.is_watertight


def test_elements_without_surface_may_be_generated():
    bars = "*ELEMENT, TYPE=T3D2, ELSET=bars\n9, 1, 2\n*ELGEN\n9, 3, 1, 1\n"
    copies = "*ELCOPY, OLD SET=bars, ELEMENT SHIFT=50, SHIFT NODES=1\n"

    assert len(deck(GRID + QUAD + bars + copies).triangles) == 2


def test_elcopy_copies_a_set():
    copy = "*ELCOPY, OLD SET=first, ELEMENT SHIFT=10, SHIFT NODES=20, NEW SET=up\n"
    twice = "*ELCOPY, OLD SET=UP, ELEMENT SHIFT=10, SHIFT NODES=2\n"

    mesh = deck(GRID + QUAD + copy + twice)

    assert [sorted(row) for row in mesh.vertices[mesh.triangles[4:]][:, :, 0].tolist()] == [
        [2, 3, 3],
        [2, 2, 3],
    ]
    assert mesh.vertices[mesh.triangles[2:]][:, :, 1].min() == 2


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("*NGEN\n1, 7\n", r":7: \*NGEN uses node 7, which is not defined before it"),
        ("*NGEN\n1, 5, 3\n", r":7: \*NGEN from node 1 to 5 by steps of 3 meets no number"),
        ("*NGEN\n1, 5, 0\n", r":7: \*NGEN from node 1 to 5 by steps of 0"),
        ("*NGEN\n1\n", r":7: a number of \*NGEN is left out"),
        ("*NGEN\n1, 5, 1, 9\n", r":7: \*NGEN with 4 fields, at most 3 are read"),
        ("*NGEN, LINE=P\n1, 5, 1, 9\n", r":6: \*NGEN with LINE=P is not read; write the nodes"),
        ("*NGEN, LINE=C, SYSTEM=C\n1, 5, 1, 9\n", r":6: \*NGEN with the parameter SYSTEM is not"),
        ("*NGEN, LINE=C\n1, 5, 1, 9\n", r":7: \*NGEN uses node 9, which is not defined before"),
        ("*NGEN, LINE=C\n1, 5\n", r":7: \*NGEN without the middle of its circle is not read"),
        ("*NGEN, LINE=C\n1, 5, 1, 101\n", r":7: \*NGEN of an arc between radii 1 and "),
        ("*NGEN, LINE=C\n1, 5, 1, , 2, 0, 1\n", r":7: \*NGEN of an arc .*, or of 180 degrees"),
        ("*SYSTEM\n1,\n*NGEN, LINE=C\n1, 5, 1, , 2\n", r":9: \*NGEN within \*SYSTEM is not read"),
        (
            "*NGEN\n1, 100000005\n",
            ":7: .* makes 100000004 nodes or elements; a part may",
        ),
        ("*NFILL\na, b, 2, 1\n", r":7: \*NFILL names the set 'a', which is not defined"),
        ("*NFILL\n1, 5\n", r":7: \*NFILL wants two sets, intervals and an increment"),
        ("*NFILL, BIAS=0.5\n1, 5, 2, 1\n", r":6: \*NFILL with the parameter BIAS is not read"),
        ("*NFILL\n1, 5, 0, 1\n", r":7: \*NFILL between 1 and 1 nodes, in 0 intervals"),
        ("*NSET, NSET=a\n1, 5\n*NFILL\na, 5, 2, 1\n", ":9: .* between 2 and 1 nodes"),
        ("*NSET, NSET=a, ELSET=e\n*NFILL\na, 5, 2, 1\n", r":6: the set of \*NSET is used to gen"),
        ("*NSET, NSET=a\na\n*NFILL\na, 5, 2, 1\n", r":7: .*the set 'a', which is not defined"),
        ("*NSET, NSET=a, GENERATE\n5, 1\n*NFILL\na, 5, 2, 1\n", ":7: no numbers from 5 to 1 by 1"),
        ("*NCOPY, CHANGE NUMBER=1, OLD SET=a, POLE\n", r":6: \*NCOPY with the parameter POLE"),
        ("*NCOPY, CHANGE NUMBER=1, OLD SET=a\n", r":6: \*NCOPY without SHIFT is not read"),
        ("*NCOPY, CHANGE NUMBER=x, OLD SET=a, SHIFT\n", r":6: \*NCOPY: CHANGENUMBER 'X?x?' is not"),
        ("*ELGEN\n3, 2\n", r":7: \*ELGEN uses element 3, which is not defined before it"),
        ("*ELEMENT, TYPE=S3\n1, 1, 5, 101\n*ELGEN\n1, 2, 4, 1, 2\n", r":9: a number of \*ELGEN is"),
        ("*ELEMENT, TYPE=S3\n1, 1, 5, 101\n*ELGEN\n1, 0\n", r":9: \*ELGEN makes 0 nodes or"),
        ("*ELEMENT, TYPE=S3\n1, 1, 5, 101\n*ELGEN\n1, 99999999\n", ":9: .* makes 99999999 nodes"),
        ("*ELEMENT, TYPE=S3\n1, 1, 5, 101\n*ELGEN\n1, 2\n", ":9: element 2 uses node 2, which"),
        ("*ELCOPY, OLD SET=a, ELEMENT SHIFT=1, SHIFT NODES=1, REFLECT\n", "parameter REFLECT is"),
        ("*ELCOPY, OLD SET=a, ELEMENT SHIFT=1, SHIFT NODES=1\n", r":6: \*ELCOPY names the set 'A'"),
        ("*NGEN\n1, 9999999999999999\n", ":7: .* 10000000000000000 is too large"),
        ("*NGEN\n1, 5000000000\n", r":7: \*NGEN: 5000000000 is no number of a node or element"),
        ("*NFILL\n1, 5, 2, 5000000000\n", r":7: \*NFILL: 5000000000 is no number of a node"),
        ("*NFILL\n1, 99999999999999999999, 2, 1\n", ":7: .* 99999999999999999999 is no number"),
        (
            "*NCOPY, CHANGE NUMBER=99999999999999999999, OLD SET=1, SHIFT\n",
            r":6: \*NCOPY: 99999999999999999999 is no number of a node or element; they go up to",
        ),
    ],
)
def test_what_cannot_be_generated_is_refused_with_its_line(text, fault):
    with pytest.raises(MeshError, match=fault):
        deck(SQUARE + text)


def test_sets_that_name_each_other_end():
    names = "".join(f"*NSET, NSET=a{k}\na{k - 1}, a{k - 1}, a{k - 1}\n" for k in range(1, 60))

    mesh = deck(f"{SQUARE}*NSET, NSET=a0\n1\n{names}*NFILL\na59, 5, 2, 1\n{TRIANGLE.format(2)}")

    assert mesh.vertices[mesh.triangles[0]].tolist()[1] == [2, 0, 1]


def test_sets_nested_too_deep_are_refused():
    names = "".join(f"*NSET, NSET=a{k}\na{k - 1}\n" for k in range(1, 3000))

    with pytest.raises(MeshError, match=r":\d+: .*names the set 'a\d+', which is not defined"):
        deck(f"{SQUARE}*NSET, NSET=a0\n1\n{names}*NFILL\na2999, 5, 2, 1\n")


def test_a_part_does_not_generate_without_end(monkeypatch):
    monkeypatch.setattr(abaqus_generated, "_MOST", 10)
    triangle = "*ELEMENT, TYPE=S3\n1, 1, 5, 101\n*ELGEN\n"

    with pytest.raises(MeshError, match=r":11: \*ELGEN makes 4 nodes or elements; a part may have"):
        deck(f"{SQUARE}{triangle}1, 4, 0, 100\n1, 4, 0, 200\n1, 4, 0, 300\n")
