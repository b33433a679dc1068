"""The two pair questions: checks and broadcasting here, geometry in the kernels."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from obbcli import kernels
from obbcli.errors import MotionError, ObbError
from obbcli.primitives.contacts import (
    PrimitiveContact,
    PrimitiveContacts,
    contact_at,
    contacts_of,
)
from obbcli.primitives.shapes import Obb, Triangle, as_one_or_many, first_row
from obbcli.threads import thread_count

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

Shape: TypeAlias = Obb | Triangle

_AT_REST = np.zeros((1, 3))
_AT_REST.setflags(write=False)


class _Pairs(NamedTuple):
    """Arguments as the kernels take them, and whether they were one pair or an array."""

    a: Floats
    b: Floats
    velocity_a: Floats
    velocity_b: Floats
    duration: Floats
    pair_count: int
    is_single: bool


def intersects(
    shape_a: Shape,
    shape_b: Shape,
    velocity_a: ArrayLike = 0,
    velocity_b: ArrayLike = 0,
    duration: ArrayLike = 0.0,
    *,
    threads: int | None = None,
) -> bool | NDArray[np.bool_]:
    """Return whether two shapes have a point in common at any time in `[0, duration]`.

    Exact for the doubles given (Eberly 2008 §2.2, 3.2 and 4.2; the module says where we differ).

    Args:
        shape_a: `Obb` or `Triangle`, one or N.
        shape_b: `Obb` or `Triangle`, one or N.
        velocity_a: (3,) or (N, 3), units of length a second; 0: at rest.
        velocity_b: the same of B.
        duration: s, at least 0; one or (N,). 0 asks about the shapes where they are.
        threads: for arrays, at most so many; None: as many as this process may use cores. They
            change nothing but the time it takes.

    Returns:
        bool, or bool (N,) where any argument is an array of N.

    Raises:
        MotionError: velocities or duration of another shape, not finite, or negative.
        ObbError: not shapes, or arrays of different lengths.

    Example:
        >>> cube = Obb((0, 0, 0), np.eye(3), (1, 1, 1))
        >>> triangle = Triangle([[1, 0, 0], [3, 0, 0], [2, 1, 0]])
        >>> intersects(cube, triangle)
        True
    """
    pairs = _pairs_of(shape_a, shape_b, velocity_a, velocity_b, duration)
    verdicts = np.empty(pairs.pair_count, dtype=np.uint8)
    kernels.primitive_intersects(*pairs[:5], thread_count(threads), verdicts)
    # Bit 0 of a verdict; bit 1 tells how it was found.
    return bool(verdicts[0] & 1) if pairs.is_single else (verdicts & 1).view(np.bool_)


def first_contact(
    shape_a: Shape,
    shape_b: Shape,
    velocity_a: ArrayLike = 0,
    velocity_b: ArrayLike = 0,
    duration: ArrayLike = 0.0,
    *,
    threads: int | None = None,
) -> PrimitiveContact | PrimitiveContacts | None:
    """Return when, where and how two shapes first meet in `[0, duration]`.

    The times are the doubles nearest to the exact ones; the point is in both shapes to rounding,
    in the middle of what they have in common where that is more than a point (Eberly 2008 §2.3,
    3.3 and 4.3; the module says where we differ).

    Args:
        shape_a: `Obb` or `Triangle`, one or N.
        shape_b: `Obb` or `Triangle`, one or N.
        velocity_a: (3,) or (N, 3), units of length a second; 0: at rest.
        velocity_b: the same of B.
        duration: s, at least 0; one or (N,).
        threads: for arrays, at most so many; None: as many as this process may use cores. They
            change nothing but the time it takes.

    Returns:
        One pair: its contact, or None where the shapes never meet. Where any argument is an array
        of N: the `PrimitiveContacts` of those pairs that meet.

    Raises:
        MotionError: velocities or duration of another shape, not finite, or negative; or a
            contact so far away that no double holds its place.
        ObbError: not shapes, or arrays of different lengths.

    Example:
        >>> cube = Obb((0, 0, 0), np.eye(3), (1, 1, 1))
        >>> other = Obb((4, 0, 0), np.eye(3), (1, 1, 1))
        >>> contact = first_contact(cube, other, velocity_a=(4, 0, 0), duration=1)
        >>> contact.time, contact.last_time
        (0.5, 1.0)
    """
    pairs = _pairs_of(shape_a, shape_b, velocity_a, velocity_b, duration)
    columns = kernels.primitive_first_contacts(*pairs[:6], thread_count(threads))
    lost = ~np.isfinite(columns["point"]).all(axis=1)
    if lost.any():
        row = int(columns["rows"][np.argmax(lost)])
        raise MotionError(
            "velocity_a" if pairs.is_single else f"velocity_a[{row}]",
            "takes the contact out of the range of doubles",
            "subtract the velocity that both shapes have in common",
        )
    if pairs.is_single:
        return contact_at(columns, 0) if len(lost) else None
    return contacts_of(columns)


def _pairs_of(
    shape_a: Shape,
    shape_b: Shape,
    velocity_a: ArrayLike,
    velocity_b: ArrayLike,
    duration: ArrayLike,
) -> _Pairs:
    for name, shape in (("shape_a", shape_a), ("shape_b", shape_b)):
        if not isinstance(shape, (Obb, Triangle)):
            raise ObbError(name, f"is a {type(shape).__name__}", "expected an Obb or a Triangle")
    rate_a, single_rate_a = _as_velocity(velocity_a, "velocity_a")
    rate_b, single_rate_b = _as_velocity(velocity_b, "velocity_b")
    durations, single_duration = _as_duration(duration)
    rows = (shape_a.rows, shape_b.rows, rate_a, rate_b, durations)
    singles = (
        shape_a.is_single,
        shape_b.is_single,
        single_rate_a,
        single_rate_b,
        single_duration,
    )
    if all(singles):
        return _Pairs(*rows, pair_count=1, is_single=True)
    return _Pairs(*rows, pair_count=_common_length(rows, singles), is_single=False)


def _common_length(rows: Iterable[Floats], singles: Iterable[bool]) -> int:
    names = ("shape_a", "shape_b", "velocity_a", "velocity_b", "duration")
    many = [
        (name, len(array))
        for name, array, single in zip(names, rows, singles, strict=True)
        if not single
    ]
    first, count = many[0]
    for name, length in many[1:]:
        if length != count:
            raise ObbError(
                name,
                f"has {length} rows, but {first} has {count}",
                "give one for all pairs, or one for each",
            )
    return count


def _as_velocity(value: ArrayLike, name: str) -> tuple[Floats, bool]:
    if isinstance(value, (int, float)) and value == 0:
        return _AT_REST, True
    return as_one_or_many(value, (3,), name, MotionError)


def _as_duration(value: ArrayLike) -> tuple[Floats, bool]:
    if isinstance(value, (int, float)):
        if not 0 <= value <= sys.float_info.max:
            raise MotionError("duration", f"is {value}", "a duration is finite and at least 0")
        return np.array([value], dtype=np.float64), True
    durations, single = as_one_or_many(value, (), "duration", MotionError)
    negative = durations < 0
    if negative.any():
        where, row = first_row(negative, "duration", single=single)
        raise MotionError(where, f"is {durations[row]}", "a duration is finite and at least 0")
    return durations, single
