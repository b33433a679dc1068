"""A zone of a Tecplot file: its kind and size, its points and its cells."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.number_rows import blank_rows
from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.formats.tecplot.header import Zone
    from obbcli.mesh.source import Source

#: Kinds of finite elements with their cells here; older files say them by ET without "FE".
_ELEMENTS: dict[str, tuple[str | None, int]] = {
    "FELINESEG": (None, 2),
    "FETRIANGLE": ("triangle", 3),
    "FEQUADRILATERAL": ("quad", 4),
    "FETETRAHEDRON": ("tetra", 4),
    "FEBRICK": ("hexahedron", 8),
}
_SAID_DIFFERENTLY = {"FEQUADRILATERALS": "FEQUADRILATERAL", "FETETRAHEDRA": "FETETRAHEDRON"}
_REPEATED = re.compile(rb"(\d+)\*(\S+)")


class Layout(NamedTuple):
    """Holds what a zone's header says of its numbers.

    Args:
        cell: name of its cells in `CELLS`; None for points and lines.
        is_ordered: whether its points make a grid of `shape`, the first index running fastest.
        shape: (I, J, K) of an ordered zone.
        points: how many it has; None where the header of a curve does not say.
        cells: likewise; of an ordered zone those between its points.
        nodes: corners of a cell in its connectivity; 0 where it has none of its own.
        is_block: whether the numbers come variable by variable, not point by point.
    """

    cell: str | None
    is_ordered: bool
    shape: tuple[int, int, int]
    points: int | None
    cells: int
    nodes: int
    is_block: bool


def layout_of(source: Source, zone: Zone, width: int) -> Layout:
    """Return what a header says of its zone's numbers.

    Raises:
        MeshError: a kind of zone that is not read, a count that is missing; with the line.
    """
    packing = zone.keys.get("DATAPACKING", zone.keys.get("F", "")).strip('"').upper()
    if packing not in ("", "POINT", "BLOCK", "FEPOINT", "FEBLOCK"):
        raise _refused(source, zone, f"the packing {packing[:40]} is not known", "POINT or BLOCK")
    kind = zone.keys.get("ZONETYPE", "").strip('"').upper()
    if not kind and "ET" in zone.keys:
        kind = f"FE{zone.keys['ET'].upper().removeprefix('FE')}"
    kind = _SAID_DIFFERENTLY.get(kind, kind)
    if kind in ("", "ORDERED") and not packing.startswith("FEPOINT"):
        return _ordered(source, zone, packing, width)
    if kind not in _ELEMENTS:
        remedy = "save it as triangles, quadrilaterals, tetrahedra or bricks"
        raise _refused(source, zone, f"a zone of type {kind[:40] or packing} is not read", remedy)
    points = _count(source, zone, "NODES", "N")
    cells = _count(source, zone, "ELEMENTS", "E")
    if packing.endswith("BLOCK"):
        is_block = True
    else:
        is_block = not packing and _is_block(source, zone, width, points)
    cell, nodes = _ELEMENTS[kind]
    cell = cell if points and cells else None
    own = 0 if "CONNECTIVITYSHAREZONE" in zone.keys else nodes
    return Layout(cell, False, (points, 1, 1), points, cells, own, is_block)


def _ordered(source: Source, zone: Zone, packing: str, width: int) -> Layout:
    sizes = [_count(source, zone, key, default=1) for key in "IJK"]
    long = sum(size > 1 for size in sizes)
    cell = (None, None, "quad", "hexahedron")[long if all(sizes) else 0]
    known = any(key in zone.keys for key in "IJK")
    points = sizes[0] * sizes[1] * sizes[2]
    cells = int(np.prod([max(size - 1, 1) for size in sizes], dtype=object))
    is_block = packing.endswith("BLOCK")
    if cell is not None and not packing:
        is_block = _is_block(source, zone, width, points)
    shape = (sizes[0], sizes[1], sizes[2])
    return Layout(cell, True, shape, points if known else None, cells, 0, is_block)


def _is_block(source: Source, zone: Zone, width: int, points: int) -> bool:
    """Return False where each line holds a point's numbers; refuse what could be either."""
    lines = [line for line in zone.data.split(b"\n")[: points + 1] if line.strip()][:points]
    counts = {len(line.replace(b",", b" ").split()) for line in lines}
    if zone.shared or zone.cell_centred or counts != {width} or width == points or len(lines) < 2:
        raise _refused(
            source, zone, "the zone names no DATAPACKING", "write DATAPACKING=POINT or BLOCK"
        )
    return False


def _count(source: Source, zone: Zone, *keys: str, default: int | None = None) -> int:
    """Return a count under one of several keys, at most as large as the file is."""
    word = next((zone.keys[key] for key in keys if key in zone.keys), None)
    if word is None and default is not None:
        return default
    name = " or ".join(keys)
    if word is None:
        raise _refused(source, zone, f"the zone has no {name}", "write its counts")
    value = int(word) if word.isdecimal() and len(word) < 16 else -1
    if not 0 <= value <= len(source.data):
        fault = f"{name}={word[:40]}, but the file has {len(source.data)} bytes"
        raise _refused(source, zone, fault, "it was cut short, or its counts are wrong")
    return value


class Numbers(NamedTuple):
    """Holds the numbers of a zone.

    Args:
        variables: by variable, from 0: its values, (points,) or (cells,); those the zone has.
        cells: int64 (cells, nodes), from 0; None where it has no connectivity of its own.
    """

    variables: dict[int, NDArray[np.float64]]
    cells: NDArray[np.int64] | None


def numbers_of(source: Source, zone: Zone, layout: Layout, width: int) -> Numbers:
    """Return the variables and the connectivity that stand in a zone.

    Raises:
        MeshError: too few numbers, or too many; a word that is none; with the line.
    """
    own = [at for at in range(width) if at not in zone.shared and at not in zone.passive]
    points = layout.points or 0
    sizes = [layout.cells if at in zone.cell_centred else points for at in own]
    if zone.cell_centred and not layout.is_block:
        fault = "values at cell centres in a zone that is packed point by point"
        raise _refused(source, zone, fault, "save it with DATAPACKING=BLOCK")
    total, corners = sum(sizes), layout.cells * layout.nodes
    values = _values(source, zone, total + corners)
    if len(values) < total + corners:
        fault = f"the zone has {len(values)} numbers, {total + corners} wanted"
        raise _refused(source, zone, fault, "it was cut short, or its counts are wrong")
    if len(values) > total + corners and "FACENEIGHBORCONNECTIONS" not in zone.keys:
        fault = f"the zone has {len(values)} numbers or more, {total + corners} wanted"
        raise _refused(source, zone, fault, "correct its counts")
    if layout.is_block:
        pieces = np.split(values[:total], np.cumsum(sizes)[:-1]) if own else []
    else:
        pieces = list(values[:total].reshape(points, len(own)).T)
    cells = None
    if layout.nodes:
        cells = _connectivity(source, zone, values[total : total + corners], points)
        cells = cells.reshape(-1, layout.nodes)
    return Numbers(dict(zip(own, pieces, strict=True)), cells)


def _connectivity(
    source: Source, zone: Zone, values: NDArray[np.float64], points: int
) -> NDArray[np.int64]:
    """Return the corners of cells, from 0."""
    wrong = ~((values >= 1) & (values <= points) & (values == np.floor(values)))
    if wrong.any():
        value = values[np.argmax(wrong)]
        fault = f"a cell uses point {value:.17g} of {points}"
        raise _refused(source, zone, fault, "points are counted from 1 in each zone")
    return values.astype(np.int64) - 1


def _values(source: Source, zone: Zone, wanted: int) -> NDArray[np.float64]:
    """Return the numbers of a zone, those written as 3*0.5 as often as they stand for."""
    text = zone.data.replace(b",", b" ") if b"," in zone.data else zone.data
    lines = text.split(b"\n")
    if b"*" not in text:
        return blank_rows(source, lines, zone.first).values
    expanded, size = [], 0
    for number, line in enumerate(lines, start=zone.first):
        words: list[bytes] = []
        for word in line.split():
            match = _REPEATED.fullmatch(word)
            times = int(match[1]) if match and len(match[1]) < 16 else 1
            if size + len(words) + times > max(wanted, len(text)):
                fault = f"'{shown(word)}' repeats more numbers than the zone has"
                raise source.error(fault, "its counts are wrong", at=str(number))
            words += [match[2]] * times if match else [word]
        size += len(words)
        expanded.append(b" ".join(words))
    return blank_rows(source, expanded, zone.first).values


def _refused(source: Source, zone: Zone, fault: str, remedy: str) -> MeshError:
    return source.error(fault, remedy, at=str(zone.line))
