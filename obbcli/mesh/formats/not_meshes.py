"""Files that are no meshes, whatever their name says: what they are, and what to do.

Robots' and museums' repositories hold pointers in place of large files, servers answer with pages,
and downloads end early: one file in seventeen of those fetched for a survey was such.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from obbcli.mesh.formats.text import strip_mark

_HEAD_BYTES = 4096
_UNPACK = "unpack it and name the mesh inside"
_EXPORT = "export the shape as a mesh, such as STL"
_MESH = "name the mesh itself"
_FETCH = "the download brought something else: fetch the file itself"

#: Where certain bytes stand, what the file then is, and what to do.
_SIGNATURES: tuple[tuple[int, bytes, str, str], ...] = (
    (0, b"PK\x03\x04", "a zip archive", _UNPACK),
    (0, b"PK\x05\x06", "an empty zip archive", _UNPACK),
    (0, b"\x1f\x8b", "a gzip archive", _UNPACK),
    (0, b"BZh", "a bzip2 archive", _UNPACK),
    (0, b"\xfd7zXZ\x00", "an xz archive", _UNPACK),
    (0, b"7z\xbc\xaf\x27\x1c", "a 7z archive", _UNPACK),
    (0, b"Rar!\x1a\x07", "a rar archive", _UNPACK),
    (0, b"\x28\xb5\x2f\xfd", "a zstd archive", _UNPACK),
    (257, b"ustar", "a tar archive", _UNPACK),
    (0, b"\x89PNG\r\n", "a PNG picture", _EXPORT),
    (0, b"\xff\xd8\xff", "a JPEG picture", _EXPORT),
    (0, b"GIF8", "a GIF picture", _EXPORT),
    (0, b"II*\0", "a TIFF picture", _EXPORT),
    (0, b"MM\0*", "a TIFF picture", _EXPORT),
    (8, b"WEBP", "a WebP picture", _EXPORT),
    (0, b"%PDF-", "a PDF document", _EXPORT),
    (0, b"%!PS", "a PostScript document", _EXPORT),
    (0, b"Kaydara FBX Binary", "an FBX scene", "export it as glTF"),
    (0, b"BLENDER-v", "a Blender document", "export it as glTF"),
    (0, b"BLENDER_v", "a Blender document", "export it as glTF"),
    (0, b"BLENDER17", "a Blender document", "export it as glTF"),
    (0, b"PXR-USDC", "a USD scene", "export it as glTF"),
    (0, b"#usda", "a USD scene", "export it as glTF"),
    (0, b"#VRML V", "a VRML scene", "export it as glTF"),
    (0, b"DRACO\x02", "a bare Draco buffer", "put it into a glTF document"),
    (0, b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "a document of a CAD or office program", _EXPORT),
    (0, b"3D Geometry File Format", "a Rhino document", _EXPORT),
    (0, b"\x89HDF\r\n", "an HDF5 file, which is not read", "convert it to VTU or STL"),
    (0, b"CDF\x01", "a NetCDF file, which is not read", "convert it to VTU or STL"),
    (0, b"CDF\x02", "a NetCDF file, which is not read", "convert it to VTU or STL"),
    (0, b"\x93NUMPY", "an array of NumPy", "write its triangles as STL"),
    (0, b"\x7fELF", "a program", _FETCH),
    (0, b"SQLite format 3", "a database of SQLite", _FETCH),
)
#: How text begins, in any case, after white space.
_TEXTS: tuple[tuple[bytes, str, str], ...] = (
    (
        rb"version https?://(git-lfs|hawser)\.github\.com/spec/",
        "a Git LFS pointer, not the file that it stands for",
        'run "git lfs pull" where it was cloned',
    ),
    (
        rb"(\.\./)*(\.git)?/annex/objects/\S+\s*\Z",
        "a pointer of git-annex, not the file that it stands for",
        'run "git annex get" where it was cloned',
    ),
    (
        rb"(<\?xml[^>]*>\s*)?(<!--.{0,2000}?-->\s*)?(<!doctype\s+html|<html|<head)\b",
        "a web page (HTML)",
        _FETCH,
    ),
    (rb"(<\?xml[^>]*>\s*)?(<!doctype\s+x3d[^>]*>\s*)?<X3D\b", "an X3D scene", _EXPORT),
    (rb"(#[^\n]*\n\s*)*newmtl\s", "a library of materials, which belongs to an OBJ file", _MESH),
    (
        rb"ISO-10303-21\s*;.{0,4000}?FILE_SCHEMA[\s(]*'IFC",
        "an IFC model of a building",
        "export it as glTF or OBJ",
    ),
    (rb"AC10\d\d\x00", "a DWG drawing", _EXPORT),
    (
        rb"(//[^\n]*\s+)*begin\s+(modelpartdata|nodes|properties)\b",
        "a Kratos model (MDPA), whose elements do not say their shape",
        "export it as VTK",
    ),
    (rb"(<\?xml[^>]*>\s*)?<Error>", "an error that a web server gave (XML)", _FETCH),
    (rb"(<\?xml[^>]*>\s*)?(<!--.{0,2000}?-->\s*)?(<!doctype\s+svg|<svg)\b", "a drawing", _EXPORT),
    (
        rb"\d{3}:? (not found|forbidden|internal server error)\s*\Z",
        "what a web server said",
        _FETCH,
    ),
)
#: Suffixes of formats whose files begin so; where one of them has a reader, the file is its own.
_OWN = {
    "a zip archive": (".3mf",),
    "a USD scene": (".usd", ".usda", ".usdc"),
    "an X3D scene": (".x3d",),
}


class NotAMesh(NamedTuple):
    """Holds what a file is and what to do about it."""

    fault: str
    remedy: str


def not_a_mesh(data: bytes, suffix: str = "") -> NotAMesh | None:
    """Return what a file is that is surely no mesh, else None.

    Args:
        data: the file, or its beginning.
        suffix: of its name, where a reader is known for it, else empty.
    """
    found = _told(data)
    if found is not None and suffix not in _OWN.get(found[0], ()):
        what, remedy = found
        return NotAMesh(f"is {what}" if ", not " in what else f"is {what}, not a mesh", remedy)
    if not data[:_HEAD_BYTES].strip(b"\0") and not data.strip(b"\0"):
        return NotAMesh("holds nothing but zeros, not a mesh", "copy or download it again")
    if not data[:_HEAD_BYTES].strip() and not data.strip():
        return NotAMesh("holds nothing but white space, not a mesh", "write the file again")
    return None


def _told(data: bytes) -> tuple[str, str] | None:
    """Return what the beginning of a file tells, and what to do about it."""
    for at, signature, what, remedy in _SIGNATURES:
        if data.startswith(signature, at):
            return what, remedy
    head = strip_mark(data[:_HEAD_BYTES]).lstrip()
    for pattern, what, remedy in _TEXTS:
        if re.match(pattern, head, re.IGNORECASE | re.DOTALL):
            return what, remedy
    return None
