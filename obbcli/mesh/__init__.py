"""Meshes: what a file's bytes mean as triangles, and nothing about boxes, time or people.

First room of the flow: mesh -> tree -> query -> report.
"""

from __future__ import annotations

from obbcli.mesh.formats import known_suffixes, suffix_of
from obbcli.mesh.load import load_mesh, load_mesh_bytes
from obbcli.mesh.mesh import Mesh, PartRows
from obbcli.mesh.source import check_file, digest_of, read_stream

__all__ = [
    "Mesh",
    "PartRows",
    "check_file",
    "digest_of",
    "known_suffixes",
    "load_mesh",
    "load_mesh_bytes",
    "read_stream",
    "suffix_of",
]
