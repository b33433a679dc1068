"""Checked arrays of a mesh: read-only, contiguous, and refused by the row that is at fault."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.errors import MeshError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

#: Triangle ids and vertex indices are stored as int32.
MAX_COUNT = 2**31 - 1


def checked_vertices(value: ArrayLike, prefix: str) -> NDArray[np.float64]:
    """Return `value` as finite, read-only, C-contiguous float64 (V, 3)."""
    array = _array(value, "vertices", prefix)
    if array.dtype.kind not in "fiu":
        raise MeshError(f"{prefix}vertices", f"have type {array.dtype}, expected numbers")
    if len(array) > MAX_COUNT:
        fault = f"{len(array)} vertices, at most {MAX_COUNT}"
        raise MeshError(f"{prefix}vertices", fault, "split the mesh")
    vertices = _frozen(array, np.float64)
    # One pass: a sum of finite values can only mislead by overflowing, and then all are looked at.
    with np.errstate(over="ignore", invalid="ignore"):
        total = float(vertices.sum())
    if not np.isfinite(total):
        bad = ~np.isfinite(vertices)
        if bad.any():
            row, axis = divmod(int(np.argmax(bad)), 3)
            raise MeshError(
                f"{prefix}vertex {row}",
                f"{'xyz'[axis]} is {vertices[row, axis]}",
                "coordinates must be finite",
            )
    return vertices


def checked_triangles(value: ArrayLike, vertex_count: int, prefix: str) -> NDArray[np.int32]:
    """Return `value` as read-only, C-contiguous int32 (F, 3), every index below `vertex_count`."""
    array = _array(value, "triangles", prefix)
    if len(array) == 0:
        fault, remedy = "none found, at least one wanted", "a mesh is a surface of triangles"
        raise MeshError(f"{prefix}triangles", fault, remedy)
    if len(array) > MAX_COUNT:
        raise MeshError(
            f"{prefix}triangles", f"{len(array)} triangles, at most {MAX_COUNT}", "split the mesh"
        )
    if array.dtype.kind == "f":
        _refuse_first(array, array != np.floor(array), prefix, "which is no whole number")
    elif array.dtype.kind not in "iu":
        raise MeshError(
            f"{prefix}triangles", f"have type {array.dtype}, expected integers below 2^63"
        )
    if array.min() < 0 or array.max() >= vertex_count:
        outside = (array < 0) | (array >= vertex_count)
        _refuse_first(array, outside, prefix, f"of {vertex_count}; indices start at 0")
    return _frozen(array, np.int32)


def _refuse_first(array: NDArray[Any], bad: NDArray[np.bool_], prefix: str, why: str) -> None:
    """Raise an error that names the first triangle with a bad index, if there is one."""
    if bad.any():
        row, corner = divmod(int(np.argmax(bad)), 3)
        raise MeshError(f"{prefix}triangle {row}", f"uses vertex {array[row, corner]} {why}")


def _array(value: ArrayLike, name: str, prefix: str) -> NDArray[Any]:
    """Return `value` as an array of shape (N, 3), its type not yet looked at."""
    try:
        array = np.asarray(value)
    except (TypeError, ValueError) as fault:
        raise MeshError(f"{prefix}{name}", "is not an array of numbers of shape (N, 3)") from fault
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, 3).astype(np.int64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise MeshError(f"{prefix}{name}", f"has shape {array.shape}, expected (N, 3)")
    return array


def _frozen(array: NDArray[Any], dtype: type) -> NDArray[Any]:
    """Return a read-only C-contiguous array that nobody else writes to, copied if need be."""
    owner = array if array.base is None else array.base
    owned = isinstance(owner, np.ndarray) and owner.base is None
    owned = owned and not owner.flags.writeable and not array.flags.writeable
    taken = np.asarray if owned else np.array
    frozen: NDArray[Any] = taken(array, dtype=dtype, order="C")
    frozen.setflags(write=False)
    return frozen
