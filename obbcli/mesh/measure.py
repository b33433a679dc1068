"""Bounds, centroid and exact degeneracy of triangles given as arrays; called by `Mesh`.

Every sum and product is an elementwise NumPy operation, so the bits depend on no machine.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

#: Below this share of the size squared a rounded area may be no more than noise of a flat surface.
_FLAT_AREA = 2.0**-40
#: Bound of a cross product's error relative to its two products: 4 roundings, doubled.
_CROSS_ERROR = 8 * 2.0**-53
#: Products of scaled differences may have lost their last bits to underflow below this.
_UNDERFLOW = 2.0**-900
#: Triangles at a time: what fits the cache. A power of two, so that blocks do not change sums.
_BLOCK = 1 << 14
#: Of so many triangles a surface's size is told from below.
_SAMPLE = 512
#: 2^27 + 1 splits a double into two halves whose products are exact (Dekker 1971).
_SPLITTER = 2.0**27 + 1


def used_vertices(
    vertices: NDArray[np.float64], triangles: NDArray[np.int32]
) -> NDArray[np.float64]:
    """Return the rows of `vertices` that some triangle uses, in order."""
    used = np.zeros(len(vertices), dtype=bool)
    used[triangles.reshape(-1)] = True
    return vertices if used.all() else vertices[used]


def bounds(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return the lower and upper corner of the used vertices' box, read-only (2, 3)."""
    # An axis at a time, which takes a fifth of the time. Of two zeros either may be the least: the
    # sum makes both 0.0.
    columns = used_vertices(vertices, triangles).T
    corners = np.array([[axis.min() for axis in columns], [axis.max() for axis in columns]]) + 0.0
    corners.setflags(write=False)
    return corners


def least_size(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> float:
    """Return a lower bound of the surface's size: that of some of its triangles, in no time."""
    step = 1 + len(triangles) // _SAMPLE
    some = vertices[triangles[::step].reshape(-1)]
    return diagonal(np.array([some.min(axis=0), some.max(axis=0)]))


def diagonal(corners: NDArray[np.float64]) -> float:
    """Return the length of a box's diagonal; infinite only where it exceeds the largest double."""
    # Halved first: the difference of two finite doubles may overflow; hypot scales by itself.
    half = corners[1] / 2 - corners[0] / 2
    # Halving rounds where a subnormal is odd, so small boxes are not halved.
    if float(half.max()) < 1.0:
        return math.hypot(*(corners[1] - corners[0]).tolist())
    return 2.0 * math.hypot(*half.tolist())


def pairwise_sum(terms: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the sum over the first axis, as a balanced tree over neighbours in order."""
    while len(terms) > 1:
        half = len(terms) // 2
        sums = terms[0 : 2 * half : 2] + terms[1 : 2 * half : 2]
        terms = np.concatenate([sums, terms[2 * half :]]) if len(terms) % 2 else sums
    return np.asarray(terms[0])


def surface_centroid(
    vertices: NDArray[np.float64], triangles: NDArray[np.int32]
) -> NDArray[np.float64]:
    """Return the area-weighted centroid, read-only (3,); the vertices' mean where the area is 0.

    Works on coordinates scaled by powers of two and relative to the box's centre, so that neither
    the ends of the double range nor a large offset cost accuracy.
    """
    low, high = bounds(vertices, triangles)
    outer = _exponent(np.abs([low, high])) + 1
    scaled_low, scaled_high = np.ldexp(low, -outer), np.ldexp(high, -outer)
    middle = scaled_low / 2 + scaled_high / 2
    inner = _exponent(np.maximum(scaled_high - middle, middle - scaled_low))

    def local(points: NDArray[np.float64]) -> NDArray[np.float64]:
        return _times_power(_times_power(points, -outer) - middle, -inner)

    centroid = _weighted_mean(vertices, triangles, local)
    if centroid is None:
        used = used_vertices(vertices, triangles)
        centroid = pairwise_sum(local(used)) / len(used)
    placed = np.ldexp(middle + np.ldexp(centroid, inner), outer)
    result: NDArray[np.float64] = np.clip(placed, low, high)
    result.setflags(write=False)
    return result


def _weighted_mean(
    vertices: NDArray[np.float64],
    triangles: NDArray[np.int32],
    local: Callable[[NDArray[np.float64]], NDArray[np.float64]],
) -> NDArray[np.float64] | None:
    """Return the area-weighted mean in local coordinates, None where the area is exactly 0."""
    sums = []
    largest = 0.0
    for start in range(0, len(triangles), _BLOCK):
        corners = local(vertices[triangles[start : start + _BLOCK]])
        area = _length(_cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
        centres = (corners[:, 0] + corners[:, 1] + corners[:, 2]) / 3
        moments = centres * area[:, np.newaxis]
        sums.append(pairwise_sum(np.column_stack([moments, area])))
        largest = max(largest, float(area.max()))
    # Rounding gives a line of triangles a small area, and that noise must not place the pivot.
    if largest <= _FLAT_AREA and degenerate_count(vertices, triangles) == len(triangles):
        return None
    total = pairwise_sum(np.array(sums))
    return total[:3] / total[3] if total[3] > 0.0 else None


def _exponent(magnitudes: NDArray[np.float64]) -> int:
    """Return e such that the largest magnitude is in [2^(e-1), 2^e); 0 where all are zero."""
    return math.frexp(float(magnitudes.max()))[1]


def _times_power(values: NDArray[np.float64], exponent: int) -> NDArray[np.float64]:
    """Return `values` times 2^exponent: as `np.ldexp`, and several times as fast."""
    half = exponent // 2
    return (values * 2.0**half) * 2.0 ** (exponent - half)


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the cross products of rows; `np.cross` without its overhead."""
    return np.stack(
        [
            a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1],
            a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2],
            a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0],
        ],
        axis=1,
    )


def _length(a: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the lengths of rows in a fixed order of operations."""
    return np.asarray(np.sqrt(a[:, 0] * a[:, 0] + a[:, 1] * a[:, 1] + a[:, 2] * a[:, 2]))


def degenerate_count(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> int:
    """Return how many triangles have an area of exactly zero."""
    blocks = (triangles[start : start + _BLOCK] for start in range(0, len(triangles), _BLOCK))
    return sum(int(np.count_nonzero(degenerate(vertices[block]))) for block in blocks)


def degenerate(corners: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which triangles have an area of exactly zero.

    A float filter settles nearly all; products without rounding settle those whose edges are exact
    differences; rational arithmetic settles the rest.

    Args:
        corners: float64 (F, 3, 3), the corners of each triangle.
    """
    largest = np.abs(corners).max(axis=(1, 2))
    exponents = np.frexp(largest)[1]
    scaled = _scaled(corners, exponents)
    edges = scaled[:, 1:] - scaled[:, :1]
    cross = np.abs(_cross(edges[:, 0], edges[:, 1]))
    bound = _cross_of_magnitudes(np.abs(edges[:, 0]), np.abs(edges[:, 1])) * _CROSS_ERROR
    flat = np.asarray(~(cross > bound + _UNDERFLOW).any(axis=1))
    doubtful = np.flatnonzero(flat)
    if len(doubtful):
        restored = np.ldexp(scaled[doubtful], exponents[doubtful, np.newaxis, np.newaxis])
        kept = (restored == corners[doubtful]).all(axis=(1, 2))
        flat[doubtful] = _degenerate_exactly(corners[doubtful], scaled[doubtful], kept)
    return flat


def _scaled(corners: NDArray[np.float64], exponents: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return each triangle's corners divided by its power of two."""
    same = int(exponents.max())
    if same == int(exponents.min()):
        return _times_power(corners, -same)
    return np.asarray(np.ldexp(corners, -exponents[:, np.newaxis, np.newaxis]))


def _cross_of_magnitudes(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the sums of the two products in each component of a cross product."""
    return np.stack(
        [
            a[:, 1] * b[:, 2] + a[:, 2] * b[:, 1],
            a[:, 2] * b[:, 0] + a[:, 0] * b[:, 2],
            a[:, 0] * b[:, 1] + a[:, 1] * b[:, 0],
        ],
        axis=1,
    )


def _degenerate_exactly(
    corners: NDArray[np.float64], scaled: NDArray[np.float64], lossless: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Return which triangles have zero area; `lossless` says where scaling rounded nothing."""
    first, second, third = corners[:, 0], corners[:, 1], corners[:, 2]
    same = (
        (first == second).all(axis=1) | (second == third).all(axis=1) | (third == first).all(axis=1)
    )
    origin = scaled[:, :1]
    edges = scaled[:, 1:] - origin
    # Knuth's two-sum: the rounding error of each difference.
    back = scaled[:, 1:] - edges
    error = (scaled[:, 1:] - (edges + back)) + (back - origin)
    magnitude = np.abs(edges)
    in_range = ((magnitude == 0) | (magnitude > 2.0**-400)).all(axis=(1, 2))
    exact = (error == 0).all(axis=(1, 2)) & in_range & lossless
    flat: NDArray[np.bool_] = same | (exact & _products_agree(edges[:, 0], edges[:, 1]))
    for row in np.flatnonzero(~same & ~exact).tolist():
        flat[row] = _is_flat(corners[row])
    return flat


def _products_agree(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return where each component's two products are equal as exact numbers."""
    agree = np.ones(len(a), dtype=bool)
    for i, j in ((1, 2), (2, 0), (0, 1)):
        high_1, low_1 = _two_product(a[:, i], b[:, j])
        high_2, low_2 = _two_product(a[:, j], b[:, i])
        agree &= (high_1 == high_2) & (low_1 == low_2)
    return agree


def _two_product(
    a: NDArray[np.float64], b: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the rounded products and their rounding errors (Dekker 1971)."""
    product = a * b
    a_high, b_high = _high_half(a), _high_half(b)
    a_low, b_low = a - a_high, b - b_high
    error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
    return product, error


def _high_half(a: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the upper 26 bits of each value."""
    big = a * _SPLITTER
    return big - (big - a)


def _is_flat(corners: NDArray[np.float64]) -> bool:
    """Return whether one triangle's area is zero, in rational arithmetic."""
    # Milliseconds to import, for the few triangles that rounding leaves open.
    from fractions import Fraction

    a, b, c = ([Fraction(x) for x in row] for row in corners.tolist())
    u = [q - p for p, q in zip(a, b, strict=True)]
    v = [q - p for p, q in zip(a, c, strict=True)]
    return all(u[i] * v[j] == u[j] * v[i] for i, j in ((1, 2), (2, 0), (0, 1)))
