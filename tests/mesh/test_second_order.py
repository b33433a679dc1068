"""Second-order cells as flat pieces through all their nodes, against hand-made values and laws."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from mesh_files.cell_files import write

from obbcli.mesh import Mesh, load_mesh
from obbcli.mesh.formats.cells import surface as cell_surface
from obbcli.mesh.formats.cells.surface import Block
from obbcli.mesh.formats.cells.types import CELLS
from obbcli.mesh.source import Source

#: Corners of each linear type, counter-clockwise from below where it has a base.
CORNERS = {
    "triangle": [(0, 0, 0), (1, 0, 0), (0, 1, 0)],
    "quad": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
    "tetra": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    "pyramid": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)],
    "wedge": [(0, 0, 0), (0, 1, 0), (1, 0, 0), (0, 0, 1), (0, 1, 1), (1, 0, 1)],
    "hexahedron": [
        *((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)),
        *((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)),
    ],
}
#: Which corners each further node lies between: VTK's book, not our table.
BETWEEN = {
    "triangle6": [(0, 1), (1, 2), (2, 0)],
    "triangle7": [(0, 1), (1, 2), (2, 0), (0, 1, 2)],
    "quad6": [(0, 1), (2, 3)],
    "quad8": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "quad9": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 1, 2, 3)],
    "tetra10": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
    "pyramid13": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)],
    "wedge12": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)],
    "wedge15": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    "hexahedron20": [
        *((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)),
        *((0, 4), (1, 5), (2, 6), (3, 7)),
    ],
}
BETWEEN["pyramid14"] = [*BETWEEN["pyramid13"], (0, 1, 2, 3)]
BETWEEN["pyramid19"] = [
    *BETWEEN["pyramid14"],
    *((0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (0, 1, 2, 3, 4)),
]
BETWEEN["wedge18"] = [*BETWEEN["wedge15"], (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]
BETWEEN["hexahedron24"] = [
    *BETWEEN["hexahedron20"],
    *((0, 3, 4, 7), (1, 2, 5, 6), (0, 1, 4, 5), (2, 3, 6, 7)),
]
BETWEEN["hexahedron27"] = [
    *BETWEEN["hexahedron24"],
    *((0, 1, 2, 3), (4, 5, 6, 7), tuple(range(8))),
]
VOLUME_OF = {"tetra": 1 / 6, "pyramid": 1 / 3, "wedge": 1 / 2, "hexahedron": 1.0}


def base(kind):
    return kind.rstrip("0123456789")


def nodes(kind):
    """Return the nodes of one straight cell, the further ones in the middle of their corners."""
    corners = np.array(CORNERS[base(kind)], dtype=float)
    further = [corners[list(between)].mean(axis=0) for between in BETWEEN[kind]]
    return np.vstack([corners, *further])


def surface(points, *blocks):
    source = Source("x", "x", b"")
    triangles = cell_surface.surface(source, points, [Block(*block) for block in blocks])
    return triangles, source.notes


def volume(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def row_of(kind):
    return np.arange(CELLS[kind].node_count).reshape(1, -1)


def test_every_type_of_second_order_is_tried():
    assert set(BETWEEN) == {kind for kind, cell in CELLS.items() if cell.name.startswith("quadr")}


@pytest.mark.parametrize("kind", BETWEEN)
def test_pieces_use_every_node_of_the_surface_and_fill_the_straight_cell(kind):
    points = nodes(kind)
    triangles, _ = surface(points, (kind, row_of(kind)))

    inside = 1 if kind in ("hexahedron27", "pyramid19") else 0
    assert set(triangles.ravel().tolist()) == set(range(len(points) - inside))
    assert areas(points, triangles).min() > 0
    if CELLS[kind].is_volume:
        assert Mesh(points, triangles).is_watertight
        assert volume(points, triangles) == pytest.approx(VOLUME_OF[base(kind)])
    else:
        flat, _ = surface(points, (base(kind), row_of(base(kind))))
        assert areas(points, triangles).sum() == pytest.approx(areas(points, flat).sum())


@pytest.mark.parametrize("kind", BETWEEN)
def test_every_node_that_is_pushed_out_is_on_the_surface_and_it_still_closes(kind):
    points = nodes(kind)
    middle = points.mean(axis=0)
    further = slice(len(CORNERS[base(kind)]), None)
    points[further] += 0.2 * (points[further] - middle) + (0, 0, 0.01)

    triangles, _ = surface(points, (kind, row_of(kind)))

    if CELLS[kind].is_volume:
        assert Mesh(points, triangles).is_watertight
        assert volume(points, triangles) > VOLUME_OF[base(kind)]
    assert len({tuple(points[k]) for k in triangles.ravel()}) >= len(points) - 1


COUNTS = {"triangle6": 4, "triangle7": 6, "quad6": 4, "quad8": 6, "quad9": 8}


@pytest.mark.parametrize("kind", COUNTS)
def test_surface_cells_are_told_with_their_pieces(kind):
    points = nodes(kind)

    triangles, notes = surface(points, (kind, np.vstack([row_of(kind)] * 2)))

    assert len(triangles) == 2 * COUNTS[kind]
    shape = "quadratic triangles" if kind.startswith("t") else "quadratic quads"
    assert notes == [f"2 {shape} cut into {2 * COUNTS[kind]} flat pieces through their nodes"]


def test_volumes_are_told_with_the_pieces_of_their_boundary():
    _, notes = surface(nodes("tetra10"), ("tetra10", row_of("tetra10")))

    assert notes == [
        "1 volume cell taken as its boundary",
        "4 quadratic faces of volume cells cut into 16 flat pieces through their nodes",
    ]


def test_triangles_of_second_order_by_hand():
    triangles, _ = surface(nodes("triangle6"), ("triangle6", row_of("triangle6")))

    assert triangles.tolist() == [[5, 0, 3], [3, 1, 4], [4, 2, 5], [3, 4, 5]]


def test_a_middle_node_that_is_missing_leaves_a_straight_edge():
    points = nodes("triangle6")

    triangles, _ = surface(points, ("triangle6", np.array([[0, 1, 2, -1, 4, 5]])))

    assert areas(points, triangles).sum() == pytest.approx(0.5)
    assert set(triangles.ravel().tolist()) == {0, 1, 2, 4, 5}
    sides = Counter((r[k], r[(k + 1) % 3]) for r in triangles.tolist() for k in range(3))
    assert sides[0, 1] == 1


@pytest.mark.parametrize("kind", [kind for kind in BETWEEN if CELLS[kind].is_volume])
def test_any_middle_nodes_may_be_missing_and_the_surface_closes(kind):
    points = nodes(kind)
    corners, edges = len(CORNERS[base(kind)]), sum(len(b) == 2 for b in BETWEEN[kind])
    random = np.random.default_rng(7)
    for _ in range(20):
        row = row_of(kind).copy()
        missing = corners + np.flatnonzero(random.random(edges) < 0.5)
        row[0, missing] = -1

        triangles, _ = surface(points, (kind, row))

        assert Mesh(points, triangles).is_watertight
        assert volume(points, triangles) == pytest.approx(VOLUME_OF[base(kind)])
        assert not set(missing.tolist()) & set(triangles.ravel().tolist())


def test_a_quadratic_neighbour_hides_the_same_face_of_a_linear_one():
    points = np.vstack([nodes("hexahedron20"), [(2, 0, 0), (2, 1, 0), (2, 0, 1), (2, 1, 1)]])
    linear = np.array([[1, 20, 21, 2, 5, 22, 23, 6]])

    triangles, _ = surface(points, ("hexahedron20", row_of("hexahedron20")), ("hexahedron", linear))

    assert volume(points, triangles) == pytest.approx(2.0)
    inner = (points[triangles] == [1, 0, 0])[..., 0].all(axis=1)
    assert not inner.any()


@pytest.mark.parametrize("kind", [kind for kind in BETWEEN if CELLS[kind].is_volume])
@pytest.mark.parametrize("turned", [False, True])
def test_volumes_face_outwards_whichever_way_they_are_numbered(kind, turned):
    points = nodes(kind) * ([-1, 1, 1] if turned else [1, 1, 1])

    triangles, _ = surface(points, (kind, row_of(kind)))

    assert volume(points, triangles) == pytest.approx(VOLUME_OF[base(kind)])


# Of the files that meshio writes, those of Gmsh number further nodes in another way.
@pytest.mark.parametrize("name", ["a.vtk", "a.vtu", "a.msh"])
@pytest.mark.parametrize(
    "kind", ["triangle6", "quad8", "quad9", "tetra10", "hexahedron20", "hexahedron27",]
)  # fmt: skip
def test_files_keep_every_node_of_second_order_cells(kind, name, tmp_path):
    points = nodes(kind)
    options = {"file_format": "gmsh"} if name == "a.msh" else {}
    path = write(tmp_path / name, [(kind, row_of(kind))], points, **options)

    mesh = load_mesh(path)

    wanted, notes = surface(points, (kind, row_of(kind)))
    assert mesh.triangles.tolist() == wanted.tolist()
    assert list(mesh.notes) == notes


# Gmsh's own tables of the edges and faces behind the corners, by its documentation.
GMSH = {
    "pyramid14": (14, 14, [(0, 1), (0, 3), (0, 4), (1, 2), (1, 4), (2, 3), (2, 4), (3, 4),
                           (0, 1, 2, 3)]),
    "wedge18": (13, 18, [(0, 1), (0, 2), (0, 3), (1, 2), (1, 4), (2, 5), (3, 4), (3, 5), (4, 5),
                         (0, 1, 4, 3), (0, 2, 5, 3), (1, 2, 5, 4)]),
    "hexahedron20": (17, 20, [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7),
                              (4, 5), (4, 7), (5, 6), (6, 7)]),
    "tetra10": (11, 10, [(0, 1), (1, 2), (2, 0), (0, 3), (2, 3), (1, 3)]),
}  # fmt: skip


@pytest.mark.parametrize("kind", GMSH)
def test_gmsh_numbers_further_nodes_as_its_manual_says(kind, tmp_path):
    number, count, between = GMSH[kind]
    corners = np.array(CORNERS[base(kind)], dtype=float)
    points = [*corners, *(corners[list(each)].mean(axis=0) for each in between)]
    lines = [
        f"{k + 1} {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(map(np.ndarray.tolist, points))
    ]
    element = " ".join(map(str, [1, number, 2, 0, 1, *range(1, count + 1)]))
    path = tmp_path / "a.msh"
    path.write_text(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n"
        + "\n".join([str(count), *lines])
        + f"\n$EndNodes\n$Elements\n1\n{element}\n$EndElements\n"
    )

    mesh = load_mesh(path)

    # Every piece is as straight as the cell only where each node is taken for the right edge.
    assert mesh.is_watertight
    assert volume(mesh.vertices, mesh.triangles) == pytest.approx(VOLUME_OF[base(kind)])
    assert areas(mesh.vertices, mesh.triangles).sum() == pytest.approx(
        areas(corners, surface(corners, (base(kind), row_of(base(kind))))[0]).sum()
    )
    assert len(set(mesh.triangles.ravel().tolist())) == count
