"""What a file is, told by its first bytes: content counts before the name."""

from __future__ import annotations

import re
from typing import NamedTuple

from obbcli.mesh.formats.stl import is_binary_stl
from obbcli.mesh.formats.text import strip_mark

HEAD_BYTES = 1 << 16

#: How files begin, in any case and after any white space; with the suffix they should have and
#: what they are.
_BEGINNINGS: tuple[tuple[bytes, str, str], ...] = (
    (rb"ply[ \t]*[\r\n]", ".ply", "a PLY file"),
    (rb"gltf[\x01-\x03]\0\0\0", ".glb", "a GLB file"),
    (rb"(ST)?C?N?4?n?OFF\s*((#[^\n]*\n\s*)*\d|BINARY|\Z)", ".off", "an OFF file"),
    # Models of buildings are files of STEP, too, and no meshes.
    (rb"ISO-10303-21\s*;(?!(?s:.){0,4000}?FILE_SCHEMA[\s(]*'IFC)", ".step", "a STEP file"),
    (rb"# vtk datafile", ".vtk", "a VTK file"),
    (rb"\$MeshFormat", ".msh", "a Gmsh file"),
    (
        rb"(<\?xml[^>]*>\s*)?(<!--((?!-->)(?s:.)){0,4000}-->\s*)*<COLLADA\b",
        ".dae",
        "a COLLADA document",
    ),
    (rb"(<\?xml[^>]*>\s*)?<VTKFile", ".vtu", "a VTK XML file"),
    (rb"(\*\*[^\n]*\s+)*\*(heading|node|part|preprint|include)\b", ".inp", "an Abaqus deck"),
    (rb"(#[^\n]*\s+)*(title\s*=\s*\"|variables\s*=)", ".tec", "a Tecplot file"),
    (rb"#!(tdv|szplt)", ".tec", "a binary Tecplot file"),
    (rb"(%[^\n]*\s+)*(ndime|nzone)\s*=", ".su2", "an SU2 mesh"),
    (rb"\{[^{}\[\]]*\"asset\"\s*:\s*\{", ".gltf", "a glTF file"),
)
#: A statement or a point of a Nastran deck, which may begin with any comment and any title.
_DECK = rb"(?im)^([ \t]*(CEND[ \t]*(\$.*)?\r?$|BEGIN[ \t]+(BULK|SUPER)\b)|GRID\*?[ \t]*,?[ \t]*\d)"
#: A line of an ASCII STL beside its title.
_FACETS = rb"(?im)^[ \t]*(facet|endsolid|end[ \t]+solid)\b"
#: The name of the model in archives of 3MF, as nearly all have it.
_IN_3MF = b"3D/3dmodel.model"
_OBJ_WORDS = frozenset(b"v vt vn o g s mtllib usemtl".split())


class Beginning(NamedTuple):
    """Holds what a file looks like.

    Args:
        suffix: what its name should end with.
        words: what it is, as errors and notes say it.
        is_sure: whether nothing else begins like that.
    """

    suffix: str
    words: str
    is_sure: bool = True


def beginning(data: bytes) -> Beginning | None:
    """Return the format that the bytes show, if any."""
    # A binary STL may begin with any text: its length tells it.
    if is_binary_stl(data):
        return Beginning(".stl", "a binary STL file")
    if data.startswith(b"PK\x03\x04") and _IN_3MF in data:
        return Beginning(".3mf", "a 3MF file")
    head = strip_mark(data[:HEAD_BYTES]).lstrip()
    for pattern, suffix, words in _BEGINNINGS:
        # Compiled here: few files are looked at twice.
        if re.match(pattern, head, re.IGNORECASE):
            return Beginning(suffix, words)
    if re.match(rb"solid\b", head, re.IGNORECASE) and re.search(_FACETS, head):
        return Beginning(".stl", "an ASCII STL file")
    if _is_like_obj(head):
        return Beginning(".obj", "an OBJ file", is_sure=False)
    return Beginning(".bdf", "a Nastran deck") if re.search(_DECK, head) else None


def is_packed(data: bytes) -> bool:
    """Return whether the bytes are those of a gzip file, which may hold a mesh."""
    return data.startswith(b"\x1f\x8b") and not is_binary_stl(data)


def _is_like_obj(head: bytes) -> bool:
    """Return whether the first line that says something begins as one of OBJ does."""
    for line in head.splitlines():
        words = line.split(None, 1)
        if words and not words[0].startswith(b"#"):
            return len(words) == 2 and words[0] in _OBJ_WORDS
    return False
