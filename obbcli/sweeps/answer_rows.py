"""Answers of a sweep: as kernels leave them, as a caller's array, and as a document has them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli import kernels
from obbcli.answers.status import Status
from obbcli.answers.words import EVIDENCES, FEATURES

if TYPE_CHECKING:
    from obbcli.answers.contact import Contact, FirstContact

    Answers = np.ndarray[tuple[int], np.dtype[np.void]]

_VECTORS = ("point", "point_a", "point_b", "normal", "normal_a", "normal_b")
_COUNTS = ("box_tests", "triangle_tests", "exact_triangle_tests", "pops")


def _raw_rows() -> np.dtype[np.void]:
    columns, size = kernels.sweep_columns()
    names, formats, offsets = zip(*columns, strict=True)
    return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": size})


RAW = _raw_rows()
"""`SweepAnswer` of the kernels: NaN and -1 for what does not apply, codes for words."""

# By their codes there. After them come rows that are refused, and those of which it is left to
# Python to say where triangles meet.
STATUSES = (Status.SEPARATED, Status.CONTACT, Status.OVERLAP_AT_START, Status.UNRESOLVED)
REFUSED, TRIANGLES_AT_START = 4, 5

ROW = np.dtype(
    [
        ("status", "U16"),
        ("time", "f8"),
        ("time_lo", "f8"),
        ("time_hi", "f8"),
        ("evidence", "U16"),
        *((name, "f8", 3) for name in _VECTORS),
        ("triangle_a", "i8"),
        ("triangle_b", "i8"),
        ("feature", "U13"),
        ("distance", "f8"),
        ("error_bound", "f8"),
        ("approximate", "?"),
        *((name, "u8") for name in _COUNTS),
    ]
)
"""A row of what `sweep` returns."""

# Copied as they are.
_SHARED = ("time_lo", "time_hi", *_VECTORS, "triangle_a", "triangle_b", "distance", "error_bound")


def as_rows(raw: Answers) -> Answers:
    """Return the answers as `sweep` gives them: words spelled out."""
    rows = np.empty(len(raw), ROW)
    for name in (*_SHARED, *_COUNTS):
        rows[name] = raw[name]
    rows["time"] = raw["time_lo"]
    rows["approximate"] = raw["approximate"]
    rows["status"] = np.array([status.value for status in STATUSES])[raw["status"]]
    rows["evidence"] = np.array([word or "" for word in EVIDENCES])[raw["evidence"]]
    rows["feature"] = np.array([word or "" for word in FEATURES])[raw["feature"]]
    return rows


def write_contact(raw: Any, contact: Contact) -> None:
    """Write a contact over a row of `RAW`, all but its counters."""
    low, high = contact.time_bounds or (None, None)
    raw["time_lo"] = math.nan if low is None else low
    raw["time_hi"] = math.nan if high is None else high
    for name in (*_VECTORS, "distance"):
        value = getattr(contact, name)
        raw[name] = math.nan if value is None else value
    for name in ("triangle_a", "triangle_b"):
        value = getattr(contact, name)
        raw[name] = -1 if value is None else value
    raw["error_bound"] = contact.error_bound
    raw["approximate"] = contact.approximate
    raw["status"] = STATUSES.index(contact.status)
    raw["evidence"] = EVIDENCES.index(contact.evidence)
    raw["feature"] = FEATURES.index(contact.feature)


def write_answer(raw: Any, answer: FirstContact) -> None:
    """Write an answer with what it cost over a row of `RAW`."""
    write_contact(raw, answer)
    for name in _COUNTS:
        raw[name] = getattr(answer.stats, name)


def as_results(raw: Answers) -> list[dict[str, Any]]:
    """Return each answer as the documents of `first-contact` have it, and its counters as stats.

    Of a refused row there is nothing to say: {}.
    """
    names = RAW.names or ()
    columns = [raw[name].tolist() for name in names]
    return [_result(dict(zip(names, values, strict=True))) for values in zip(*columns, strict=True)]


def _result(values: dict[str, Any]) -> dict[str, Any]:
    if values["status"] == REFUSED:
        return {}
    status = STATUSES[values["status"]]
    low, high = _or_none(values["time_lo"]), _or_none(values["time_hi"])
    result: dict[str, Any] = {
        "status": status.value,
        "time": low,
        "time_bounds": None if low is None else [low, high],
        "evidence": EVIDENCES[values["evidence"]],
    }
    for name in _VECTORS:
        vector = values[name]
        result[name] = None if math.isnan(vector[0]) else vector
    for name in ("triangle_a", "triangle_b"):
        result[name] = None if values[name] < 0 else values[name]
    result["feature"] = FEATURES[values["feature"]]
    result["distance"] = _or_none(values["distance"])
    result["contained"] = None
    result["approximate"] = values["approximate"]
    result["error_bound"] = values["error_bound"]
    result["stats"] = {name: values[name] for name in _COUNTS}
    return result


def _or_none(value: float) -> float | None:
    return None if math.isnan(value) else value
