"""The features of small meshes in pairs: vertex and face, face and vertex, edge and edge.

Closed surfaces that are apart first meet in such a pair, degenerate triangles included: their
edges, of length zero too, count.
"""

from __future__ import annotations

from itertools import product
from typing import Any, NamedTuple

import numpy as np


class Features(NamedTuple):
    """Pairs of one kind: vertices `a` (N, p) of A, `b` (N, q) of B, and their triangles."""

    a: Any
    b: Any
    owners: list[tuple[tuple[int, ...], tuple[int, ...]]]


def feature_pairs(faces_a: Any, faces_b: Any) -> list[Features]:
    """Return all pairs that can be the first to meet, by kind."""
    vertices_a, edges_a, triangles_a = _parts(faces_a)
    vertices_b, edges_b, triangles_b = _parts(faces_b)
    kinds = ((vertices_a, triangles_b), (triangles_a, vertices_b), (edges_a, edges_b))
    return [_paired(one, two) for one, two in kinds]


Parts = dict[tuple[int, ...], tuple[int, ...]]


def _parts(faces: Any) -> tuple[Parts, Parts, Parts]:
    """Return the vertices, edges and triangles, each with the triangles it belongs to."""
    parts: tuple[Parts, Parts, Parts] = ({}, {}, {})
    for number, (i, j, k) in enumerate(np.asarray(faces).tolist()):
        named = (((i,), (j,), (k,)), ((i, j), (j, k), (k, i)), ((i, j, k),))
        for table, keys in zip(parts, named, strict=True):
            for key in keys:
                key = tuple(sorted(key))
                table[key] = (*table.get(key, ()), number)
    return parts


def _paired(one: Parts, two: Parts) -> Features:
    couples = list(product(one.items(), two.items()))
    index_a = np.array([a[0] for a, _ in couples], dtype=np.int64)
    index_b = np.array([b[0] for _, b in couples], dtype=np.int64)
    return Features(index_a, index_b, [(a[1], b[1]) for a, b in couples])
