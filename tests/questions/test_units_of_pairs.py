"""Two files that state different units are refused, whatever is asked of them and however."""

from __future__ import annotations

import pytest

import obbcli
from obbcli import Body, Mesh, MeshError, Motion, ObbTree, Pose

CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]

KINDS = {
    "mesh": lambda mesh: mesh,
    "tree": ObbTree.build,
    "file": lambda mesh: ObbTree.from_bytes(ObbTree.build(mesh).to_bytes()),
    "body": lambda mesh: Body(ObbTree.build(mesh)),
    "placed": lambda mesh: Body(ObbTree.build(mesh), Pose(translation=[3, 0, 0])),
    "moving": lambda mesh: Body(ObbTree.build(mesh), motion=Motion([1, 0, 0])),
}
ASK = {
    "collide": obbcli.collide,
    "first_contact": obbcli.first_contact,
    "distance": obbcli.distance,
    "contacts": lambda a, b: list(obbcli.contacts(a, b)),
    "triangle_pairs": obbcli.triangle_pairs,
    "triangle_pair_blocks": lambda a, b: list(obbcli.triangle_pair_blocks(a, b)),
    "Query": obbcli.Query,
    "Scene": lambda a, b: list(obbcli.Scene({"A": a, "B": b}).first_contacts()),
    "sweep": lambda a, b: obbcli.sweep(a, b, None),
}


def mesh(unit):
    return Mesh(CORNERS, FACES, unit=unit)


@pytest.mark.parametrize("ask", ASK)
@pytest.mark.parametrize("kind", KINDS)
def test_different_units_are_refused(ask, kind):
    a, b = (KINDS[kind](mesh(unit)) for unit in ("m", "mm"))

    with pytest.raises(MeshError, match=r"unit: A is in m, B in mm; bring both to one: .*in_unit"):
        ASK[ask](a, b)


@pytest.mark.parametrize("units", [("m", "m"), ("m", None), (None, "mm"), (None, None)])
@pytest.mark.parametrize("ask", ASK)
@pytest.mark.parametrize("kind", KINDS)
def test_other_units_are_taken(ask, kind, units):
    a, b = (KINDS[kind](mesh(unit)) for unit in units)
    bare = [KINDS[kind](mesh(None)) for _ in range(2)]

    found, wanted = ASK[ask](a, b), ASK[ask](*bare)

    if ask in ("collide", "first_contact"):
        assert found.status is wanted.status
