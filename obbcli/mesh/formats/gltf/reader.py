"""glTF 2.0 and its binary form GLB, read by our own strict reader as the specification says.

trimesh takes nodes in an order that depends on its stack (the last root first) and skips triangle
fans, skins, morph weights and required extensions without a word. Only what makes and places
surface is read: positions, indices, morph targets, skins and the nodes that place them.
"""

from __future__ import annotations

import json
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING

from obbcli.mesh.formats.gltf.buffers import split_glb
from obbcli.mesh.formats.gltf.data import Document
from obbcli.mesh.formats.gltf.extensions import check_extensions
from obbcli.mesh.formats.gltf.json import NotAsExpectedError, words_of
from obbcli.mesh.formats.gltf.parts import parts_of
from obbcli.mesh.parts.placed import joined

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.mesh.formats.gltf.json import Json
    from obbcli.mesh.parts.placed import PlacedPart
    from obbcli.mesh.source import MeshArrays, Source


def read_gltf(source: Source) -> MeshArrays:
    """Return vertices and triangles of the document's scene, nodes in the document's order.

    Nodes are taken depth first from the first root on, children in their order, of each node's
    mesh the primitives in theirs, of instances one after the other. Matrices are applied in double
    precision, and a mirrored node's triangles are turned over. Morph targets stand at their default
    weights, skins as their joints hold them at rest. Points and lines have no surface. A document
    without scenes shows all its root nodes, one without nodes its meshes, unplaced.

    Raises:
        MeshError: not JSON, another version, lengths that do not fit, values out of place, a
            required extension that is not read, compressed geometry whose package is missing.
    """
    with _naming(source):
        parts = parts_of(_document(source))
        return joined((part.placed() for part in parts), source, "nodes")


def parts_gltf(source: Source) -> Iterator[PlacedPart]:
    """Yield the document's parts: what each of its scene's nodes shows, in `read_gltf`'s order.

    Raises:
        MeshError: as `read_gltf`; what is wrong with a part's own values, when it is decoded.
    """
    with _naming(source):
        for part in parts_of(_document(source)):
            yield part._replace(decode=partial(_decoded, source, part))


def _decoded(source: Source, part: PlacedPart) -> MeshArrays:
    with _naming(source):
        return part.decode()


@contextmanager
def _naming(source: Source) -> Iterator[None]:
    """Let errors name the file."""
    try:
        yield
    except NotAsExpectedError as fault:
        raise source.error(fault.fault, fault.remedy, at=fault.place) from fault


def _document(source: Source) -> Document:
    """Return the document, of a version and with extensions that are read."""
    source.state_unit("m")  # glTF 2.0, 3.4
    text, chunk = split_glb(source)
    content = _parsed(source, text)
    _check_version(content)
    document = Document(source, content, chunk)
    check_extensions(document)
    if document.items("animations"):
        source.note("animations are not played")
    return document


def _parsed(source: Source, text: bytes) -> Json:
    """Return the document, its errors in our words."""
    try:
        content = json.loads(text, parse_constant=_refuse_constant)
    except json.JSONDecodeError as fault:
        at = f"line {fault.lineno}, column {fault.colno}"
        raise source.error(f"is not glTF: no JSON at {at}", "export it again") from fault
    except UnicodeDecodeError as fault:
        raise source.error("is not glTF: its text is no UTF-8", "export it again") from fault
    except RecursionError as fault:
        raise source.error("is not glTF: its JSON nests too deep", "export it again") from fault
    except ValueError as fault:
        raise source.error(
            "is not glTF: it holds a number that JSON does not know", "export it again"
        ) from fault
    if not isinstance(content, dict) or not isinstance(content.get("asset") or {}, dict):
        raise source.error("is missing; this is no glTF document", "export it again", at="asset")
    return content


def _refuse_constant(name: str) -> float:
    raise ValueError(name)


def _check_version(content: Json) -> None:
    """Refuse other versions by name: glTF 1.0 is another format."""
    old = isinstance(content.get("meshes"), dict) or isinstance(content.get("scenes"), dict)
    asset = content.get("asset")
    if asset is None and not old:
        raise NotAsExpectedError("asset", "is missing; this is no glTF document")
    version = (asset or {}).get("version", "1.0" if old else "2.0")
    least = (asset or {}).get("minVersion", "2.0")
    number = str(version).partition(".")[0]
    if old or number != "2":
        shown = "1.0" if old else words_of(version).strip("'")
        raise NotAsExpectedError(
            "asset.version", f"is glTF {shown}, only 2.0 is read", "convert it to glTF 2.0"
        )
    if least != "2.0":
        fault = f"needs a reader of glTF {words_of(least)}, this one reads 2.0"
        raise NotAsExpectedError("asset.minVersion", fault, "export it as glTF 2.0")
