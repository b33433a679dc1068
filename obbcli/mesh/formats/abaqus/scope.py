"""Nodes, elements and node sets of one part, instance or flat deck of Abaqus.

Numbers are unique within a scope. Of a node or element that is defined more than once the last
definition counts ("Node definition", "Element definition", Abaqus Analysis User's Guide).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.abaqus.elements import shape_of
from obbcli.mesh.formats.abaqus.sections import check_options
from obbcli.mesh.formats.abaqus.systems import LocalSystem, from_cylindrical
from obbcli.mesh.formats.number_rows import comma_rows, whole_numbers

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from obbcli.mesh.formats.abaqus.elements import Shape
    from obbcli.mesh.formats.abaqus.sections import Section
    from obbcli.mesh.formats.number_rows import Rows

#: A line of nodes with at least so many numbers goes on in the next one without a comma, too:
#: CalculiX wants none.
_LONG_LINE = 8
#: What defines no nodes and no elements.
_WITHOUT_MESH = frozenset(("NSET", "ELSET", "SYSTEM"))
#: A node has a number, three coordinates and three components of a normal.
_NODE_FIELDS = 7


class Elements(NamedTuple):
    """Holds elements of one type, in the order of the file.

    Args:
        section: the keyword that made them.
        shape: what they are.
        numbers: int64 (N,).
        nodes: int64 (N, nodes), numbers of nodes; (N, 0) where they have no surface.
        lines: int64 (N,), where each begins.
    """

    section: Section
    shape: Shape
    numbers: NDArray[np.int64]
    nodes: NDArray[np.int64]
    lines: NDArray[np.int64]


class Scope:
    """Holds what a part, an instance or a flat deck defines.

    Args:
        name: of the part or instance; "" for a flat deck and for the assembly itself.
    """

    def __init__(self, name: str = "") -> None:
        self.name = name
        self.numbers: list[NDArray[np.int64]] = []
        self.places: list[NDArray[np.float64]] = []
        self.elements: list[Elements] = []
        self.sets: dict[str, list[NDArray[np.int64] | Section]] = {}
        self.element_sets: dict[str, list[NDArray[np.int64] | Section]] = {}
        self.system: LocalSystem | None = None
        self.generated = 0
        self._places: dict[int, NDArray[np.float64]] = {}
        self._elements: dict[int, tuple[Elements, int]] = {}
        self._indexed = 0, 0
        self._kept: list[tuple[Callable[[Scope, Section], None], Section]] = []
        #: Whether elements were given that may have faces.
        self.has_surface = False
        #: Whether no nodes and elements were given: sets alone change no surface.
        self.is_empty = True

    def keep(self, reader: Callable[[Scope, Section], None], section: Section) -> None:
        """Keep a keyword and what reads it until the scope is read."""
        self._kept.append((reader, section))
        self.is_empty &= section.keyword in _WITHOUT_MESH
        if section.keyword == "ELEMENT" and section.data.strip():
            shape = shape_of(section.label("TYPE"))
            self.has_surface |= shape is None or shape.cell is not None

    def read(self) -> None:
        """Read what was kept, once.

        Raises:
            MeshError: it is not read, or damaged; with the line.
        """
        while self._kept:
            reader, section = self._kept[0]
            reader(self, section)
            del self._kept[0]

    def place_of(self, number: int) -> NDArray[np.float64] | None:
        """Return where a node stands that has been defined so far, (3,), or None."""
        nodes, elements = self._indexed
        for numbers, places in zip(self.numbers[nodes:], self.places[nodes:], strict=True):
            self._places.update(zip(numbers.tolist(), places, strict=True))
        self._indexed = len(self.numbers), elements
        return self._places.get(number)

    def element_of(self, number: int) -> tuple[Elements, int] | None:
        """Return the elements that one defined so far is among, and its row there, or None."""
        nodes, elements = self._indexed
        for block in self.elements[elements:]:
            rows = ((block, row) for row in range(len(block.numbers)))
            self._elements.update(zip(block.numbers.tolist(), rows, strict=True))
        self._indexed = nodes, len(self.elements)
        return self._elements.get(number)

    def read_nodes(self, section: Section) -> None:
        """Take the nodes of *NODE.

        Raises:
            MeshError: a parameter that is not read, a field that is no number; with the line.
        """
        check_options(section, {"NSET", "INPUT", "SYSTEM"})
        source = section.source
        rows = comma_rows(source, section.data, section.first)
        if (rows.counts > _NODE_FIELDS).any():
            at = int(np.argmax(rows.counts > _NODE_FIELDS))
            fault = f"a node with {rows.counts[at]} fields, at most {_NODE_FIELDS} wanted"
            raise source.error(fault, "put each node on a line of its own", at=str(rows.lines[at]))
        table = rows.table(4)
        numbers = whole_numbers(source, rows, table[:, 0], "the number of a node")
        places = np.nan_to_num(table[:, 1:])
        kind = section.label("SYSTEM") or "R"
        if kind == "C":
            places = from_cylindrical(places)
        elif kind != "R":
            fault = f"*NODE with SYSTEM={kind[:20]} is not read"
            raise source.error(fault, "give rectangular coordinates", at=str(section.line))
        if self.system is not None:
            places = self.system.placed(places)
        self.add_nodes(numbers, places, section.label("NSET"))

    def add_nodes(
        self, numbers: NDArray[np.int64], places: NDArray[np.float64], name: str = ""
    ) -> None:
        """Add nodes, and add them to a set where it has a name."""
        self.numbers.append(numbers)
        self.places.append(places)
        if name:
            self.sets.setdefault(name, []).append(numbers)

    def read_elements(self, section: Section) -> None:
        """Take the elements of *ELEMENT.

        Raises:
            MeshError: a type or parameter that is not read, a wrong count of nodes; with the line.
        """
        check_options(section, {"TYPE", "ELSET", "INPUT"})
        source, kind = section.source, section.label("TYPE")
        shape = shape_of(kind)
        if shape is None:
            what = f"elements of type '{kind[:20]}' are" if kind else "*ELEMENT without a TYPE is"
            remedy = "convert them to elements such as S3, S4, C3D4 or C3D8, or remove them"
            raise source.error(f"{what} not read", remedy, at=str(section.line))
        if shape.cell is None:
            elements = _without_surface(section, shape)
        else:
            rows = comma_rows(source, section.data, section.first)
            starts = _records(section, shape, rows)
            whole = whole_numbers(source, rows, rows.values, "a number of an element or node")
            table = whole.reshape(-1, 1 + shape.nodes)
            elements = Elements(section, shape, table[:, 0], table[:, 1:], rows.lines[starts])
        self.add_elements(elements, section.label("ELSET"))

    def add_elements(self, elements: Elements, name: str = "") -> None:
        """Add elements, and add them to a set where it has a name."""
        self.elements.append(elements)
        if name:
            self.element_sets.setdefault(name, []).append(elements.numbers)


def _records(section: Section, shape: Shape, rows: Rows) -> NDArray[np.int64]:
    """Return which lines begin elements, after a look whether all have as many nodes as wanted."""
    width = 1 + shape.nodes
    starts = rows.starts
    ends = starts + rows.counts
    within = ends % width
    # An element that is not yet whole goes on in the next line; a line begins no second element.
    goes_on = rows.open | (rows.counts >= _LONG_LINE)
    goes_on[-1:] = False
    wrong = (starts // width != (ends - 1) // width) | ((within != 0) & ~goes_on)
    if wrong.any():
        at = int(np.argmax(wrong))
        first = int(np.flatnonzero(starts[: at + 1] % width == 0)[-1])
        last = at if first == at or rows.open[at - 1] else at - 1
        found = int(rows.counts[first : last + 1].sum()) - 1
        raise section.source.error(
            f"an element of type {section.label('TYPE')} with {found} nodes, {shape.nodes} wanted",
            "write the file again",
            at=str(int(rows.lines[first])),
        )
    return np.flatnonzero(starts % width == 0)


def _without_surface(section: Section, shape: Shape) -> Elements:
    """Return elements of which only the numbers matter: they may take the place of others."""
    lines = [line.strip() for line in section.data.split(b"\n")]
    at = [
        number
        for number, line in enumerate(lines)
        if line and (number == 0 or not lines[number - 1].endswith(b","))
    ]
    words = [lines[number].partition(b",")[0].strip() for number in at]
    numbers = [int(word) if word.isdigit() and len(word) < 16 else -1 for word in words]
    return Elements(
        section,
        shape,
        np.array(numbers, dtype=np.int64),
        np.zeros((len(numbers), 0), dtype=np.int64),
        np.array(at, dtype=np.int64) + section.first,
    )
