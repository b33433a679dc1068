"""What a file is, told by its first bytes: for streams without a name, and for wrong names."""

from __future__ import annotations

import re

from obbcli.mesh.stl import is_binary_stl

_HEAD_BYTES = 1 << 16

#: How files begin, with the suffix they should have (None: not read) and what they are.
_BEGINNINGS: tuple[tuple[re.Pattern[bytes], str | None, str], ...] = tuple(
    (re.compile(rb"\s*" + pattern, re.IGNORECASE), suffix, words)
    for pattern, suffix, words in (
        (rb"ply\s", ".ply", "a PLY file"),
        (rb"gltf", ".glb", "a GLB file"),
        (rb"solid\b", ".stl", "an ASCII STL file"),
        (rb"(ST)?C?N?4?n?OFF\b", ".off", "an OFF file"),
        (rb"# vtk ", ".vtk", "a VTK file"),
        (rb"\$MeshFormat", ".msh", "a Gmsh file"),
        (rb"(<\?xml[^>]*>\s*)?<VTKFile", ".vtu", "a VTU file"),
        (rb"pk\x03\x04", None, "a zip archive, which is not opened"),
        (rb"\x1f\x8b", None, "a gzip archive, which is not opened"),
        (rb"\x89HDF", None, "an HDF5 file, which is not read"),
        (rb"ISO-10303", None, "a STEP file, which is no mesh"),
        (rb"(#[^\n]*\n|\s)*(v|vt|vn|o|g|s|mtllib|usemtl)[ \t]", ".obj", "an OBJ file"),
    )
)


def beginning(data: bytes) -> tuple[str | None, str] | None:
    """Return suffix and description of the format that the bytes show, if any."""
    # A binary STL may begin with any text: its length tells it.
    if is_binary_stl(data):
        return ".stl", "a binary STL file"
    head = data[:_HEAD_BYTES]
    return next(((form[1], form[2]) for form in _BEGINNINGS if form[0].match(head)), None)
