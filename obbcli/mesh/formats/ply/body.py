"""The body of a PLY file as columns, ASCII and binary; claims are checked against its length."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.ply.short_lists import short_lists
from obbcli.mesh.formats.text import all_numbers, counted_rows, number, uniform_rows, whole

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.formats.ply.header import Element, Header, Property
    from obbcli.mesh.source import Source

    #: A property's values, and the length of each row's list (None where it is no list).
    Column = tuple[NDArray[Any], NDArray[np.int64] | None]
    Columns = dict[str, Column]
    Rows = list[tuple[int, list[bytes]]]


def read_ascii(source: Source, header: Header) -> dict[str, Columns]:
    """Return the columns of each element of an ASCII body, a row a line.

    Raises:
        MeshError: more or fewer lines than rows claimed, or a word that is no number.
    """
    lines = source.data[header.body :].splitlines()
    rows = [(n, words) for n, line in enumerate(lines, header.line) if (words := line.split())]
    claimed = sum(element.count for element in header.elements)
    if claimed > len(rows):
        raise source.error(
            f"the header claims {claimed} rows, but {len(rows)} lines follow",
            "it was cut short, or its counts are wrong",
        )
    if claimed < len(rows):
        raise source.error(
            f"the header claims {claimed} rows, and more follow", at=str(rows[claimed][0])
        )
    tables = {}
    begin = 0
    for element in header.elements:
        tables[element.name] = _ascii_element(source, element, rows[begin : begin + element.count])
        begin += element.count
    return tables


def _ascii_element(source: Source, element: Element, rows: Rows) -> Columns:
    """Return the columns of one element, its values rounded to the types declared."""
    columns = None
    if source.data.find(b"_", source.data.index(b"end_header") + len(b"end_header")) < 0:
        columns = _ascii_table(element, [words for _, words in rows])
    if columns is None:
        columns = _ascii_rows(source, element, rows)
    with np.errstate(over="ignore"):  # what is too large becomes infinite, and is refused later
        return {
            p.name: (
                columns[p.name][0].astype(p.kind) if p.kind.kind == "f" else columns[p.name][0],
                columns[p.name][1],
            )
            for p in element.properties
        }


def _ascii_table(element: Element, words: list[list[bytes]]) -> Columns | None:
    """Return the columns where all rows are numbers alike, or one list each, else None."""
    properties = element.properties
    if not element.has_lists:
        table = uniform_rows(words, len(properties))
        values = None if table is None else all_numbers(table)
        if values is None or any(p.kind.kind != "f" for p in properties):
            return None
        square = values.reshape(len(words), len(properties))
        return {p.name: (square[:, k], None) for k, p in enumerate(properties)}
    if len(properties) > 1 or properties[0].kind.kind == "f":
        return None
    found = counted_rows(words)
    return None if found is None else {properties[0].name: found}


def _ascii_rows(source: Source, element: Element, rows: Rows) -> Columns:
    """Return the columns row by row."""
    properties = element.properties
    values_of: list[list[float]] = [[] for _ in properties]
    lengths_of: list[list[int]] = [[] for _ in properties]
    for line, words in rows:
        _ascii_row(source, element, line, words, values_of, lengths_of)
    return {
        p.name: (
            np.array(values, dtype=np.int64 if p.kind.kind in "iu" else np.float64),
            None if p.count_kind is None else np.array(lengths, dtype=np.int64),
        )
        for p, values, lengths in zip(properties, values_of, lengths_of, strict=True)
    }


def _ascii_row(
    source: Source,
    element: Element,
    line: int,
    words: list[bytes],
    values_of: list[list[float]],
    lengths_of: list[list[int]],
) -> None:
    """Append one row's values and list lengths to those of the rows before it."""
    position = 0
    for prop, values, lengths in zip(element.properties, values_of, lengths_of, strict=True):
        count = 1
        if prop.count_kind is not None:
            if position >= len(words):
                raise _wrong_width(source, element, line, words)
            count = whole(source, words[position], line, "list length")
            if count < 0:
                raise source.error(f"list length {count} is negative", at=str(line))
            lengths.append(count)
            position += 1
        if position + count > len(words):
            raise _wrong_width(source, element, line, words)
        for word in words[position : position + count]:
            values.append(_ascii_value(source, prop, word, line))
        position += count
    if position != len(words):
        raise _wrong_width(source, element, line, words)


def _ascii_value(source: Source, prop: Property, word: bytes, line: int) -> float:
    """Return one value of its property's kind."""
    if prop.kind.kind == "f":
        return number(source, word, line)
    value = whole(source, word, line, prop.name)
    if abs(value) >= 2**63:
        raise source.error(f"{prop.name} {value} does not fit its type", at=str(line))
    return value


def _wrong_width(source: Source, element: Element, line: int, words: list[bytes]) -> MeshError:
    return source.error(
        f"{len(words)} words are not what a row of element {element.name} holds", at=str(line)
    )


def read_binary(source: Source, header: Header) -> dict[str, Columns]:
    """Return the columns of each element of a binary body.

    Raises:
        MeshError: the elements take more bytes than the file has, or fewer.
    """
    position = header.body
    tables = {}
    for element in header.elements:
        _check_fits(source, element, position)
        if element.has_lists:
            tables[element.name], position = _binary_lists(source, element, position)
        else:
            kind = np.dtype([(p.name, p.kind) for p in element.properties])
            table = np.frombuffer(source.data, kind, element.count, position)
            tables[element.name] = {p.name: (table[p.name], None) for p in element.properties}
            position += element.count * kind.itemsize
    if source.data[position:].strip():
        raise source.error(
            f"{len(source.data) - position} bytes follow the last element",
            "the header's counts are wrong",
            at=f"byte {position}",
        )
    return tables


def _check_fits(source: Source, element: Element, position: int) -> None:
    """Refuse a count that even the shortest rows could not have."""
    least = element.count * sum(p.least_size for p in element.properties)
    left = len(source.data) - position
    if not element.properties and element.count:
        raise source.error(f"element {element.name} has no properties", at=str(element.line))
    if least > left:
        raise source.error(
            f"{element.count} rows of element {element.name} take at least {least} bytes, "
            f"but {left} are left",
            "it was cut short, or its counts are wrong",
            at=f"byte {position}",
        )


def _binary_lists(source: Source, element: Element, position: int) -> tuple[Columns, int]:
    """Return the columns of an element with lists, and where it ends.

    Nearly always all rows are triangles: read as a table with the first row's lengths, which is
    kept if every row has them, and else row by row, those of one short list each in one go.
    """
    table, end = _binary_table(source, element, position)
    if table is not None:
        return table, end
    found = short_lists(source.data, element, position)
    if found is not None:
        return {element.properties[0].name: found[:2]}, found[2]
    values_of: list[list[float]] = [[] for _ in element.properties]
    lengths_of: list[list[int]] = [[] for _ in element.properties]
    data = source.data
    for row in range(element.count):
        for prop, values, lengths in zip(element.properties, values_of, lengths_of, strict=True):
            count = 1
            if prop.count_kind is not None:
                count = _binary_length(source, element, prop, row, position)
                lengths.append(count)
                position += prop.count_kind.itemsize
            end = position + count * prop.kind.itemsize
            if end > len(data):
                raise _cut_short(source, element, row, position)
            values += struct.unpack_from(_codes(prop.kind, count), data, position)
            position = end
    return {
        p.name: (
            np.array(values, dtype=p.kind.newbyteorder("=")),
            None if p.count_kind is None else np.array(lengths, dtype=np.int64),
        )
        for p, values, lengths in zip(element.properties, values_of, lengths_of, strict=True)
    }, position


def _binary_length(
    source: Source, element: Element, prop: Property, row: int, position: int
) -> int:
    """Return the length of the list at `position`."""
    assert prop.count_kind is not None
    if position + prop.count_kind.itemsize > len(source.data):
        raise _cut_short(source, element, row, position)
    count = int(struct.unpack_from(_codes(prop.count_kind, 1), source.data, position)[0])
    if count < 0:
        raise source.error(
            f"{element.name} {row}: list length {count} is negative", at=f"byte {position}"
        )
    return count


def _codes(kind: np.dtype[Any], count: int) -> str:
    """Return the `struct` codes of `count` values; its sizes are the standard ones."""
    order = ">" if kind.byteorder == ">" else "<"
    code = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "i8": "q", "u8": "Q"}
    letter = code.get(kind.str[1:]) or {"f4": "f", "f8": "d"}[kind.str[1:]]
    return f"{order}{count}{letter}"


def _cut_short(source: Source, element: Element, row: int, position: int) -> MeshError:
    return source.error(
        f"ends inside {element.name} {row} of {element.count}",
        "it was cut short, or its counts are wrong",
        at=f"byte {position}",
    )


def _binary_table(source: Source, element: Element, position: int) -> tuple[Columns | None, int]:
    """Return the columns if all rows have lists as long as the first row's, else None."""
    if element.count == 0:
        empty = np.zeros(0, dtype=np.int64)
        return {
            p.name: (np.zeros(0, p.kind), None if p.count_kind is None else empty)
            for p in element.properties
        }, position
    fields: list[tuple[str, Any] | tuple[str, Any, int]] = []
    lengths = {}
    offset = position
    for k, prop in enumerate(element.properties):
        count = 1
        if prop.count_kind is not None:
            count = lengths[k] = _binary_length(source, element, prop, 0, offset)
            offset += prop.count_kind.itemsize
            fields.append((f"count {k}", prop.count_kind))
        offset += count * prop.kind.itemsize
        if offset > len(source.data):
            raise _cut_short(source, element, 0, position)
        fields.append((f"value {k}", prop.kind, (count,)))  # type: ignore[arg-type]
    kind = np.dtype(fields)
    end = position + element.count * kind.itemsize
    if end > len(source.data):
        return None, position
    table = np.frombuffer(source.data, kind, element.count, position)
    columns: Columns = {}
    for k, prop in enumerate(element.properties):
        counts = table[f"count {k}"].astype(np.int64) if k in lengths else None
        if counts is not None and (counts != lengths[k]).any():
            return None, position
        columns[prop.name] = (table[f"value {k}"].reshape(-1), counts)
    return columns, end
