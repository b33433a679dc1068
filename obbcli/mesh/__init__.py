"""Meshes: what a file's bytes mean as triangles, and nothing about boxes, time or people.

First room of the flow: mesh -> tree -> query -> report.
"""

from __future__ import annotations

from obbcli.mesh.load import known_suffixes, load_mesh, load_mesh_bytes
from obbcli.mesh.mesh import Mesh

__all__ = ["Mesh", "known_suffixes", "load_mesh", "load_mesh_bytes"]
