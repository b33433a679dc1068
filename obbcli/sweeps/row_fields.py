"""What a row of a sweep may say: names and kinds of its fields, from cells of text or from JSON."""

from __future__ import annotations

from math import inf, isfinite, nan
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from obbcli.errors import MotionError, ObbError
from obbcli.spelling import meant

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

_OF_A = ("vel", "omega", "pivot", "translate", "rotate")
VECTORS = (*_OF_A, *(f"{name}_b" for name in _OF_A))
FIELDS = (*VECTORS, "duration", "id")

Vector: TypeAlias = tuple[float, float, float]
Values: TypeAlias = "Mapping[str, Vector | float]"
Identity: TypeAlias = "str | int | float | None"


class Row(NamedTuple):
    """A question as it was read.

    Attributes:
        number: 0 for the first.
        where: file and line.
        identity: what the row calls itself.
        values: its fields by name; those left out are not there.
        error: why it asks nothing; None of a good row.
    """

    number: int
    where: str
    identity: Identity
    values: Values
    error: ObbError | None = None


def number_in(text: str, where: str) -> float:
    """Return the finite number in a cell.

    Raises:
        MotionError: it is none.
    """
    try:
        # Python takes 1_000 for a number; in a file an underscore is a typing error.
        value = nan if "_" in text else float(text)
    except ValueError:
        value = nan
    if not isfinite(value):
        raise MotionError(where, f"{_short(text)} is not a finite number", "correct it")
    return value


def vector_in(text: str, where: str) -> Vector:
    """Return the three finite numbers in a cell, which spaces separate.

    Raises:
        MotionError: they are not.
    """
    words = text.split()
    known = plain_vector(words)
    if known is not None:
        return known
    if len(words) != 3:
        raise MotionError(
            where, f"{_short(text)} is not three numbers", "separate them with spaces"
        )
    x, y, z = (number_in(word, where) for word in words)
    return x, y, z


def plain_vector(texts: Sequence[str]) -> Vector | None:
    """Return three finite numbers, or None: then it is for the other readers to say what is wrong.

    Most cells are fine, and to name the place of each takes longer than to read it.
    """
    try:
        x, y, z = map(float, texts)
    except ValueError:
        return None
    is_plain = isfinite(x) and isfinite(y) and isfinite(z) and "_" not in "".join(texts)
    return (x, y, z) if is_plain else None


def number_of(value: object, where: str) -> float:
    """Return a finite number of a JSON document.

    Raises:
        MotionError: it is none.
    """
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:
            number = inf
        if isfinite(number):
            return number
    raise MotionError(where, f"{_short(value)} is not a finite number", "correct it")


def vector_of(value: object, where: str) -> Vector:
    """Return the three finite numbers of a JSON list.

    Raises:
        MotionError: they are not.
    """
    if not isinstance(value, list) or len(value) != 3:
        raise MotionError(where, f"{_short(value)} is not a list of three numbers", "correct it")
    x, y, z = (number_of(part, where) for part in value)
    return x, y, z


def unknown(name: str, where: str, what: str, known: Iterable[str] = FIELDS) -> ObbError:
    """Return the error for a name that no field has, with the nearest one that does."""
    remedy = meant(name, known) or f"the {what}s are " + ", ".join(FIELDS)
    return ObbError(where, f"there is no {what} {_short(name)}", remedy)


def _short(value: object) -> str:
    """Return what was found, not more of it than fits in a line."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:50]}..."
