"""The platform's sine and cosine err by an ulp at most: proofs about turning bodies lean on it.

Two callers are asked: the C library that the kernels are linked with, looked up through their own
shared object, and Python's `math`, which places poses. Truth has 200 bits.
"""

from __future__ import annotations

import ctypes
import math
from typing import TYPE_CHECKING

import mpmath
import numpy as np
import pytest

from obbcli import kernels

if TYPE_CHECKING:
    from collections.abc import Callable

BITS = 200
COUNT = 800
LARGEST = 2.0**50  # rad; the kernels follow no turn beyond


def linked(name: str) -> Callable[[float], float]:
    """Return the function of that name that the kernels' shared object and its libraries hold."""
    function = getattr(ctypes.CDLL(kernels._core.__file__), name)
    function.argtypes, function.restype = [ctypes.c_double], ctypes.c_double
    return function  # type: ignore[no-any-return]


def near_quarters() -> list[float]:
    """Return the doubles about multiples of a quarter turn, where sine or cosine all but vanish."""
    random = np.random.default_rng(3)
    counts = [*range(1, 200), *np.floor(2.0 ** random.uniform(8, 49, COUNT)).astype(int).tolist()]
    with mpmath.workprec(BITS):
        quarters = [float(count * mpmath.pi / 2) for count in counts]
    return [
        near
        for quarter in quarters
        for near in (math.nextafter(quarter, 0), quarter, math.nextafter(quarter, math.inf))
    ]


def angles(kind: str) -> list[float]:
    random = np.random.default_rng(5)
    if kind == "quarters":
        found = near_quarters()
    elif kind == "turns":
        found = random.uniform(0, 2 * math.pi, 2 * COUNT).tolist()
    elif kind == "many turns":
        found = (2.0 ** random.uniform(2, 50, 2 * COUNT)).tolist()
    else:
        found = [5e-324, 2.0**-1022, *(2.0 ** random.uniform(-1000, 0, COUNT)).tolist()]
    return [sign * angle for angle in found if angle <= LARGEST for sign in (1.0, -1.0)]


@pytest.mark.parametrize("source", ["kernels", "math"])
@pytest.mark.parametrize("kind", ["quarters", "turns", "many turns", "tiny"])
@pytest.mark.parametrize("name", ["sin", "cos"])
def test_error_is_an_ulp_at_most(name: str, kind: str, source: str) -> None:
    function = linked(name) if source == "kernels" else getattr(math, name)
    exact = getattr(mpmath, name)
    with mpmath.workprec(BITS):
        for angle in angles(kind):
            truth = exact(mpmath.mpf(angle))
            ulp = max(mpmath.mpf(2) ** (mpmath.frexp(truth)[1] - 53), mpmath.mpf(5e-324))

            assert abs(function(angle) - truth) <= ulp, angle.hex()


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_samples_hold_the_hardest_angles(name: str) -> None:
    # The multiples of a quarter turn really come within an ulp of zeros: reduction is put to work.
    values = [abs(getattr(math, name)(angle)) for angle in angles("quarters")]

    assert min(values) < 1e-17
    assert sum(value < 1e-9 for value in values) > 500
