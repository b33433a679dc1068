"""Where bodies go: boxes that travel at constant velocities, and hold their bodies all the while.

A body that turns stays in the solid that its box sweeps about the axis, however often it turns, in
the ball about its pivot, and within the largest chord of its turn of where it was. The box around
what these have in common travels with the linear velocity.

Rounding is counted once for all: boxes are wider by 2^-40 of every length that goes into them. That
also covers what the questions about pairs round (2^-45, as `legs` and the kernels say), so that a
pair whose boxes do not meet is one that these questions prove apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from obbcli.accuracy import Accuracy
    from obbcli.motion.body import Body, Surface
    from obbcli.motion.pieces import Piece

    Array = NDArray[np.float64]

MARGIN = 2.0**-40
_NOWHERE = np.zeros(3)  # the pivot of bodies that do not turn
_LEAST = 2.0**-1060  # covers the rounding of sums of subnormal numbers
# By how much poses, orthonormal to 1e-9, may lengthen a vector.
_STRETCH = 1 + 2.0**-28
# A box whose faces touch points of diameter D has all of it within sqrt(3) D of them.
_BOX_REACH = 1.8


class SweptBoxes(NamedTuple):
    """Boxes that travel, as the kernels take them.

    Attributes:
        bodies: uint32 (E,), which body each belongs to.
        times: float64 (E, 2), s; from when to when.
        boxes: float64 (E, 9): lower and upper corner at the first of its times, and velocity.
    """

    bodies: NDArray[np.uint32]
    times: Array
    boxes: Array


class _BodyPiece(NamedTuple):
    """A piece of a body's motion, with the bounds of the body."""

    body: int
    bounds: Array
    piece: Piece
    # In world coordinates; None: the centroid of the mesh, posed.
    pivot: Array | None
    centroid: Array


def swept_boxes(
    bodies: Sequence[Body], shapes: Sequence[Surface], duration: float, accuracy: Accuracy
) -> SweptBoxes:
    """Return boxes that hold bodies during [0, duration], as far as `accuracy` tells them apart.

    Args:
        bodies: the bodies.
        shapes: the loaded shape of each body.
        duration: s.
        accuracy: where boxes stand for triangles they reach further than these; sampled frames are
            other rotations than the true ones.
    """
    is_sampled = accuracy.method == "sampled"
    pieces: list[_BodyPiece] = []
    balls: list[tuple[int, Array]] = []
    limits = (accuracy.max_depth_a, accuracy.max_depth_b)
    is_coarse = accuracy.leaves == "boxes" or limits != (None, None)
    with np.errstate(all="ignore"):  # a box that is not finite meets every other
        for number, (body, shape) in enumerate(zip(bodies, shapes, strict=True)):
            bounds = _grown(shape.bounds) if is_coarse else shape.bounds
            motion = body.motion.steady or body.motion
            found = list(motion.pieces(duration, body.pose))
            if is_sampled and motion.steady is None:
                balls.append((number, _ball_of_pieces(bounds, found)))
                continue
            for piece in found:
                pivot = piece.motion.pivot if piece.motion.is_turning else _NOWHERE
                centroid = shape.surface_centroid if pivot is None else _NOWHERE
                pieces.append(_BodyPiece(number, bounds, piece, pivot, centroid))
        boxes = _boxes(pieces, is_sampled=is_sampled)
    times = [(one.piece.start, one.piece.end) for one in pieces] + [(0.0, duration)] * len(balls)
    numbers = [one.body for one in pieces] + [number for number, _ in balls]
    rows = np.concatenate([boxes, *(ball[None] for _, ball in balls)])
    return SweptBoxes(np.array(numbers, np.uint32), np.array(times), rows)


def _grown(bounds: Array) -> Array:
    """Return bounds that hold all boxes of a tree, which stand for triangles."""
    low, high = bounds
    reach = _BOX_REACH * _length(high - low)
    return np.array([low - reach, high + reach])


def _ball_of_pieces(bounds: Array, pieces: Sequence[Piece]) -> Array:
    """Return a box at rest around all that sampling makes of a motion in pieces.

    Its centers are on chords between the poses' translations, its frames any rotations.
    """
    poses = [piece.pose for piece in pieces]
    poses += [piece.after[0] for piece in pieces if piece.after is not None]
    places = np.array([pose.translation for pose in poses])
    radius = _STRETCH * float(_lengths(_corners(bounds[None]))[0].max())
    reach = radius + MARGIN * (radius + float(np.abs(places).sum(axis=1).max()))
    return np.concatenate([places.min(axis=0) - reach, places.max(axis=0) + reach, np.zeros(3)])


@dataclass(frozen=True, eq=False)
class _Placed:
    """Pieces as arrays, one row each."""

    corners: Array  # of the posed boxes, (N, 8, 3)
    sizes: Array  # the 1-norms of all that is added up for them, (N,)
    velocity: Array
    spin: Array
    pivot: Array
    time: Array


def _placed(pieces: Sequence[_BodyPiece]) -> _Placed:
    corners = _corners(np.array([one.bounds for one in pieces]))
    rotations = np.array([one.piece.pose.rotation for one in pieces])
    shifts = np.array([one.piece.pose.translation for one in pieces])
    placed = corners @ rotations.transpose(0, 2, 1) + shifts[:, None]
    velocity = np.array([one.piece.motion.linear_velocity for one in pieces])
    centroids = np.array([one.centroid for one in pieces])
    pivot = (rotations @ centroids[:, :, None])[:, :, 0] + shifts
    rows = [row for row, one in enumerate(pieces) if one.pivot is not None]
    if rows:
        pivot[rows] = [pieces[row].pivot for row in rows]
    time = np.array([one.piece.end - one.piece.start for one in pieces])
    sizes = 2 * np.abs(corners).sum(axis=2).max(axis=1)
    for vectors in (shifts, 2 * pivot, time[:, None] * velocity):
        sizes = sizes + np.abs(vectors).sum(axis=1)
    spin = np.array([one.piece.motion.angular_velocity for one in pieces])
    return _Placed(placed, sizes, velocity, spin, pivot, time)


def _boxes(pieces: Sequence[_BodyPiece], *, is_sampled: bool) -> Array:
    """Return the rows of pieces, (N, 9)."""
    if not pieces:
        return np.empty((0, 9))
    placed = _placed(pieces)
    low, high = placed.corners.min(axis=1), placed.corners.max(axis=1)
    is_turning = (placed.spin != 0).max(axis=1, keepdims=True)
    turned_low, turned_high = _ball(placed) if is_sampled else _turned(placed, low, high)
    low, high = np.where(is_turning, turned_low, low), np.where(is_turning, turned_high, high)
    wider = MARGIN * placed.sizes + _LEAST + _jumps(pieces)
    return np.concatenate([low - wider[:, None], high + wider[:, None], placed.velocity], axis=1)


def _turned(placed: _Placed, low: Array, high: Array) -> tuple[Array, Array]:
    """Return boxes around all places of turning bodies, but for their linear velocity."""
    largest = np.abs(placed.spin).max(axis=1, keepdims=True)
    axis = placed.spin / largest
    length = np.sqrt((axis * axis).sum(axis=1, keepdims=True))
    axis = axis / length
    arms = placed.corners - placed.pivot[:, None]
    along = (arms * axis[:, None]).sum(axis=2)
    radius = _lengths(np.cross(axis[:, None], arms)).max(axis=1)[:, None]
    squares = axis * axis
    # 1 - w^2 would lose all digits where the axis is a coordinate axis.
    across = np.sqrt(np.roll(squares, 1, axis=1) + np.roll(squares, 2, axis=1))
    ends = np.array([along.min(axis=1)[:, None] * axis, along.max(axis=1)[:, None] * axis])
    solid_low = placed.pivot + ends.min(axis=0) - radius * across
    solid_high = placed.pivot + ends.max(axis=0) + radius * across
    angle = (1 + MARGIN) * largest * length * placed.time[:, None]
    chord = (1 + MARGIN) * 2 * radius * np.sin(0.5 * np.minimum(angle, np.pi)) * across
    ball_low, ball_high = _ball(placed)
    return (
        np.maximum(np.maximum(solid_low, ball_low), low - chord),
        np.minimum(np.minimum(solid_high, ball_high), high + chord),
    )


def _ball(placed: _Placed) -> tuple[Array, Array]:
    """Return boxes around bodies in any rotation about their pivots."""
    radius = _STRETCH * _lengths(placed.corners - placed.pivot[:, None]).max(axis=1)[:, None]
    return placed.pivot - radius, placed.pivot + radius


def _jumps(pieces: Sequence[_BodyPiece]) -> Array:
    """Bound how far from the next pose any vertex is at the end of its piece, (N,).

    As `through_poses.jump_at` has it, which the questions count against what they prove.
    """
    jumps = np.zeros(len(pieces))
    rows = [row for row, one in enumerate(pieces) if one.piece.after is not None]
    if not rows:
        return jumps
    spins, defects, shifts, bounds = [], [], [], []
    for row in rows:
        piece = pieces[row].piece
        assert piece.after is not None
        pose, time = piece.after
        spins.append(time * piece.motion.angular_velocity)
        defects.append((piece.pose.rotation, pose.rotation))
        end = piece.pose.translation + time * piece.motion.linear_velocity
        shifts.append(end - pose.translation)
        bounds.append(pieces[row].bounds)
    here, there = np.array(defects).transpose(1, 0, 2, 3)
    off = _rotations(np.array(spins)) @ here - there
    low, high = np.array(bounds).transpose(1, 0, 2)
    center = 0.5 * low + 0.5 * high
    middle = (off @ center[:, :, None])[:, :, 0] + np.array(shifts)
    spread = np.sqrt((off * off).sum(axis=(1, 2))) * _lengths(high - center)
    jumps[rows] = (1 + MARGIN) * (_lengths(middle) + spread)
    return jumps


def _rotations(vectors: Array) -> Array:
    """Return the rotation matrices of rotation vectors, (N, 3, 3)."""
    angle = _lengths(vectors)[:, None]
    x, y, z = (vectors / np.where(angle > 0, angle, 1.0)).T
    zero = np.zeros_like(x)
    cross = np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)
    sine, versine = np.sin(angle), 2 * np.sin(0.5 * angle) ** 2
    rotations: Array = np.eye(3) + sine[:, None] * cross + versine[:, None] * (cross @ cross)
    return rotations


def _corners(bounds: Array) -> Array:
    """Return the corners of boxes, (N, 8, 3), given as lower and upper ones, (N, 2, 3)."""
    which = np.array([(i >> 2 & 1, i >> 1 & 1, i & 1) for i in range(8)])
    corners: Array = bounds[:, which, np.arange(3)]
    return corners


def _lengths(vectors: Array) -> Array:
    """Return the lengths of vectors, over the last axis, whatever their size."""
    scale = np.abs(vectors).max(axis=-1, keepdims=True)
    units = vectors / np.where(scale > 0, scale, 1.0)
    lengths: Array = scale[..., 0] * np.sqrt((units * units).sum(axis=-1))
    return lengths


def _length(vector: Array) -> float:
    return float(_lengths(vector[None])[0])
