"""Units of length: what files state, and meshes in another unit or by another scale.

A coordinate p becomes fl(p r) where the new unit is smaller, and fl(p / r) where it is larger; r is
the double nearest to the ratio of the units, at least 1. Whole ratios, such as 1000 for m and mm,
are exact, so that the result is rounded once. The result is what answers are exact for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.errors import MeshError

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: How many micrometres each unit is long: whole numbers.
UNITS = {"m": 1_000_000, "cm": 10_000, "mm": 1_000, "um": 1, "in": 25_400, "ft": 304_800}


def checked_unit(unit: object, where: str = "unit") -> str:
    """Return a unit that is known.

    Raises:
        MeshError: it is none of `UNITS`.
    """
    if not isinstance(unit, str) or unit not in UNITS:
        raise MeshError(where, f"is {unit!r}", "use one of " + ", ".join(UNITS))
    return unit


def converted(
    vertices: NDArray[np.float64], own: str, unit: str
) -> tuple[NDArray[np.float64], str]:
    """Return coordinates of one unit in another, and the note on it.

    Raises:
        MeshError: a unit is not known.
    """
    length, wanted = UNITS[checked_unit(own)], UNITS[checked_unit(unit)]
    with np.errstate(over="ignore"):
        if length >= wanted:
            ratio, how = length / wanted, "times"
            result = vertices * ratio
        else:
            ratio, how = wanted / length, "divided by"
            result = vertices / ratio
    return result, f"from {own} to {unit}: coordinates {how} {ratio:.12g}"


def scaled(vertices: NDArray[np.float64], factor: float) -> tuple[NDArray[np.float64], str]:
    """Return coordinates fl(p factor), and the note on it.

    Raises:
        MeshError: the factor is no finite number above 0.
    """
    if isinstance(factor, bool) or not isinstance(factor, (int, float)):
        raise MeshError("scale", f"is {factor!r}", "use a number above 0")
    if not 0.0 < factor < np.inf:
        raise MeshError("scale", f"is {factor!r}", "use a finite number above 0")
    with np.errstate(over="ignore"):
        return vertices * float(factor), f"coordinates times {float(factor)!r}"
