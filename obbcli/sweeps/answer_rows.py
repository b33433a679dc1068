"""Answers of a sweep: as kernels leave them, as a caller's array, and as a document has them.

All three follow the fields of `Contact`: a field that kernels tell is a column by its name.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli import kernels
from obbcli.answers.contact import Contact, Vector
from obbcli.answers.counts import Counts
from obbcli.answers.fields import fields_of
from obbcli.answers.status import Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from obbcli.answers.contact import FirstContact
    from obbcli.questions.pair_question import Trees
    from obbcli.tree.tree import ObbTree

    Answers = np.ndarray[tuple[int], np.dtype[np.void]]

# By their codes in the kernels. After them come rows that are refused, and those of which it is
# left to Python to say where triangles meet.
STATUSES = (Status.SEPARATED, Status.CONTACT, Status.OVERLAP_AT_START, Status.UNRESOLVED)
REFUSED, TRIANGLES_AT_START = 4, 5

_FIELDS = fields_of(Contact)
_WORDS = {"status": tuple(status.value for status in STATUSES)} | {
    field.name: ("", *field.words) for field in _FIELDS if field.words
}
"""By their codes in the kernels; empty where none applies."""
_BOUNDS = ("time_lo", "time_hi")
_PARTS = ("part_a", "part_b")
_FORMATS: dict[object, tuple[str] | tuple[str, int]] = {
    float: ("f8",),
    int: ("i8",),
    bool: ("?",),
    Vector: ("f8", 3),
}


def _raw(*more: str) -> np.dtype[np.void]:
    columns, size = kernels.sweep_columns()
    names, formats, offsets = map(list, zip(*columns, strict=True))
    for name in more:
        names, formats, offsets = [*names, name], [*formats, "i8"], [*offsets, size]
        size += 8
    return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": size})


_TOLD_BY_KERNELS = _raw()
RAW = _raw("contained")
"""`SweepAnswer` of the kernels: NaN and -1 for what does not apply, codes for words. Behind it,
which body is inside the other: kernels are asked about surfaces."""
_TOLD = frozenset(RAW.names or ())


def _row(parts: Sequence[str] = ("U1", "U1")) -> np.dtype[np.void]:
    """Return the columns: those of `Contact`, flags behind the others, counts.

    Args:
        parts: formats of `part_a` and `part_b`.
    """
    columns: list[Any] = []
    flags: list[Any] = []
    for name, kind, _ in _FIELDS:
        if name == "time_bounds":
            columns += [(end, "f8") for end in _BOUNDS]
        elif name in _WORDS and name in _TOLD:
            columns.append((name, f"U{max(map(len, _WORDS[name]))}"))
        elif name == "time" or name in _TOLD:
            (flags if kind is bool else columns).append((name, *_FORMATS[kind]))
        elif name in _PARTS:
            columns.append((name, parts[_PARTS.index(name)]))
    return np.dtype([*columns, *flags, *((name, "u8") for name in Counts._fields)])


ROW = _row()
"""A row of what `sweep` returns; paths of parts are as wide as the longest."""


def of_kernels(found: object) -> Answers:
    """Return what kernels answer as rows of `RAW`."""
    told = np.array(found).view(_TOLD_BY_KERNELS).reshape(-1)
    rows = np.zeros(len(told), RAW)
    for name in _TOLD_BY_KERNELS.names or ():
        rows[name] = told[name]
    return rows


def as_rows(raw: Answers, trees: Trees) -> Answers:
    """Return the answers as `sweep` gives them: words spelled out, selected parts by their paths.

    Args:
        raw: rows of `RAW`.
        trees: of A and B.
    """
    parts = [
        _part_column(tree, raw[f"triangle_{side}"]) for side, tree in zip("ab", trees, strict=True)
    ]
    rows = np.empty(len(raw), _row([column.dtype.str for column in parts]))
    for name, column in zip(_PARTS, parts, strict=True):
        rows[name] = column
    for name in set(ROW.names or ()) - set(_PARTS):
        column = raw[_BOUNDS[0] if name == "time" else name]
        rows[name] = np.array(_WORDS[name])[column] if name in _WORDS else column
    return rows


def _part_column(tree: ObbTree, triangles: NDArray[np.int64]) -> NDArray[np.str_]:
    """Return the path of the selected part that each triangle is of; empty where there is none."""
    paths = np.array([*(rows.path for rows in tree.parts), ""])
    firsts = [rows.first_triangle for rows in tree.parts]
    # Of -1, no triangle, that is the last of them.
    column: NDArray[np.str_] = paths[np.searchsorted(firsts, triangles, side="right") - 1]
    return column


def write_contact(raw: Any, contact: Contact) -> None:
    """Write a contact over a row of `RAW`, all but its counters."""
    raw[_BOUNDS[0]], raw[_BOUNDS[1]] = (
        math.nan if time is None else time for time in contact.time_bounds or (None, None)
    )
    for name, kind, _ in _FIELDS:
        if name not in _TOLD:
            continue
        value = getattr(contact, name)
        if name in _WORDS:
            value = _WORDS[name].index(value or "")
        elif value is None:
            value = -1 if kind is int else math.nan
        raw[name] = value


def write_answer(raw: Any, answer: FirstContact) -> None:
    """Write an answer with what it cost over a row of `RAW`."""
    write_contact(raw, answer)
    for name, count in answer.stats.counts._asdict().items():
        raw[name] = count


def as_results(raw: Answers, trees: Trees) -> list[dict[str, Any]]:
    """Return each answer as the documents of `first-contact` have it, and its counters as stats.

    Of a refused row there is nothing to say: {}.

    Args:
        raw: rows of `RAW`.
        trees: of A and B.
    """
    columns = {field.name: _told(raw, field.name) for field in _FIELDS if field.name not in _PARTS}
    if any(tree.parts for tree in trees):
        for name, side, tree in zip(_PARTS, "ab", trees, strict=True):
            rows_of_side = raw[f"triangle_{side}"].tolist()
            columns[name] = [tree.part_of(row) if row >= 0 else None for row in rows_of_side]
    counts = zip(*(raw[name].tolist() for name in Counts._fields), strict=True)
    columns["stats"] = [dict(zip(Counts._fields, row, strict=True)) for row in counts]
    rows = zip(*columns.values(), strict=True)
    return [
        {} if code == REFUSED else dict(zip(columns, row, strict=True))
        for code, row in zip(raw["status"].tolist(), rows, strict=True)
    ]


def _told(raw: Answers, name: str) -> Sequence[object]:
    """Return a field of `Contact` of each row, as documents have it: None where it says nothing."""
    if name == "time_bounds":
        ends = zip(*(_told(raw, end) for end in _BOUNDS), strict=True)
        return [None if low is None else [low, high] for low, high in ends]
    if name == "time":
        return _told(raw, _BOUNDS[0])
    if name not in _TOLD:
        return [None] * len(raw)
    values = raw[name].tolist()
    if name in _WORDS:
        words = dict(enumerate(word or None for word in _WORDS[name]))
        return [words.get(code) for code in values]
    kind = raw.dtype[name]
    if kind.shape:
        return [None if math.isnan(value[0]) else value for value in values]
    if kind.kind == "f":
        return [None if math.isnan(value) else value for value in values]
    return [None if value < 0 else value for value in values] if kind.kind == "i" else values
