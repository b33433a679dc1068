"""The surface of a COLLADA mesh: triangles, polygons, fans and strips as triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.collada.sources import positions
from obbcli.mesh.formats.polygons import triangulated
from obbcli.mesh.formats.text import counted
from obbcli.mesh.parts.placed import joined

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.formats.collada.document import Document
    from obbcli.mesh.formats.safe_xml import Element
    from obbcli.mesh.source import MeshArrays

_SURFACES = ("triangles", "polylist", "polygons", "trifans", "tristrips")
#: Elements of a mesh that have no surface, or belong to others.
_PASSED = ("source", "vertices", "lines", "linestrips", "extra", "asset")


class _Polygons(NamedTuple):
    """Corners of polygons, end to end, and how many each has."""

    corners: NDArray[np.int64]
    counts: NDArray[np.int64]


def surfaces(document: Document, geometry: Element) -> list[Element]:
    """Return the elements of a geometry that have surface, in their order.

    Raises:
        MeshError: an element that may have surface and is not read.
    """
    found = []
    for shape in geometry.children:
        if shape.name not in ("mesh", "convex_mesh", "spline", "asset", "extra"):
            raise document.values.error(shape, f"<{shape.name}> is not read", "export a mesh")
        if shape.get("convex_hull_of"):
            fault = "<convex_mesh> stands for a hull, which is not made"
            raise document.values.error(shape, fault, "export a mesh")
        for element in shape.children if shape.name in ("mesh", "convex_mesh") else ():
            if element.name in _SURFACES:
                found.append(element)
            elif element.name not in _PASSED:
                raise document.values.error(element, f"<{element.name}> is not read")
    return found


def decoded(document: Document, elements: list[Element]) -> MeshArrays:
    """Return vertices and triangles of elements that have surface, rows in their order.

    Raises:
        MeshError: inputs that are missing, counts that do not fit, indices out of range.
    """
    known: dict[int, NDArray[np.float64]] = {}  # by `vertices`
    groups: list[tuple[NDArray[np.float64], list[NDArray[np.int64]]]] = []
    for element in elements:
        vertices = _vertices(document, element)
        if id(vertices) not in known:
            known[id(vertices)] = positions(document, vertices)
        points = known[id(vertices)]
        rows = _rows(document, element, points)
        if groups and groups[-1][0] is points:
            groups[-1][1].append(rows)
        else:
            groups.append((points, [rows]))
    parts = [(points, np.concatenate(rows)) for points, rows in groups]
    return parts[0] if len(parts) == 1 else joined(parts, document.source, "meshes")


def _vertices(document: Document, element: Element) -> Element:
    """Return the vertices that an element's corners are numbers of."""
    return document.linked(_vertex_input(document, element), "source", "vertices")


def _vertex_input(document: Document, element: Element) -> Element:
    found = [each for each in element.named("input") if each.get("semantic") == "VERTEX"]
    if len(found) != 1:
        fault = f"<{element.name}> has {len(found)} inputs of vertices, expected one"
        raise document.values.error(element, fault)
    return found[0]


def _rows(document: Document, element: Element, points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the triangles of an element."""
    values = document.values
    lists = list(_corners(document, element, len(points)))
    if element.name in ("trifans", "tristrips"):
        _check_count(document, element, len(lists), "lists")
        cut = _fan if element.name == "trifans" else _strip
        return np.concatenate([np.zeros((0, 3), dtype=np.int64), *map(cut, lists)])
    corners = np.concatenate([np.zeros(0, dtype=np.int64), *lists])
    if element.name == "triangles":
        if len(corners) % 3:
            raise values.error(element, f"<triangles> has {len(corners)} corners, not 3 each")
        _check_count(document, element, len(corners) // 3, "triangles")
        return corners.reshape(-1, 3)
    if element.name == "polygons":
        _check_count(document, element, len(lists), "polygons")
        counts = np.array([len(each) for each in lists], dtype=np.int64)
    else:
        listed = element.first("vcount")
        counts = np.zeros(0, dtype=np.int64) if listed is None else values.indices(listed)
        _check_count(document, element, len(counts), "polygons")
        # As whole numbers of Python, which hold any sum.
        if sum(counts.tolist()) != len(corners):
            fault = f"<vcount> counts {sum(counts.tolist())} corners, <p> has {len(corners)}"
            raise values.error(element, fault)
    whole = _with_surface(document, _Polygons(corners, counts))
    return triangulated(document.source, points, whole.corners, whole.counts)


def _with_surface(document: Document, polygons: _Polygons) -> _Polygons:
    """Return the polygons of three corners or more."""
    has_surface = polygons.counts >= 3
    left = int(np.count_nonzero(~has_surface))
    if not left:
        return polygons
    what = counted(left, "polygon")
    document.source.note(f"{what} of fewer than three corners left out: without surface")
    kept = np.repeat(has_surface, polygons.counts)
    return _Polygons(polygons.corners[kept], polygons.counts[has_surface])


def _check_count(document: Document, element: Element, found: int, what: str) -> None:
    claimed = document.values.count(element, "count", found)
    if claimed != found:
        fault = f"<{element.name}> claims {claimed} {what}, and has {found}"
        raise document.values.error(element, fault)


def _corners(document: Document, element: Element, points: int) -> Iterator[NDArray[np.int64]]:
    """Yield the numbers of vertices that each `p` of an element lists."""
    values = document.values
    inputs = list(element.named("input"))
    width = 1 + max(values.count(each, "offset", 0) for each in inputs)
    at = values.count(_vertex_input(document, element), "offset", 0)
    for each in element.children:
        if each.name == "ph":
            fault = "<ph> is a polygon with holes, which is not read"
            raise values.error(each, fault, "triangulate it on export")
        if each.name != "p":
            continue
        listed = values.indices(each)
        if len(listed) % width:
            fault = f"<p> has {len(listed)} numbers, expected a multiple of {width}"
            raise values.error(each, fault)
        corners = listed[at::width]
        if len(corners) and corners.max() >= points:
            fault = f"<p> names vertex {corners.max()}, the last one is {points - 1}"
            raise values.error(each, fault)
        yield corners


def _fan(corners: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return a fan's triangles, all with its first corner."""
    if len(corners) < 3:
        return _none()
    first = np.repeat(corners[:1], len(corners) - 2)
    return np.stack([first, corners[1:-1], corners[2:]], axis=1)


def _strip(corners: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return a strip's triangles; every second one is turned over."""
    if len(corners) < 3:
        return _none()
    rows = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
    rows[1::2] = rows[1::2, [1, 0, 2]]
    return rows


def _none() -> NDArray[np.int64]:
    return np.zeros((0, 3), dtype=np.int64)
