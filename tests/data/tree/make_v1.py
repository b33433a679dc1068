"""Writes v1.obbt beside itself: a tree file of version 1 that every later version must read.

Run it only when version 1 itself is found wrong; another version gets a file of its own.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import obbcli

FILE = Path(__file__).with_name("v1.obbt")


def mesh() -> obbcli.Mesh:
    """Return a folded sheet of 50 triangles, all coordinates small multiples of 1/8."""
    x, y = np.meshgrid(np.arange(6.0), np.arange(6.0), indexing="ij")
    vertices = np.stack([x, y, (x * x - 3.0 * y + x * y) / 8.0], axis=-1).reshape(-1, 3)
    corner = (np.arange(5)[:, None] * 6 + np.arange(5)).ravel()
    lower = np.column_stack((corner, corner + 6, corner + 1))
    upper = np.column_stack((corner + 7, corner + 1, corner + 6))
    return obbcli.Mesh(vertices, np.concatenate((lower, upper)), "folded sheet.stl", "5a" * 32)


def tree() -> obbcli.ObbTree:
    return obbcli.ObbTree.build(mesh(), split="center", leaf_size=2, max_depth=7)


if __name__ == "__main__":
    tree().save(FILE)
