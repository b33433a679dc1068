"""How far apart neighbouring coordinates of a mesh are: what its file could not say more finely."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.measure import used_vertices

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Decimal digits that are looked for in a text: fewer are lengths that somebody chose, more are
# as good as those of a double.
_FEWEST, _MOST = 5, 12
#: No spacing that is told is a larger share of the largest coordinate.
COARSEST = 10.0 ** (1 - _FEWEST)
# So many different coordinates use all digits of a text that was rounded to them.
_WITNESSES = 8
# Relative: the decimal number, two powers of ten and two products are each rounded by 2^-53.
_ROUNDING = 2.0**-50


class Spacing(NamedTuple):
    """How far apart coordinates are.

    Attributes:
        value: from the largest coordinate to the next number with the same digits, mesh units.
        digits: `"float32"` where every coordinate is one; `"decimal"` where all are decimal
            numbers of at most 12 digits, eight of them of just as many; `"float64"` elsewhere;
            `"scaled"` where the coordinates were scaled since.
    """

    value: float
    digits: str


def spacing_of(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> Spacing:
    """Return how far apart the coordinates are of the vertices that some triangle uses."""
    used = used_vertices(vertices, triangles)
    largest = float(np.abs(used).max())
    if are_float32(used):
        return Spacing(float(np.spacing(np.float32(largest))), "float32")
    double = float(np.spacing(largest))
    decimal = _decimal_spacing(np.unique(np.abs(used)))
    if decimal is not None and decimal > double:
        return Spacing(decimal, "decimal")
    return Spacing(double, "float64")


def are_float32(values: NDArray[np.float64]) -> bool:
    """Return whether all numbers are those of single precision."""
    with np.errstate(over="ignore", under="ignore"):
        return bool((values.astype(np.float32) == values).all())


def _decimal_spacing(values: NDArray[np.float64]) -> float | None:
    """Return the last place of the largest of some decimal numbers; None where they are none.

    Args:
        values: different ones, rising, at least 0.
    """
    values = values[values > 0]  # of which there are some: zeros alone are numbers of float32
    if not (values[0] > 1e-290 and values[-1] < 1e290):
        return None
    left = values[~_have(values, _FEWEST - 1)]
    exponent = np.floor(np.log10(values[-1]))
    for digits in range(_FEWEST, _MOST + 1):
        before, left = left, left[~_have(left, digits)]
        if not len(left):
            is_told = len(before) >= _WITNESSES
            return float(10.0 ** (exponent - digits + 1)) if is_told else None
    return None


def _have(values: NDArray[np.float64], digits: int) -> NDArray[np.bool_]:
    """Return which numbers have at most so many significant decimal digits."""
    places = digits - 1 - np.floor(np.log10(values))
    # Powers of ten beyond 10^22 are no doubles: two factors keep their roundings few.
    half = np.floor(places / 2)
    whole = values * 10.0**half * 10.0 ** (places - half)
    is_near: NDArray[np.bool_] = np.abs(whole - np.rint(whole)) <= _ROUNDING * whole
    return is_near
