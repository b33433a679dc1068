"""Nodes and elements that an Abaqus deck generates: *NGEN, *NFILL, *NCOPY, *ELGEN, *ELCOPY.

What is read of each is said at its function; other parameters are refused by name. The rules are
those of "Node definition" and "Element definition", Abaqus Analysis User's Guide.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.abaqus.scope import Elements
from obbcli.mesh.formats.abaqus.sections import check_options, checked_number, whole_word
from obbcli.mesh.formats.abaqus.sets import members
from obbcli.mesh.formats.abaqus.systems import placement
from obbcli.mesh.formats.number_rows import comma_rows, whole_numbers
from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.formats.abaqus.scope import Scope
    from obbcli.mesh.formats.abaqus.sections import Section

#: Most nodes and elements that a part may generate: a slip of a key must not fill the memory.
_MOST = 5_000_000
#: Radii of an arc's ends may differ by so much, as coordinates are rounded when they are written.
_ROUND = 1e-4
_WRITE_OUT = "write the nodes and elements out, each with its number"


def generate_nodes(scope: Scope, section: Section) -> None:
    """Take *NGEN: nodes between two nodes at equal intervals, on a straight line or an arc.

    Each line of data: the first and the last node, the increment of the numbers (1), and with
    LINE=C the node in the middle of the circle, or none and its place.

    Raises:
        MeshError: parabolas, arcs of 180 degrees and more, a node that is not defined; with the
            line.
    """
    check_options(section, {"NSET", "LINE"})
    is_arc = section.label("LINE") == "C"
    if "LINE" in section.options and not is_arc:
        fault = f"*NGEN with LINE={section.label('LINE')[:20]} is not read"
        raise section.source.error(fault, _WRITE_OUT, at=str(section.line))
    numbers, places = [], []
    for line, words, rest in _whole_lines(section, 4 if is_arc else 3, 3 if is_arc else 0):
        first, last = _given(section, line, *words[:2])
        step = 1 if words[2] is None else words[2]
        intervals = (last - first) // step if step else 0
        if intervals < 1 or first + intervals * step != last:
            fault = f"*NGEN from node {first} to {last} by steps of {step} meets no number"
            raise section.source.error(fault, "write whole steps", at=line)
        _check_size(scope, section, line, intervals)
        a, b = _place(scope, section, line, first), _place(scope, section, line, last)
        share = np.arange(intervals + 1)[:, np.newaxis] / intervals
        numbers.append(first + step * np.arange(intervals + 1, dtype=np.int64))
        if is_arc:
            center = _center(scope, section, line, words[3], rest)
            places.append(_arc(section, line, (a, b, center), share))
        else:
            places.append(a + share * (b - a))
        places[-1][-1] = b
    for row_numbers, row_places in zip(numbers, places, strict=True):
        scope.add_nodes(row_numbers, row_places, section.label("NSET"))


def fill_nodes(scope: Scope, section: Section) -> None:
    """Take *NFILL: nodes on straight lines between the nodes of two sets, at equal intervals.

    Each line of data: the two sets, the count of intervals, and the increment of the numbers from
    the first set on.

    Raises:
        MeshError: BIAS, SINGULAR and TWO STEP, sets of different sizes; with the line.
    """
    check_options(section, {"NSET"})
    source = section.source
    for number, content in enumerate(section.data.split(b"\n"), start=section.first):
        words = [word.strip() for word in content.split(b",")]
        if not any(words):
            continue
        line = str(number)
        if len([word for word in words if word]) != 4:
            fault = f"*NFILL wants two sets, intervals and an increment, not '{shown(content)}'"
            raise source.error(fault, _WRITE_OUT, at=line)
        a, b = (members(scope.sets, section, line, word, {}) for word in words[:2])
        intervals, step = (whole_word(section, word, number, "*NFILL: ") for word in words[2:4])
        if len(a) != len(b) or intervals < 1:
            fault = f"*NFILL between {len(a)} and {len(b)} nodes, in {intervals} intervals"
            raise source.error(fault, "bound it by two sets of as many nodes", at=line)
        _check_size(scope, section, line, intervals * len(a))
        start, end = _places(scope, section, line, a), _places(scope, section, line, b)
        for k in range(1, intervals):
            places = start + (end - start) * (k / intervals)
            scope.add_nodes(a + k * step, places, section.label("NSET"))
        for bound, places in ((a, start), (b, end)) if section.label("NSET") else ():
            scope.add_nodes(bound, places, section.label("NSET"))


def copy_nodes(scope: Scope, section: Section) -> None:
    """Take *NCOPY with SHIFT: a copy of a set, moved once, then turned MULTIPLE times.

    Raises:
        MeshError: other kinds of copies; with the line.
    """
    check_options(section, {"CHANGENUMBER", "OLDSET", "NEWSET", "SHIFT", "MULTIPLE"})
    line = str(section.line)
    added = _option(section, "CHANGENUMBER")
    if "SHIFT" not in section.options:
        raise section.source.error("*NCOPY without SHIFT is not read", _WRITE_OUT, at=line)
    old = members(scope.sets, section, line, _named(section, "OLDSET"), {})
    _check_size(scope, section, line, max(len(old), 1))
    times = _option(section, "MULTIPLE") if "MULTIPLE" in section.options else 1
    places = placement(section, times).placed(_places(scope, section, line, old))
    scope.add_nodes(old + added, places, section.label("NEWSET"))


def generate_elements(scope: Scope, section: Section) -> None:
    """Take *ELGEN: elements in rows, planes and layers, after one that is defined.

    Each line of data: the element; for rows, planes and layers in turn how many with the first,
    the increments of the numbers of nodes and of elements (1 and 1 for rows).

    Raises:
        MeshError: an element that is not defined, an increment that is not given; with the line.
    """
    check_options(section, {"ELSET", "ALLNODES"})
    for line, words, _ in _whole_lines(section, 10):
        block, row = _element(scope, section, line, _given(section, line, words[0])[0])
        numbers, nodes = block.numbers[row : row + 1], block.nodes[row : row + 1]
        first_steps = [1 if word is None else word for word in words[2:4]]
        steps: list[list[int | None]] = [[*first_steps], words[5:7], words[8:10]]
        for word, step_words in zip(words[1::3], steps, strict=True):
            count = 1 if word is None else word
            if count == 1:
                continue
            node_step, step = _given(section, line, *step_words)
            _check_size(scope, section, line, count * len(numbers))
            k = np.arange(count, dtype=np.int64)[:, np.newaxis]
            numbers = (numbers + k * step).reshape(-1)
            nodes = (nodes + k[:, np.newaxis] * node_step).reshape(len(numbers), nodes.shape[1])
        lines = np.full(len(numbers) - 1, int(line), dtype=np.int64)
        made = Elements(block.section, block.shape, numbers[1:], nodes[1:], lines)
        scope.add_elements(made, section.label("ELSET"))
        if section.label("ELSET"):
            scope.element_sets[section.label("ELSET")].append(numbers[:1])


def copy_elements(scope: Scope, section: Section) -> None:
    """Take *ELCOPY: copies of a set of elements, by increments of their numbers and nodes.

    Raises:
        MeshError: REFLECT, an element that is not defined; with the line.
    """
    check_options(section, {"ELEMENTSHIFT", "OLDSET", "NEWSET", "SHIFTNODES"})
    line = str(section.line)
    step, node_step = _option(section, "ELEMENTSHIFT"), _option(section, "SHIFTNODES")
    name = _named(section, "OLDSET")
    numbers = members(scope.element_sets, section, line, name, {})
    _check_size(scope, section, line, max(len(numbers), 1))
    for number in numbers.tolist():
        block, row = _element(scope, section, line, number)
        copy, nodes = block.numbers[row : row + 1] + step, block.nodes[row : row + 1] + node_step
        lines = np.full(1, section.line, dtype=np.int64)
        made = Elements(block.section, block.shape, copy, nodes, lines)
        scope.add_elements(made, section.label("NEWSET"))


def _whole_lines(
    section: Section, most: int, more: int = 0
) -> Iterator[tuple[str, list[int | None], NDArray[np.float64]]]:
    """Yield each line's number, its whole numbers, and those after them that need not be whole.

    Args:
        section: the keyword.
        most: how many whole numbers a line has at most; None for those left out.
        more: how many numbers follow at most; NaN for those left out.
    """
    rows = comma_rows(section.source, section.data, section.first)
    table = rows.table(most + more)
    whole_numbers(section.source, rows, np.nan_to_num(table[:, :most]), f"*{section.keyword}:")
    for line, count, row in zip(rows.lines.tolist(), rows.counts.tolist(), table, strict=True):
        if count > most + more:
            fault = f"*{section.keyword} with {count} fields, at most {most + more} are read"
            raise section.source.error(fault, _WRITE_OUT, at=str(line))
        words = [None if np.isnan(word) else int(word) for word in row[:most]]
        yield str(line), words, row[most:]


def _center(
    scope: Scope, section: Section, line: str, node: int | None, place: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the middle of an arc: a node's place, or one that is written out."""
    if node:
        return _place(scope, section, line, _given(section, line, node)[0])
    if np.isnan(place).all() or scope.system is not None:
        what = "within *SYSTEM" if scope.system is not None else "without the middle of its circle"
        raise section.source.error(f"*NGEN {what} is not read", "name a node in it", at=line)
    return np.nan_to_num(place)


def _arc(
    section: Section,
    line: str,
    ends: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    share: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return places at equal angles between two about a third, (N, 3).

    Args:
        section: the keyword.
        line: where the arc is asked for.
        ends: both ends and the middle of the circle.
        share: (N, 1), from 0 to 1.
    """
    a, b = ends[0] - ends[2], ends[1] - ends[2]
    radius, other = float(np.linalg.norm(a)), float(np.linalg.norm(b))
    across = b - a * (float(a @ b) / radius**2 if radius else 0.0)
    length = float(np.linalg.norm(across))
    if not abs(radius - other) <= _ROUND * radius or length <= _ROUND * radius:
        fault = f"*NGEN of an arc between radii {radius:.9g} and {other:.9g}, or of 180 degrees"
        raise section.source.error(fault, _WRITE_OUT, at=line)
    angle = float(np.arctan2(length, float(a @ b) / radius)) * share
    stretch = 1.0 + share * (other / radius - 1.0)
    return ends[2] + stretch * (np.cos(angle) * a + np.sin(angle) * across * (radius / length))


def _given(section: Section, line: str, *words: int | None) -> list[int]:
    """Return numbers that may not be left out."""
    given = [word for word in words if word is not None]
    if len(given) < len(words):
        fault = f"a number of *{section.keyword} is left out"
        raise section.source.error(fault, "write it out", at=line)
    return [checked_number(section, word, int(line)) for word in given]


def _option(section: Section, name: str) -> int:
    """Return a parameter that is a whole number."""
    word = section.options.get(name, "").encode("latin-1", "replace")
    return whole_word(section, word, section.line, f"*{section.keyword}: {name}")


def _named(section: Section, option: str) -> bytes:
    return section.label(option).encode("latin-1", "replace")


def _check_size(scope: Scope, section: Section, line: str, size: int) -> None:
    scope.generated += size
    if size < 1 or scope.generated > _MOST:
        fault = f"*{section.keyword} makes {size} nodes or elements; a part may have {_MOST}"
        raise section.source.error(fault, "check its numbers", at=line)


def _place(scope: Scope, section: Section, line: str, number: int) -> NDArray[np.float64]:
    place = scope.place_of(number)
    if place is None:
        raise _undefined(section, line, f"node {number}")
    return place


def _places(
    scope: Scope, section: Section, line: str, numbers: NDArray[np.int64]
) -> NDArray[np.float64]:
    places = [_place(scope, section, line, number) for number in numbers.tolist()]
    return np.array(places, dtype=np.float64).reshape(-1, 3)


def _element(scope: Scope, section: Section, line: str, number: int) -> tuple[Elements, int]:
    found = scope.element_of(number)
    if found is None:
        raise _undefined(section, line, f"element {number}")
    return found


def _undefined(section: Section, line: str, what: str) -> MeshError:
    fault = f"*{section.keyword} uses {what}, which is not defined before it"
    return section.source.error(fault, "define it first", at=line)
