"""Every pair of triangles that intersect: `triangle_pairs`, and some at a time.

There may be as many pairs as the product of the numbers of triangles, which no memory holds.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli import kernels
from obbcli.errors import UnresolvedError
from obbcli.mesh import Mesh
from obbcli.motion.body import Body, as_body
from obbcli.questions.border import NO_LIMIT, placed_of, refused, whole_limit
from obbcli.questions.pair_question import trees_of
from obbcli.threads import thread_count
from obbcli.tree.tree import ObbTree

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.motion.body import Shape
    from obbcli.questions.pair_question import Trees

# What a pair takes at the peak: two rows, and what lists that grow set aside.
_BYTES_A_PAIR = 32
_FEW = 4  # after a block of less than 1 / _FEW of its room, the next takes twice the rows


def triangle_pairs(
    a: Body | Shape,
    b: Body | Shape,
    limit: int | None = None,
    *,
    threads: int | None = None,
    max_memory: int | None = None,
) -> NDArray[np.int64]:
    """Return every pair of triangles that intersect at t = 0, int64 (N, 2), sorted.

    Exact: the same pairs as testing all triangles against all others in rational arithmetic.
    Rows of the meshes' files. Motions play no part. There may be as many pairs as the product of
    the numbers of triangles: `triangle_pair_blocks` yields them some at a time.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        limit: stop after so many pairs, and return those, sorted. Which ones depends on the trees.
            One thread looks for them.
        threads: at most so many; None: as many as this process may use cores. They change nothing
            but the time it takes.
        max_memory: bytes that the pairs may need, about. None: no limit.

    Raises:
        UnresolvedError: the pairs need more than `max_memory`.
        MotionError: `limit` or `max_memory` is no whole number of at least 1, or posed coordinates
            leave the range of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        ObbError: `threads` is no positive integer.
        OSError: a file cannot be read.

    Example:
        >>> from obbcli import Body, Pose
        >>> moved = Body("sample_meshes/pinion.stl", Pose(translation=[-1, 0, 0]))
        >>> triangle_pairs("sample_meshes/gear.stl", moved, limit=2).tolist()
        [[92, 460], [93, 460]]
    """
    workers = thread_count(threads)
    most = NO_LIMIT if limit is None else whole_limit(limit)
    bodies = as_body(a), as_body(b)
    trees = trees_of(bodies)
    here, there = map(placed_of, bodies, trees)
    room = NO_LIMIT
    if max_memory is not None:
        room = whole_limit(max_memory, "max_memory") // _BYTES_A_PAIR
    try:
        found, _counts = kernels.triangle_pairs(here, there, most, workers, room)
    except (ValueError, kernels.TreeError) as fault:
        raise refused(trees, fault) from fault
    if found is None:
        raise UnresolvedError(
            "max_memory",
            f"more than {room} pairs of triangles intersect, and {max_memory} bytes are allowed",
            "allow more, cut the list with limit, or take it in blocks",
        )
    return found


def triangle_pair_blocks(
    a: Body | Shape, b: Body | Shape, most: int = 1_000_000, *, threads: int | None = None
) -> Iterator[NDArray[np.int64]]:
    """Yield what `triangle_pairs` returns, in its order, as arrays int64 (N, 2).

    The first pairs come before others are looked for, and memory stays bounded however many there
    are. Where they do not fit into one block, the triangles of A are asked about by ranges of rows,
    each with a tree of its own that grows as far as needed; that takes about twice as long.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        most: pairs a block, at most; more only where a single triangle of A has more.
        threads: at most so many; None: as many as this process may use cores. They change nothing
            but the time it takes.

    Raises:
        MotionError: `most` is no whole number of at least 1, or posed coordinates leave the range
            of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        ObbError: `threads` is no positive integer.
        OSError: a file cannot be read.

    Examples:
        The pinion 1 mm into the gear has 342 pairs, here in blocks of at most 100:

        >>> from obbcli import Body, Pose
        >>> moved = Body("sample_meshes/pinion.stl", Pose(translation=[-1, 0, 0]))
        >>> blocks = list(triangle_pair_blocks("sample_meshes/gear.stl", moved, 100))
        >>> sum(len(block) for block in blocks), max(len(block) for block in blocks) <= 100
        (342, True)
        >>> blocks[0][0].tolist()
        [0, 566]
    """
    workers = thread_count(threads)
    room = whole_limit(most, "most")
    bodies = as_body(a), as_body(b)
    return _blocks(bodies, trees_of(bodies), room, workers)


def _blocks(
    bodies: tuple[Body, Body], trees: Trees, room: int, workers: int
) -> Iterator[NDArray[np.int64]]:
    count = trees[0].triangle_count
    start, rows = 0, count
    while start < count:
        rows = min(rows, count - start)
        tree = trees[0] if rows == count else _part(trees[0], start, rows)
        # One triangle of A has at most as many pairs as B has triangles.
        found = _pairs(bodies, (tree, trees[1]), NO_LIMIT if rows == 1 else room, workers)
        if found is None:
            rows = (rows + 1) // 2
            continue
        if len(found) > 0:
            yield found + np.array([start, 0]) if start > 0 else found
        start += rows
        if len(found) < room // _FEW:
            rows *= 2


def _part(tree: ObbTree, start: int, rows: int) -> ObbTree:
    """Return a tree over some rows of another's mesh."""
    mesh = tree.mesh
    used, corners = np.unique(mesh.triangles[start : start + rows], return_inverse=True)
    return ObbTree.build(Mesh(mesh.vertices[used], corners.reshape(-1, 3)))


def _pairs(
    bodies: tuple[Body, Body], trees: Trees, room: int, workers: int
) -> NDArray[np.int64] | None:
    """Return all pairs; None where there are more than there is room for."""
    here = placed_of(Body(trees[0], bodies[0].pose), trees[0])
    there = placed_of(bodies[1], trees[1])
    try:
        return kernels.triangle_pairs(here, there, NO_LIMIT, workers, room)[0]
    except (ValueError, kernels.TreeError) as fault:
        raise refused(trees, fault) from fault
