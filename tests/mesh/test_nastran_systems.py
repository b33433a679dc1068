"""Coordinate systems of Nastran decks: by hand, and against their definition in fifty digits."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from mesh_files.nastran_decks import grid, grids
from oracles.nastran import System, basic

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes

SHELL = "CTRIA3,1,1,1,2,3\n"
#: A, B and C of a system at 10 0 0 with axes x = y, y = z, z = x of the basic one.
TURNED = "10.,0.,0.,11.,0.,0.\n,10.,1.,0.\n"


def places(deck: str) -> list[list[float]]:
    return load_mesh_bytes(deck.encode("ascii"), ".bdf").vertices.tolist()


def test_a_rectangular_system_moves_and_turns():
    deck = f"CORD2R,5,0,{TURNED}" + grids([(1, 0, 0), (0, 2, 0), (0, 0, 3)], 5) + SHELL

    assert places(deck) == [[10, 1, 0], [10, 0, 2], [13, 0, 0]]


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ((2, 0, 0), [10, 2, 0]),
        ((2, 90, 1), [11, 0, 2]),
        ((2, 180, 0), [10, -2, 0]),
        ((2, -90, 0), [10, 0, -2]),
        ((2, 450, 0), [10, 0, 2]),
        ((2, 36000000270, 0), [10, 0, -2]),
        ((-2, 0, 0), [10, -2, 0]),
    ],
)
def test_a_cylindrical_system_has_radius_angle_in_degrees_and_height(place, expected):
    deck = f"CORD2C,5,0,{TURNED}" + grids([place, (0, 0, 0), (0, 0, 1)], 5) + SHELL

    assert places(deck)[0] == expected


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ((2, 0, 0), [12, 0, 0]),
        ((2, 90, 0), [10, 2, 0]),
        ((2, 90, 90), [10, 0, 2]),
        ((2, 180, 77), [8, 0, 0]),
        ((2, 90, 180), [10, -2, 0]),
    ],
)
def test_a_spherical_system_has_radius_angle_from_z_and_azimuth(place, expected):
    deck = f"CORD2S,5,0,{TURNED}" + grids([place, (0, 0, 0), (1, 90, 1)], 5) + SHELL

    assert places(deck)[0] == expected


@pytest.mark.parametrize("kind", "RCS")
def test_a_system_by_grids_is_the_one_by_their_places(kind):
    corners = [(10.0, 0.0, 0.0), (11.0, 0.0, 0.0), (10.0, 1.0, 0.0)]
    points = grids([(1.0, 30.0, 2.0), (2.0, 60.0, 1.0), (1.5, 45.0, 0.5)], 5)
    by_points = f"CORD2{kind},5,0,{TURNED}"
    by_grids = grids(corners, first=11) + f"CORD1{kind},9,13,12,11,5,11,12,13\n"

    assert places(points + by_grids + SHELL)[:3] == places(points + by_points + SHELL)


def test_systems_may_come_after_what_stands_in_them_and_chain_through_grids():
    # System 2 stands in cylindrical 1, whose own GRIDs stand in rectangular 3.
    deck = (
        grids([(0, 0, 0), (1, 0, 0), (0, 1, 0)], 2)
        + "CORD2R,2,1,0.,0.,0.,0.,0.,1.\n,1.,90.,0.\n"
        + "CORD1C,1,11,12,13\n"
        + grids([(0, 0, 0), (0, 0, 1), (1, 0, 0)], 3, first=11)
        + "CORD2R,3,,5.,0.,0.,5.,0.,1.\n,6.,0.,0.\n"
        + SHELL
    )

    # The x axis of 2 goes toward the angle of 90 degrees: the basic y.
    assert places(deck)[:3] == [[5, 0, 0], [5, 1, 0], [4, 0, 0]]


def test_grdset_gives_the_system_of_grids_that_name_none_and_zero_is_the_basic_one():
    deck = f"GRDSET,,5\nCORD2R,5,0,{TURNED}" + grid(1, (1, 0, 0)) + grid(2, (1, 0, 0), 0)

    assert places(deck + grid(3, (1, 0, 0), 5) + SHELL) == [[10, 1, 0], [1, 0, 0], [10, 1, 0]]


def test_other_systems_do_no_harm_where_no_grid_stands_in_them():
    deck = "CORD3G,7,E313,EQN,1\n" + grids([(0, 0, 0), (1, 0, 0), (0, 1, 0)]) + SHELL

    assert places(deck) == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def _written(systems, points) -> str:
    """Return a deck of systems and GRIDs, with all digits."""
    deck = ""
    for number, system in systems.items():
        fields = [repr(float(x)) for point in system.points for x in point]
        deck += f"CORD2{system.kind},{number},{system.reference},{','.join(fields[:6])}\n"
        deck += f",{','.join(fields[6:])}\n"
    for number, (system, place) in points.items():
        deck += grid(number, place, system)
    return deck + SHELL


def _place(source: random.Random, kind: str) -> tuple[float, float, float]:
    u, v, w = (source.uniform(-5, 5) for _ in range(3))
    if kind == "C":
        return abs(u), 100 * v, w
    return (abs(u), 36 * abs(v), 100 * w) if kind == "S" else (u, v, w)


@pytest.mark.parametrize("seed", range(15))
def test_chains_of_systems_agree_with_their_definition_in_fifty_digits(seed):
    source = random.Random(seed)
    systems: dict[int, System] = {}
    for number in range(1, 6):
        reference = source.choice([0, *systems])
        above = systems[reference].kind if reference else "R"
        points = tuple(_place(source, above) for _ in range(3))
        systems[number] = System(source.choice("RCS"), reference, points)
    points = {
        number: (system := source.choice(list(systems)), _place(source, systems[system].kind))
        for number in range(1, 30)
    }

    found = places(_written(systems, points))

    for row, (system, place) in zip(found, points.values(), strict=True):
        exact = [float(x) for x in basic(systems, system, place)]
        # Five systems of numbers up to 5; no angle at A is smaller than those drawn here.
        assert np.allclose(row, exact, rtol=0, atol=2e-13)


def test_nodes_at_one_place_stay_at_one_place():
    deck = f"CORD2C,5,0,{TURNED}" + grids([(1, 30, 0), (1, 390, 0), (1, -330, 0)], 5) + SHELL

    first, *others = places(deck)

    assert others == [first, first]
    assert math.dist(first, (10, math.sqrt(0.75), 0.5)) < 1e-15


@pytest.mark.parametrize(
    ("cards", "fault"),
    [
        ("", r":4: coordinate system 5 is not in the deck; add its CORD card"),
        ("CORD2R,5,6\n,1.\n", r":1: coordinate system 6 is not in the deck"),
        ("CORD2R,5,5,0.,0.,0.,0.,0.,1.\n,1.\n", r":1: coordinate system 5 is defined by itself"),
        (
            "CORD2R,5,6,0.,0.,0.,0.,0.,1.\n,1.\nCORD2R,6,5,0.,0.,0.,0.,0.,1.\n,1.\n",
            r":3: coordinate system 6 is defined by itself; define one of the circle by points",
        ),
        ("CORD1R,5,2,3,4\n", r":1: coordinate system 5 is defined by itself"),
        ("CORD1R,5,2,3,99\n", r":1: names GRID 99, which is not in the deck"),
        ("CORD1R,5,2,3\n", r":1: CORD1R needs a number above 0 and three GRIDs"),
        ("CORD2R,5,0,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\n", r":1: the three points .* on one line"),
        ("CORD2R,5,0,1.,1.,1.,1.,1.,1.\n,0.,0.,2.\n", r":1: the three points .* on one line"),
        ("CORD2R,5,0,0.,0.,x,0.,0.,1.\n,1.\n", r":1: CORD2R has 'X', expected a coordinate"),
        ("CORD2R,0,0,0.,0.,0.,0.,0.,1.\n,1.\n", r":1: CORD2R has '0', expected a number above 0"),
        ("CORD2R,5,1.,0.,0.,0.,0.,0.,1.\n,1.\n", r":1: CORD2R has '1.', expected the number of a"),
        (
            "CORD2R,5,,0.,0.,0.,0.,0.,1.\n,1.\nCORD2C,5,,0.,0.,0.,0.,0.,1.\n,1.\n",
            r":3: coordinate system 5 is another one than at <stdin>:1; give each system",
        ),
        ("CORD3R,5,1,2,3\n", r":1: coordinate system 5 is of a kind that is not read"),
        ("GRDSET,,5\nGRDSET,,6\n", r":2: a second GRDSET names another system"),
    ],
)
def test_systems_that_cannot_be_resolved_are_refused(cards, fault):
    deck = cards + grids([(0, 0, 0), (1, 0, 0), (0, 1, 0)]) + grid(4, (0, 0, 0), 5) + SHELL

    with pytest.raises(MeshError, match=fault):
        places(deck)


def test_a_long_chain_of_systems_is_resolved():
    chain = "".join(f"CORD2R,{k + 1},{k},1.,0.,0.,1.,0.,1.\n,2.,0.,0.\n" for k in range(3000))
    deck = chain + grid(1, (0, 0, 0), 3000) + grid(2, (1, 0, 0)) + grid(3, (0, 1, 0)) + SHELL

    assert places(deck)[0] == [3000, 0, 0]
