"""Lines of numbers as arrays, and the line where one is wrong; shared by readers of text.

Words are converted in lists of bounded length, which takes about 0.1 us a word.
"""

from __future__ import annotations

import math
from itertools import repeat
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.source import Source

#: Lines that are converted at a time.
_LINES = 1 << 15
#: Whole numbers below this one are exact in a float64.
_EXACT = 2**53


class Rows(NamedTuple):
    """Holds the numbers of lines, end to end; lines without numbers have no row.

    Args:
        values: float64 (N,); a field that is left empty between commas is NaN.
        counts: int64 (L,), numbers in each line.
        lines: int64 (L,), each line's number in its file.
        open: bool (L,), whether the line ends with a comma.
    """

    values: NDArray[np.float64]
    counts: NDArray[np.int64]
    lines: NDArray[np.int64]
    open: NDArray[np.bool_]

    @property
    def starts(self) -> NDArray[np.int64]:
        """Return where in `values` each line begins, (L,)."""
        return np.cumsum(self.counts) - self.counts

    def line_of(self, index: int) -> int:
        """Return the number of the line that holds `values[index]`."""
        return int(self.lines[np.searchsorted(np.cumsum(self.counts), index, side="right")])

    def table(self, width: int) -> NDArray[np.float64]:
        """Return the first `width` numbers of each line, (L, width); NaN where there are fewer."""
        if len(self.counts) and (self.counts == width).all():
            return self.values.reshape(-1, width)
        table = np.full((len(self.counts), width), np.nan)
        starts = self.starts
        for column in range(width):
            there = self.counts > column
            table[there, column] = self.values[starts[there] + column]
        return table


def blank_rows(source: Source, lines: list[bytes], first: int) -> Rows:
    """Return the numbers of lines whose fields stand between blanks.

    Args:
        source: the file, which errors name.
        lines: what is read; lines of white space alone have no row.
        first: the number of the first line.

    Raises:
        MeshError: a word that is no number; with its line. "nan" and "inf" are taken.
    """
    parts = []
    for start in range(0, len(lines), _LINES):
        part = lines[start : start + _LINES]
        counts = np.fromiter(map(len, map(bytes.split, part)), dtype=np.int64, count=len(part))
        joined = b" ".join(part)
        values = _converted(joined.split()) if b"_" not in joined else None
        if values is None:
            values = np.array(list(_one_by_one(source, part, first + start)), dtype=np.float64)
        numbers = np.arange(first + start, first + start + len(part), dtype=np.int64)
        used = counts > 0
        none = np.zeros(int(used.sum()), dtype=bool)
        parts.append(Rows(values, counts[used], numbers[used], none))
    return _joined(parts)


def comma_rows(source: Source, data: bytes, first: int) -> Rows:
    """Return the numbers of lines whose fields stand between commas.

    A comma at the end of a line adds no field, it is told by `open`.

    Args:
        source: the file, which errors name.
        data: the lines; those of white space alone have no row.
        first: the number of the first line.

    Raises:
        MeshError: a field that is no finite number; with its line.
    """
    lines = data.split(b"\n")
    parts = []
    for start in range(0, len(lines), _LINES):
        part = list(map(bytes.strip, lines[start : start + _LINES]))
        numbers = np.flatnonzero(np.fromiter(map(len, part), dtype=np.int64, count=len(part)))
        part = list(filter(None, part))
        ends = np.fromiter(map(bytes.endswith, part, repeat(b",")), dtype=bool, count=len(part))
        if ends.any():
            part = [line[:-1] if line.endswith(b",") else line for line in part]
        commas = map(bytes.count, part, repeat(b","))
        counts = np.fromiter(commas, dtype=np.int64, count=len(part)) + 1
        numbers += first + start
        joined = b",".join(part)
        values = _converted(joined.split(b",")) if part and b"_" not in joined else None
        if values is None or not np.isfinite(values).all():
            values = np.array(list(_fields(source, part, numbers)), dtype=np.float64)
        parts.append(Rows(values, counts, numbers, ends))
    return _joined(parts)


def whole_numbers(
    source: Source, rows: Rows, values: NDArray[np.float64], what: str
) -> NDArray[np.int64]:
    """Return numbers as integers.

    Args:
        source: the file, which errors name.
        rows: the lines they stand in.
        values: (N,), which are `rows.values`, or (L,) or (L, width), a row a line.
        what: what each number is, in errors.

    Raises:
        MeshError: the first that is not whole, or too large to be exact; with its line.
    """
    with np.errstate(invalid="ignore"):
        bad = ~((values == np.floor(values)) & (np.abs(values) < _EXACT))
    if not bad.any():
        return values.astype(np.int64)
    at = int(np.argmax(bad.reshape(-1)))
    value = float(values.reshape(-1)[at])
    line = rows.line_of(at) if values is rows.values else rows.lines[at * len(values) // bad.size]
    found = f"{value:.17g} is {'too large' if abs(value) >= _EXACT else 'not a whole number'}"
    found = "is missing" if math.isnan(value) else found
    raise source.error(f"{what} {found}", "write the file again", at=str(int(line)))


def _converted(words: list[bytes]) -> NDArray[np.float64] | None:
    """Return words as numbers, or None where one is none."""
    try:
        return np.array(list(map(float, words)), dtype=np.float64)
    except ValueError:
        return None


def _number(source: Source, word: bytes, line: int) -> float:
    """Return a number, whose exponent may be written as Fortran does: 1.5D-3."""
    try:
        if b"_" in word:
            raise ValueError
        return float(word.upper().replace(b"D", b"E"))
    except ValueError as fault:
        remedy = "write the parameter's value in its place" if word.startswith(b"<") else ""
        raise source.error(f"'{shown(word)}' is not a number", remedy, at=str(line)) from fault


def _one_by_one(source: Source, lines: list[bytes], first: int) -> Iterator[float]:
    for line, content in enumerate(lines, start=first):
        for word in content.split():
            yield _number(source, word, line)


def _fields(source: Source, lines: list[bytes], numbers: NDArray[np.int64]) -> Iterator[float]:
    """Yield the fields of lines: NaN for those left empty."""
    for content, line in zip(lines, numbers.tolist(), strict=True):
        for word in content.split(b","):
            field = word.strip()
            value = _number(source, field, line) if field else math.nan
            if field and not math.isfinite(value):
                raise source.error(
                    f"'{shown(field)}' is not finite", "coordinates must be finite", at=str(line)
                )
            yield value


def _joined(parts: list[Rows]) -> Rows:
    if len(parts) == 1:
        return parts[0]
    none = np.zeros(0, dtype=np.int64)
    empty = Rows(np.zeros(0), none, none, np.zeros(0, dtype=bool))
    return Rows(*(np.concatenate(column) for column in zip(*[empty, *parts], strict=True)))
