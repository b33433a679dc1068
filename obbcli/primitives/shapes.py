"""Boxes and triangles as the pair questions take them: checked, read-only, one or many."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from obbcli.arrays import as_floats
from obbcli.errors import ObbError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

# What the kernels' error bounds allow for; a matrix written with ten digits still meets it.
ORTHONORMAL_TOLERANCE = 1e-9


def as_one_or_many(
    value: ArrayLike, shape: tuple[int, ...], name: str, error: type[ObbError]
) -> tuple[Floats, bool]:
    """Return `value` as float64 (N, *shape), and whether it was a single (*shape).

    Raises:
        error: neither, or not finite.
    """
    try:
        many = np.ndim(value) > len(shape)
    except ValueError:  # ragged: refused below, in words
        many = False
    array = as_floats(value, (None, *shape) if many else shape, name, error)
    return (array, False) if many else (array[np.newaxis], True)


def first_row(bad: NDArray[np.bool_], name: str, *, single: bool) -> tuple[str, int]:
    """Return the place to name for the first row of `bad` (N,) that is set, and that row."""
    row = int(np.argmax(bad))
    return (name if single else f"{name}[{row}]"), row


class Obb:
    """A box `{center + sum y_i axes[i] : |y_i| <= half_extents[i]}`, or N of them.

    Args:
        center: (3,) or (N, 3), in any unit of length.
        axes: (3, 3) or (N, 3, 3); `axes[i]` is the i-th unit axis, a row. Orthonormal to 1e-9 and
            then taken literally; of either hand.
        half_extents: (3,) or (N, 3), half the side lengths, >= 0: flat boxes are boxes.

    Raises:
        ObbError: not finite, of another shape, axes not orthonormal, negative half extents; of
            several boxes the first at fault is named.
    """

    __slots__ = ("axes", "center", "half_extents", "is_single", "rows")

    ROW_LENGTH: ClassVar[int] = 15

    center: Floats
    axes: Floats
    half_extents: Floats
    is_single: bool
    rows: Floats

    def __init__(self, center: ArrayLike, axes: ArrayLike, half_extents: ArrayLike) -> None:
        centers, single = as_one_or_many(center, (3,), "center", ObbError)
        frames, single_axes = as_one_or_many(axes, (3, 3), "axes", ObbError)
        halves, single_halves = as_one_or_many(half_extents, (3,), "half_extents", ObbError)
        counts = (len(centers), len(frames), len(halves))
        if len(set(counts)) > 1 or not single == single_axes == single_halves:
            raise ObbError(
                "Obb",
                f"has {counts[0]} centers, {counts[1]} axes and {counts[2]} half_extents",
                "give one of each, or arrays of one length",
            )
        _check_orthonormal(frames, single)
        _check_half_extents(halves, single)
        self.is_single = single
        self.rows = _frozen(np.hstack((centers, frames.reshape(-1, 9), halves)))
        boxes = self.rows[0] if single else self.rows
        self.center = boxes[..., :3]
        self.axes = boxes[..., 3:12].reshape(*boxes.shape[:-1], 3, 3)
        self.half_extents = boxes[..., 12:]

    def __repr__(self) -> str:
        """Return the constructor's call, or how many boxes there are."""
        if not self.is_single:
            return f"<Obb: {len(self.rows)} boxes>"
        parts = (self.center.tolist(), self.axes.tolist(), self.half_extents.tolist())
        return "Obb({}, {}, {})".format(*parts)


class Triangle:
    """A closed triangle, or N of them; points and segments are triangles too.

    Args:
        vertices: (3, 3) or (N, 3, 3): three vertices, in any unit of length.

    Raises:
        ObbError: not finite, or of another shape; the first number at fault is named.
    """

    __slots__ = ("is_single", "rows", "vertices")

    ROW_LENGTH: ClassVar[int] = 9

    vertices: Floats
    is_single: bool
    rows: Floats

    def __init__(self, vertices: ArrayLike) -> None:
        array, self.is_single = as_one_or_many(vertices, (3, 3), "vertices", ObbError)
        self.rows = array.reshape(-1, 9)
        self.vertices = array[0] if self.is_single else array

    def __repr__(self) -> str:
        """Return the constructor's call, or how many triangles there are."""
        if not self.is_single:
            return f"<Triangle: {len(self.rows)} triangles>"
        return f"Triangle({self.vertices.tolist()})"


def _frozen(array: Floats) -> Floats:
    array.setflags(write=False)
    return array


def _check_orthonormal(frames: Floats, single: bool) -> None:
    # Entries beyond 2 would overflow on their way to the same answer.
    bounded = np.clip(frames, -2.0, 2.0)
    defects = np.abs(bounded @ bounded.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2), initial=0)
    bad = defects > ORTHONORMAL_TOLERANCE
    if bad.any():
        where, row = first_row(bad, "axes", single=single)
        raise ObbError(
            where,
            f"rows are orthonormal to {defects[row]:.3g} only",
            f"wanted {ORTHONORMAL_TOLERANCE:g}; axes[i] is the i-th unit axis",
        )


def _check_half_extents(halves: Floats, single: bool) -> None:
    bad = halves.min(axis=1, initial=0) < 0
    if bad.any():
        where, row = first_row(bad, "half_extents", single=single)
        raise ObbError(where, f"is {halves[row].tolist()}", "half extents must be at least 0")
