"""Polynomials of a span, s, as arrays of coefficients, lowest first, and bounds made of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.questions.intervals.relative_motion import Path

    Floats = NDArray[np.float64]


def value_at(coefficients: Floats, s: Floats) -> Floats:
    """Return the values of polynomials, (..., degree + 1), at spans, (..., K)."""
    total = np.zeros(np.broadcast_shapes((*coefficients.shape[:-1], 1), s.shape))
    for k in range(coefficients.shape[-1] - 1, -1, -1):
        total = total * s + coefficients[..., k, None]
    return total


def norm(vectors: Floats) -> Floats:
    """Return the lengths of vectors, (..., 3) -> (...)."""
    lengths: Floats = np.linalg.norm(vectors, axis=-1)
    return lengths


def poly(*parts: Floats) -> Floats:
    """Return the polynomials of given coefficients, (...) each."""
    return np.stack(np.broadcast_arrays(*parts), axis=-1)


def times(a: Floats, b: Floats) -> Floats:
    """Return the products of polynomials."""
    m, n = a.shape[-1], b.shape[-1]
    shape = np.broadcast_shapes(a.shape[:-1], b.shape[:-1])
    out = np.zeros((*shape, m + n - 1))
    for i in range(m):
        for j in range(n):
            out[..., i + j] += a[..., i] * b[..., j]
    return out


def plus(*terms: Floats) -> Floats:
    """Return the sums of polynomials."""
    size = max(term.shape[-1] for term in terms)
    shape = np.broadcast_shapes(*(term.shape[:-1] for term in terms))
    out = np.zeros((*shape, size))
    for term in terms:
        out[..., : term.shape[-1]] += term
    return out


class Reach(NamedTuple):
    """Bounds on a point's derivatives over a span, and on how far it gets: polynomials of it."""

    third: Floats
    second: Floats
    first: Floats
    way: Floats


def reach_of(path: Path, growth: float) -> Reach:
    """Return what bounds points on their way.

    Args:
        path: about one time.
        growth: by how much the bound on the third derivative grows a second.
    """
    zero = np.zeros_like(path.third)
    third, s = poly(path.third, zero + growth), poly(zero, zero + 1)
    second = plus(poly(norm(path.second)), times(third, s))
    first = plus(poly(norm(path.first)), times(second, s))
    return Reach(third, second, first, times(first, s))
