"""The only checks of shapes, types and finiteness: what passes here may cross into the kernels."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from obbcli.errors import ObbError

# Of so many numbers Python knows sooner than NumPy whether all are finite.
_SMALL = 16


def as_vector(value: ArrayLike, name: str, error: type[ObbError]) -> NDArray[np.float64]:
    """Return `value` as a read-only float64 (3,) array.

    Raises:
        error: not three finite numbers; `name` is the place named.
    """
    return as_floats(value, (3,), name, error)


def as_floats(
    value: ArrayLike, shape: tuple[int | None, ...], name: str, error: type[ObbError]
) -> NDArray[np.float64]:
    """Return `value` as a read-only, C-contiguous float64 array of the given shape.

    Args:
        value: anything NumPy can turn into an array of numbers.
        shape: the shape wanted; None stands for any length.
        name: the place named in errors.
        error: the class raised.

    Raises:
        error: not numbers, another shape, or a value that is not finite (the first is named).
    """
    try:
        # A copy, so that a caller who writes to the source later changes no answer.
        array = np.array(value, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError) as fault:
        wanted = f"expected numbers of shape {_in_words(shape)}"
        raise error(name, wanted, "give numbers alone, as many in each row") from fault
    # Most that comes here is small and as it should be, and NumPy is slow to start.
    if array.shape != shape and (
        array.ndim != len(shape)
        or any(n is not None and n != m for n, m in zip(shape, array.shape, strict=True))
    ):
        raise error(name, f"has shape {array.shape}, expected {_in_words(shape)}")
    if array.size > _SMALL or not all(map(isfinite, array.ravel().tolist())):
        _require_finite(array, name, error)
    array.setflags(write=False)
    return array


def _require_finite(array: NDArray[np.float64], name: str, error: type[ObbError]) -> None:
    finite = np.isfinite(array)
    if not finite.all():
        place = np.unravel_index(int(np.argmin(finite)), array.shape)
        index = ", ".join(str(int(i)) for i in place)
        raise error(f"{name}[{index}]", f"is {array[place]}", "coordinates must be finite")


def _in_words(shape: tuple[int | None, ...]) -> str:
    return "(" + ", ".join("N" if n is None else str(n) for n in shape) + ")"
