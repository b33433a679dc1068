"""Small Abaqus decks, and what is asked of their surfaces."""

from __future__ import annotations

import numpy as np

from obbcli.mesh import load_mesh_bytes

TETRA_NODES = """*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
4, 0., 0., 1.
"""
TETRA = TETRA_NODES + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n"
PART = f"*PART, NAME=Tet\n{TETRA}*END PART\n"


def deck(text):
    return load_mesh_bytes(text.encode(), ".inp")


def corners(mesh):
    """Return the surface as a set of its triangles' corners, in any order and turn."""
    return sorted(
        sorted(map(tuple, triangle)) for triangle in mesh.vertices[mesh.triangles].tolist()
    )


def volume(mesh):
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def area(mesh):
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)
