"""Boxes by hull and of least volume: closed forms, other programs' figures, many orientations."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from meshes.nasty import bumpy_grid, needles, soup

from obbcli import Mesh, ObbTree, load_mesh

SAMPLES = Path(__file__).parents[2] / "sample_meshes"
# Half extents are floats, rounded up, and axes as good as a quaternion of floats: some 1e-7 each.
ROUNDING = 1e-6
THIRDS = np.array([[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]]) / 3.0
SLANT = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]]) @ THIRDS

# Of the root, by trimesh 5.2.0's trimesh.bounds.oriented_bounds.
TRIMESH_VOLUMES = {
    "board.vtk": 3760.4,
    "bolt.ply": 27269.407424926758,
    "chain_link_a.off": 4095.0,
    "chain_link_b.ply": 4095.0000000000023,
    "degenerate.ply": 4196743067.86917,
    "finger_left.off": 17424.0,
    "finger_right.off": 17424.0,
    "gear.stl": 91978.64950430812,
    "gripper_palm.glb": 68600.0,
    "housing.stl": 48000.0,
    "nut.obj": 8646.397343999999,
    "pinion.stl": 22170.633900621004,
    "robot_link.ply": 247153.99598914874,
    "workpiece.obj": 610000.0,
}


def root_of(points: Any, fit: str) -> ObbTree:
    """Return the root alone of a tree over triangles with these corners."""
    points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    corners = np.arange(len(points) + -len(points) % 3) % len(points)
    mesh = Mesh(points, corners.reshape(-1, 3))
    return ObbTree.build(mesh, fit=fit, max_depth=0)  # type: ignore[arg-type]


def volume_of(points: Any, fit: str = "min-volume") -> float:
    volume = root_of(points, fit).levels[0].volume
    assert volume is not None
    return float(volume)


def cuboid(*sides: float) -> Any:
    return np.array(list(itertools.product(*((0.0, side) for side in sides))))


TETRAHEDRON = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
OCTAHEDRON = np.concatenate([np.eye(3), -np.eye(3)])
HEXAGON = np.array([[np.cos(k * np.pi / 3), np.sin(k * np.pi / 3)] for k in range(6)])
WEDGE = np.array([[0.0, 0], [3, 0], [0, 4]])


def prism(polygon: Any, height: float) -> Any:
    return np.concatenate(
        [np.column_stack((polygon, np.full(len(polygon), z))) for z in (0, height)]
    )


@pytest.mark.parametrize(
    ("points", "volume"),
    [
        (cuboid(3, 5, 7), 105.0),
        (cuboid(1, 1, 1), 1.0),
        (cuboid(100, 10, 0.01), 10.0),
        # No side on a face: the cube whose sides' diagonals are its edges.
        (TETRAHEDRON, 8.0),
        # The cube along the rows of THIRDS: six edges, of which no two are opposite.
        (OCTAHEDRON, 64.0 / 27.0),
        (prism(HEXAGON, 9.0), 2.0 * 3.0**0.5 * 9.0),
        (prism(WEDGE, 11.0), 3.0 * 4.0 * 11.0),
    ],
    ids=["box", "cube", "plate", "tetrahedron", "octahedron", "hexagonal prism", "wedge"],
)
@pytest.mark.parametrize("turn", [np.eye(3), THIRDS, SLANT], ids=["plain", "turned", "turned on"])
def test_least_box_of_a_regular_body_has_the_known_volume(
    points: Any, volume: float, turn: Any
) -> None:
    # A hundredth of an axis of length 100 is off by 1e-7 of 100.
    thinness = 1e3 if volume == 10.0 else 1.0

    root = volume_of(points @ turn.T)
    # Nodes below the root are searched less far.
    child = 8 * np.prod(half_extents(*beside(points @ turn.T)))

    # There the octahedron lies between two of its faces, 2 / sqrt 3 apart, a hexagon from above.
    coarser = 9.0 / 8.0 if points is OCTAHEDRON else 1.0
    assert volume * (1 - 1e-9) <= root <= volume * (1 + ROUNDING * thinness)
    assert volume * (1 - 1e-9) <= child <= volume * (1 + ROUNDING * thinness) * coarser


def test_least_box_of_a_planar_body_has_the_least_rectangle() -> None:
    triangle = np.column_stack((WEDGE, np.zeros(3)))
    for points in (triangle, triangle @ SLANT.T):
        tree = root_of([points, points[[1, 2, 0]]], "min-volume")
        short, middle, long = sorted(half_extents(tree))

        # On any of its sides a triangle's rectangle has twice its area.
        assert 4 * middle * long == pytest.approx(12.0, rel=ROUNDING)
        assert short < 1e-6


def beside(points: Any) -> tuple[ObbTree, int]:
    """Return a tree over the points and their like far away, and the slot of one child."""
    corners = np.arange(len(points) + -len(points) % 3) % len(points)
    both = np.concatenate((points[corners], points[corners] + 1024))
    mesh = Mesh(both, np.arange(len(both)).reshape(-1, 3))
    return ObbTree.build(mesh, fit="min-volume", max_depth=1), 1


def half_extents(tree: ObbTree, slot: int = 0) -> list[float]:
    """Return those of a node, from the bytes of its record."""
    tree.levels  # noqa: B018  # makes the tree whole
    record = bytes(tree._arrays.nodes[slot])
    return [float(x) * 2.0**tree._arrays.scale_exponent for x in np.frombuffer(record, "<f4")[6:9]]


def random_turns(count: int) -> Any:
    turns, mixed = np.linalg.qr(np.random.default_rng(1).normal(size=(count, 3, 3)))
    return turns * np.sign(np.einsum("nii->ni", mixed))[:, np.newaxis]


@pytest.mark.parametrize(
    "points",
    [
        soup(6, 1)[0],
        soup(30, 2)[0],
        soup(200, 3)[0],
        needles(25)[0],
        bumpy_grid(6)[0] @ THIRDS,
        np.random.default_rng(4).normal(size=(1500, 3)) @ np.diag([1, 0.8, 0.6]) @ SLANT,
    ],
    ids=["few", "soup", "larger soup", "needles", "sheet", "cloud"],
)
def test_no_other_orientation_has_a_much_smaller_box(points: Any) -> None:
    extents = np.ptp(np.einsum("nij,pj->pni", random_turns(5000), points), axis=0)

    assert volume_of(points) < 1.001 * extents.prod(axis=1).min()


@pytest.mark.parametrize("name", TRIMESH_VOLUMES)
def test_least_box_of_a_sample_is_no_larger_than_that_of_trimesh(name: str) -> None:
    root = ObbTree.build(load_mesh(SAMPLES / name), fit="min-volume", max_depth=0).levels[0]

    # 1.7e6 long and 50 thick: the quaternion's rounding widens the box by 0.07 %.
    slack = 1e-3 if name == "degenerate.ply" else ROUNDING
    assert root.volume is not None
    assert root.volume <= TRIMESH_VOLUMES[name] * (1 + slack)


def test_least_box_is_no_larger_than_those_by_hull_or_along_coordinates() -> None:
    for seed in range(40):
        points = soup(2 + 3 * seed, seed)[0] * (1.0, 0.3, 0.1)
        least = volume_of(points)

        for fit in ("hull", "axis-aligned"):
            assert least <= volume_of(points, fit) * (1 + ROUNDING)


@pytest.mark.parametrize("fit", ["hull", "min-volume"])
def test_points_inside_the_hull_turn_no_box(fit: str) -> None:
    random = np.random.default_rng(8)
    corners = random.normal(size=(30, 3)) * (1.0, 0.6, 0.3)
    shares = random.dirichlet(np.ones(30), 300)

    plain = half_extents(root_of(corners, fit))
    # The hull's corners again, in another order, and points at all sorts of places between them.
    cluttered = half_extents(root_of([*shares @ corners, *corners[::-1]], fit))

    assert cluttered == pytest.approx(plain, rel=1e-6)


def test_hull_fit_weighs_the_hulls_surface_by_area() -> None:
    # Of three unequal sides the axes are the box's own, however its surface is cut and cluttered;
    # dense points at one corner would turn a box by points.
    dense = np.random.default_rng(9).uniform(0, 0.2, (500, 3))
    points = np.concatenate((dense, cuboid(3, 5, 7))) @ SLANT.T

    assert volume_of(points, "hull") == pytest.approx(105.0, rel=1e-5)
    assert volume_of(points, "points") > 110.0


def test_hull_fit_agrees_with_numpy_on_a_tetrahedron() -> None:
    for seed in range(20):
        corners = np.random.default_rng(seed).normal(size=(4, 3))
        faces = corners[list(itertools.combinations(range(4), 3))]
        areas = np.linalg.norm(
            np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1
        )
        shares = areas / areas.sum()
        mean = shares @ faces.mean(axis=1)
        # The midpoints of the sides integrate quadratics over a triangle exactly.
        middles = (faces + np.roll(faces, 1, axis=1)) / 2 - mean
        covariance = np.einsum("f,fki,fkj->ij", shares, middles, middles) / 3
        axes = np.linalg.eigh(covariance)[1]

        expected = np.ptp(corners @ axes, axis=0).prod()
        assert volume_of(corners, "hull") == pytest.approx(expected, rel=1e-5)
