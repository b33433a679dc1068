"""What a file is, told by its first bytes: for streams without a name, and for wrong names."""

from __future__ import annotations

import re

from obbcli.mesh.formats.stl import is_binary_stl

_HEAD_BYTES = 1 << 16

#: How files begin, in any case and after any white space; with the suffix they should have (None:
#: not read) and what they are.
_BEGINNINGS: tuple[tuple[bytes, str | None, str], ...] = (
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


def beginning(data: bytes) -> tuple[str | None, str] | None:
    """Return suffix and description of the format that the bytes show, if any."""
    # A binary STL may begin with any text: its length tells it.
    if is_binary_stl(data):
        return ".stl", "a binary STL file"
    head = data[:_HEAD_BYTES]
    for pattern, suffix, words in _BEGINNINGS:
        # Compiled here: few files are not what they should be.
        if re.match(rb"\s*" + pattern, head, re.IGNORECASE):
            return suffix, words
    return None
