"""The compact split takes the cheapest of its planes, and falls back where there is none."""

from __future__ import annotations

from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
from meshes.nasty import NASTY, bumpy_grid, grid, needles, soup

from obbcli import Mesh, ObbTree, load_mesh
from obbcli.tree.options import Split

SAMPLES = Path(__file__).parents[2] / "sample_meshes"

BINS = 16


def root_parts(surface: Any, fit: Any = "axis-aligned") -> tuple[set[int], set[int]]:
    """Return the rows of the triangles on either side of the root."""
    arrays = ObbTree.build(Mesh(*surface), fit=fit, split="compact", max_depth=1)._arrays
    split = int(np.frombuffer(bytes(arrays.nodes[0]), "<u4")[13])
    ids = arrays.triangle_ids.tolist()
    return set(ids[:split]), set(ids[split:])


def cost_of(corners: Any, sides: Any) -> float:
    """Return what a parting costs: squared diagonals of axis-aligned boxes times counts."""
    boxes = [np.ptp(corners[sorted(side)].reshape(-1, 3), axis=0) for side in sides]
    return float(sum(len(side) * box @ box for side, box in zip(sides, boxes, strict=True)))


def all_partings(corners: Any) -> list[tuple[set[int], set[int]]]:
    """Return what 15 planes across each axis of the axis-aligned box part, by brute force."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    middles = corners.mean(axis=1)
    found = []
    for axis in range(3):
        for k in range(1, BINS):
            plane = low[axis] + (high - low)[axis] * k / BINS
            left = set(np.flatnonzero(middles[:, axis] < plane).tolist())
            if 0 < len(left) < len(corners):
                found.append((left, set(range(len(corners))) - left))
    return found


@pytest.mark.parametrize(
    "surface",
    [soup(3, 1), soup(8, 2), soup(40, 3), soup(500, 4), needles(30), bumpy_grid(9)],
    ids=["three", "eight", "forty", "soup", "needles", "sheet"],
)
def test_compact_split_takes_the_cheapest_plane(surface: Any) -> None:
    vertices, triangles = surface
    corners = np.asarray(vertices)[np.asarray(triangles)]

    parts = root_parts(surface)

    partings = all_partings(corners)
    assert parts in [*partings, *((right, left) for left, right in partings)]
    least = min(cost_of(corners, sides) for sides in partings)
    assert cost_of(corners, parts) == pytest.approx(least, rel=1e-9)


@pytest.mark.parametrize("fit", ["triangles", "points", "hull", "min-volume", "axis-aligned"])
@pytest.mark.parametrize(("few", "many"), [(3, 60), (700, 30_000)])
def test_compact_split_parts_clusters_of_unequal_size(few: int, many: int, fit: Any) -> None:
    # Of the larger pair a sample decides.
    small, large = soup(few, 1)[0] + (40.0, 25.0, -10.0), soup(many, 2)[0]
    vertices = np.concatenate((small, large))

    parts = root_parts((vertices, np.arange(len(vertices)).reshape(-1, 3)), fit)

    assert set(range(few)) in parts


@pytest.mark.parametrize("name", ["coincident", "one point", "the origin"])
def test_compact_split_halves_where_all_centroids_coincide(name: str) -> None:
    vertices, triangles = NASTY[name]()

    tree = ObbTree.build(Mesh(vertices, triangles), split="compact")

    assert len(tree.levels) == 1 + int(np.ceil(np.log2(len(triangles))))
    tree.check()


def test_compact_split_of_a_flat_sheet_parts_it_across() -> None:
    sheet = grid(8, lambda x, y: 0 * x * y)

    left, right = root_parts(sheet)

    assert len(left) == len(right) == 64


@pytest.mark.parametrize("name", ["gear.stl", "bolt.ply", "robot_link.ply", "workpiece.obj"])
def test_boxes_of_the_compact_split_are_smaller_in_sum(name: str) -> None:
    mesh = load_mesh(SAMPLES / name)
    sums = {
        split: sum(level.volume or 0.0 for level in ObbTree.build(mesh, split=split).levels)
        for split in get_args(Split)
    }

    assert sums["compact"] < 0.9 * min(sums["median"], sums["center"])
