"""Rows of a JSONL file: an object a line, whose keys are the fields."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from obbcli.errors import ObbError
from obbcli.sweeps.row_fields import FIELDS, Row, number_of, unknown, vector_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.sweeps.row_fields import Identity, Values, Vector


def rows_of_jsonl(lines: Iterator[str], place: str) -> Iterator[Row]:
    """Yield the rows; blank lines are none."""
    index = 0
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        yield _row(index, line, f"{place}:{number}")
        index += 1


def _row(index: int, line: str, where: str) -> Row:
    identity: Identity = None
    try:
        pairs = _pairs(line, where)
        identity = _identity(pairs, where)
        return Row(index, where, identity, _values(pairs, where))
    except ObbError as fault:
        return Row(index, where, identity, {}, fault)


def _pairs(line: str, where: str) -> list[tuple[str, Any]]:
    """Return keys and values of the one object in a line."""
    try:
        pairs = json.loads(line, object_pairs_hook=_Object, parse_constant=_refuse)
    except RecursionError as fault:
        raise ObbError(where, "is nested too deeply", "write one object a line") from fault
    except json.JSONDecodeError as fault:
        words = f"is no JSON from column {fault.colno} on"
        raise ObbError(where, words, "write one object a line") from fault
    except _NoNumberError as fault:
        raise ObbError(where, f"is no JSON: {fault} is no number", "write a number") from fault
    except ValueError as fault:
        words = "is no JSON: a number has too many digits"
        raise ObbError(where, words, "write one object a line") from fault
    if not isinstance(pairs, _Object):
        raise ObbError(where, "is no JSON object", 'write one a line, as {"vel": [0, 0, 1]}')
    return pairs


class _Object(list[tuple[str, Any]]):
    """An object with all its keys, also those that it has twice."""


class _NoNumberError(ValueError):
    """A word that Python's JSON takes for a number, and that is none of JSON."""


def _refuse(word: str) -> None:
    raise _NoNumberError(word)


def _identity(pairs: list[tuple[str, Any]], where: str) -> Identity:
    names = [value for key, value in pairs if key == "id"]
    if not names:
        return None
    name = names[0]
    if name is None or isinstance(name, str):
        return name
    number_of(name, f"{where}, key id")
    number: int | float = name
    return number


def _values(pairs: list[tuple[str, Any]], where: str) -> Values:
    """Return what an object says; null says nothing."""
    values: dict[str, Vector | float] = {}
    seen = set()
    for key, value in pairs:
        if key not in FIELDS:
            raise unknown(key, where, "key")
        if key in seen:
            raise ObbError(where, f"has the key {key!r} twice", "leave one of them out")
        seen.add(key)
        if value is not None and key != "id":
            read = number_of if key == "duration" else vector_of
            values[key] = read(value, f"{where}, key {key}")
    return values
