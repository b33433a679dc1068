"""AVS UCD meshes in ASCII (.avs, .inp), read by our own reader.

meshio leaves comments out of the count of lines, and takes a second file of another format by the
same suffix. The format: "UCD", AVS Developer's Guide, appendix E.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.cells.parts import CellPart, joined_surface
from obbcli.mesh.formats.cells.surface import Block
from obbcli.mesh.formats.number_rows import blank_rows, whole_numbers
from obbcli.mesh.formats.text import shown, strip_mark

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.formats.number_rows import Rows
    from obbcli.mesh.source import MeshArrays, Source

#: Names of cells, with theirs here and the order of their corners there: a pyramid's apex is first.
_CELLS: dict[bytes, tuple[str | None, tuple[int, ...]]] = {
    b"pt": (None, (0,)),
    b"line": (None, (0, 1)),
    b"tri": ("triangle", (0, 1, 2)),
    b"quad": ("quad", (0, 1, 2, 3)),
    b"tet": ("tetra", (0, 1, 2, 3)),
    b"pyr": ("pyramid", (1, 2, 3, 4, 0)),
    b"prism": ("wedge", (0, 1, 2, 3, 4, 5)),
    b"hex": ("hexahedron", tuple(range(8))),
}
_BINARY = b"\x07"
_HEADER = re.compile(rb"[ \t]*\d+([ \t]+\d+){4}[ \t]*")


def begins_as_ucd(data: bytes) -> bool:
    """Return whether the first line that is no comment has the five counts of a UCD mesh."""
    if data.startswith(_BINARY):
        return True
    for match in re.finditer(rb"[^\r\n]+", strip_mark(data)):
        line = match[0].strip()
        if line and not line.startswith(b"#"):
            return _HEADER.fullmatch(line) is not None
    return False


def read_ucd(source: Source) -> MeshArrays:
    """Return the surface of a mesh: flat cells in order, then what else bounds its volumes.

    Raises:
        MeshError: binary files, files of several steps, an unknown cell, counts that do not fit,
            a node that is not there; with the line.
    """
    if source.data.startswith(_BINARY):
        raise source.error("is binary UCD, which is not read", "save it as ASCII UCD, or as VTK")
    lines = strip_mark(source.data).splitlines()
    first = next((at for at, line in enumerate(lines) if line.partition(b"#")[0].strip()), 0)
    if not lines or _HEADER.fullmatch(lines[first]) is None:
        begin = shown(lines[first].strip()) if lines else ""
        fault = f"'{begin}' where a UCD mesh has its five counts"
        remedy = "of files with several steps write one step; else export it again"
        raise source.error(fault, remedy, at=str(first + 1))
    header = blank_rows(source, [lines[first]], first + 1)
    counts = whole_numbers(source, header, header.values, "a count")
    node_count, cell_count = counts[:2].tolist()
    cells = first + 1 + node_count
    if cells + cell_count > len(lines):
        fault = f"has {node_count} nodes and {cell_count} cells, but {len(lines)} lines in all"
        raise source.error(fault, "it was cut short, or its counts are wrong", at=str(first + 1))
    _check_end(source, lines, cells + cell_count, has_data=bool(counts[2:].any()))
    numbers, points = _nodes(source, lines[first + 1 : cells], first + 2)
    blocks = [*_cells(source, lines[cells : cells + cell_count], cells + 1, numbers)]
    return joined_surface(source, [CellPart("", points, blocks)])


def _check_end(source: Source, lines: list[bytes], end: int, *, has_data: bool) -> None:
    """Refuse lines after the counted cells where the header has no data, or that are cells."""
    rest = [at for at in range(end, len(lines)) if lines[at].strip()][:1]
    words = lines[rest[0]].split(None, 3) if rest else []
    if words and (not has_data or (len(words) == 4 and words[2].lower() in _CELLS)):
        fault = f"'{shown(lines[rest[0]].strip())}' after the cells that the header counts"
        raise source.error(fault, "correct the counts", at=str(rest[0] + 1))


def _nodes(
    source: Source, lines: list[bytes], first: int
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return numbers (V,) and places (V, 3) of the nodes."""
    rows = blank_rows(source, lines, first)
    if len(rows.counts) < len(lines) or (rows.counts != 4).any():
        wrong = rows.counts != 4
        at = int(rows.lines[np.argmax(wrong)]) if wrong.any() else first
        raise source.error("a node is not a number and three coordinates", at=str(at))
    table = rows.table(4)
    numbers = whole_numbers(source, rows, table[:, 0], "the number of a node")
    finite = np.isfinite(table).all(axis=1)
    if not finite.all():
        at = int(rows.lines[np.argmin(finite)])
        raise source.error("a node is not finite", "coordinates must be finite", at=str(at))
    ordered = np.sort(numbers)
    if (ordered[1:] == ordered[:-1]).any():
        twice = int(ordered[1:][ordered[1:] == ordered[:-1]][0])
        raise source.error(f"node {twice} is there twice", "number each node once")
    return numbers, table[:, 1:].copy()


def _cells(
    source: Source, lines: list[bytes], first: int, numbers: NDArray[np.int64]
) -> Iterator[Block]:
    """Yield the cells by type; a line has number, material, type and nodes."""
    words = [line.split(None, 3) for line in lines]
    for at, line in enumerate(words):
        if len(line) < 4 or line[2].lower() not in _CELLS:
            found = shown(line[2]) if len(line) > 2 else "too few words"
            remedy = f"{' '.join(name.decode() for name in _CELLS)} are read"
            raise source.error(f"a cell of type '{found}'", remedy, at=str(first + at))
    rows = blank_rows(source, [line[3] for line in words], first)
    nodes = whole_numbers(source, rows, rows.values, "a node of a cell")
    places = _rows_of(source, rows, nodes, numbers)
    spelled = [line[2].lower() for line in words]
    for word in dict.fromkeys(spelled):
        name, order = _CELLS[word]
        chosen = np.flatnonzero(np.fromiter((each == word for each in spelled), dtype=bool))
        wrong = rows.counts[chosen] != len(order)
        if wrong.any():
            at = int(chosen[np.argmax(wrong)])
            fault = f"a cell of type {word.decode()} with {rows.counts[at]} nodes"
            remedy = f"{len(order)} are wanted: cells of first order are read"
            raise source.error(fault, remedy, at=str(first + at))
        if name is not None:
            corners = rows.starts[chosen][:, np.newaxis] + np.array(order)
            yield Block(name, places[corners], chosen)


def _rows_of(
    source: Source, rows: Rows, nodes: NDArray[np.int64], numbers: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Return the rows of nodes by their numbers."""
    order = np.argsort(numbers, kind="stable")
    at = np.minimum(np.searchsorted(numbers[order], nodes), max(len(numbers) - 1, 0))
    found = order[at] if len(numbers) else np.zeros(len(nodes), dtype=np.int64)
    missing = numbers[found] != nodes if len(numbers) else np.ones(len(nodes), dtype=bool)
    if missing.any():
        worst = int(np.argmax(missing))
        raise _undefined(source, int(nodes[worst]), rows.line_of(worst))
    result: NDArray[np.int64] = found
    return result


def _undefined(source: Source, node: int, line: int) -> MeshError:
    fault = f"a cell uses node {node}, which is not there"
    return source.error(fault, "write the node, or remove the cell", at=str(line))
