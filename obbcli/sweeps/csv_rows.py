"""Rows of a CSV file: a line of column names, then cells of numbers."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING, NamedTuple

from obbcli.errors import ObbError
from obbcli.sweeps.row_fields import (
    FIELDS,
    VECTORS,
    Row,
    number_in,
    plain_vector,
    unknown,
    vector_in,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from obbcli.sweeps.row_fields import Values, Vector

_AXES = ("x", "y", "z")
_PARTS = {f"{name}_{axis}": (name, axis) for name in VECTORS for axis in _AXES}


class _Columns(NamedTuple):
    """Which cell holds what."""

    width: int
    cells: dict[str, int]
    parted: dict[str, tuple[int, int, int]]  # vectors whose numbers stand in columns of their own

    @classmethod
    def of(cls, names: Sequence[str], where: str) -> _Columns:
        """Return the meaning of a line of column names.

        Raises:
            ObbError: a name is unknown or stands there twice, or a vector lacks a part.
        """
        cells: dict[str, int] = {}
        for index, written in enumerate(names):
            name = written.strip()
            if name not in FIELDS and name not in _PARTS:
                raise unknown(name, where, "column", (*FIELDS, *_PARTS))
            if name in cells:
                raise ObbError(where, f"there are two columns {name!r}", "leave one of them out")
            cells[name] = index
        parted = {}
        for name in VECTORS:
            places = [cells.pop(f"{name}_{axis}", None) for axis in _AXES]
            x, y, z = places
            if x is not None and y is not None and z is not None:
                parted[name] = x, y, z
            elif places != [None] * 3:
                lacking = f"{name}_{_AXES[places.index(None)]}"
                raise ObbError(where, f"there is no column {lacking!r}", "give all three parts")
            if name in cells and name in parted:
                fault = f"columns {name!r} and '{name}_x' say the same"
                raise ObbError(where, fault, "leave one of them out")
        return cls(len(names), cells, parted)

    def values(self, cells: Sequence[str], where: str) -> Values:
        """Return what a row says; empty cells say nothing.

        Raises:
            ObbError: a cell is no number, or there are more or fewer cells than columns.
        """
        if len(cells) != self.width:
            fault = f"has {len(cells)} cells, and there are {self.width} columns"
            raise ObbError(where, fault, "give as many of each")
        values: dict[str, Vector | float] = {}
        for name, index in self.cells.items():
            text = cells[index].strip()
            if text and name != "id":
                place = f"{where}, column {name}"
                read = number_in if name == "duration" else vector_in
                values[name] = read(text, place)
        for name, places in self.parted.items():
            texts = [cells[index] for index in places]
            known = plain_vector(texts)
            if known is not None:
                values[name] = known
            elif any(text.strip() for text in texts):
                x, y, z = (
                    number_in(text.strip(), f"{where}, column {name}_{axis}")
                    for text, axis in zip(texts, _AXES, strict=True)
                )
                values[name] = x, y, z
        return values


def rows_of_csv(lines: Iterator[str], place: str) -> Iterator[Row]:
    """Yield the rows after the line of column names; blank lines are no rows.

    Raises:
        ObbError: there are no column names, or they are refused.
    """
    reader = csv.reader(lines, strict=True)
    columns: _Columns | None = None
    index = 0
    while True:
        line = reader.line_num + 1
        where = f"{place}:{line}"
        fault: ObbError | None = None
        try:
            cells = next(reader)
        except StopIteration:
            break
        except csv.Error as wrong:
            cells, fault = [], ObbError(where, f"is no line of CSV: {wrong}", "correct its quotes")
        if fault is None and len(cells) <= 1 and not "".join(cells).strip():
            continue
        if columns is None:
            if fault is not None:
                raise fault
            columns = _Columns.of(cells, where)
            continue
        yield _row(index, where, columns, cells, fault)
        index += 1
    if columns is None:
        raise ObbError(place, "is empty", "begin with a line of column names, such as id,vel,omega")


def _row(
    index: int, where: str, columns: _Columns, cells: Sequence[str], fault: ObbError | None
) -> Row:
    name = columns.cells.get("id")
    identity = cells[name] if name is not None and name < len(cells) else None
    if fault is None:
        try:
            return Row(index, where, identity, columns.values(cells, where))
        except ObbError as wrong:
            fault = wrong
    return Row(index, where, identity, {}, fault)
