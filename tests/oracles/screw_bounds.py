"""Proofs that moving features stay apart for a while: vertex and face, edge and edge.

A rigid point's path along an axis differs from its tangent by at most half its acceleration times
the time squared, whether the axis stays in the world or turns with a body. One code for doubles
(many features at once) and for mpmath's numbers (few, to any precision). Lengths and times are
scaled to about 1 by the caller.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import mpmath
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from fractions import Fraction

Array = Any  # float64, or object arrays of mpmath's numbers
WIDE_DIGITS = 45


class Arithmetic(NamedTuple):
    """Numbers of one kind, elementwise; `unit` bounds the relative rounding of one operation."""

    array: Callable[[Any], Array]
    sin: Callable[[Array], Array]
    cos: Callable[[Array], Array]
    sqrt: Callable[[Array], Array]
    unit: float
    tiny: float


def _doubles(numbers: Any) -> Array:
    return np.array(numbers, dtype=object).astype(np.float64)


def _wide(numbers: Any) -> Array:
    return np.frompyfunc(_mpf, 1, 1)(np.array(numbers, dtype=object))


def _mpf(number: Any) -> mpmath.mpf:
    if isinstance(number, mpmath.mpf):
        return number
    top, bottom = number.as_integer_ratio()
    return mpmath.mpf(top) / bottom


DOUBLE = Arithmetic(_doubles, np.sin, np.cos, np.sqrt, 2.0**-52, 1e-290)
# The caller keeps mpmath at WIDE_DIGITS while it uses these.
WIDE = Arithmetic(
    _wide,
    np.frompyfunc(mpmath.sin, 1, 1),
    np.frompyfunc(mpmath.cos, 1, 1),
    np.frompyfunc(mpmath.sqrt, 1, 1),
    10.0 ** (2 - WIDE_DIGITS),
    1e-290,
)


class Rotor(NamedTuple):
    """A body about its pivot: vertex i is `offset + t drift + along + cos across + sin turned`."""

    offset: Array
    drift: Array
    along: Array
    across: Array
    turned: Array
    spin: Array
    axis: Array
    speed: Any
    radius: Array
    height: Array


def dot(p: Array, q: Array) -> Array:
    return (p * q).sum(axis=-1)


def cross(p: Array, q: Array) -> Array:
    x, y, z = p[..., 0], p[..., 1], p[..., 2]
    u, v, w = q[..., 0], q[..., 1], q[..., 2]
    return np.stack((y * w - z * v, z * u - x * w, x * v - y * u), axis=-1)


def rotor(
    arms: Sequence[Sequence[Fraction]], spin: Any, offset: Any, drift: Any, kind: Arithmetic
) -> Rotor:
    """Return a body from its vertices relative to the pivot and its motion, all as rationals."""
    y, w = kind.array(arms), kind.array(spin)
    speed = kind.sqrt(kind.array([sum(n * n for n in spin)]))[0]
    axis = w / speed if speed else w
    height = dot(y, axis)
    along = height[:, None] * axis if speed else y
    across = y - along
    return Rotor(
        kind.array(offset),
        kind.array(drift),
        along,
        across,
        cross(axis + 0 * across, across),
        w,
        axis,
        speed,
        kind.sqrt(dot(across, across)),
        abs(height),
    )


def places(body: Rotor, index: Array, time: Array, kind: Arithmetic) -> tuple[Array, Array]:
    """Return positions and velocities (n, p, 3) of the vertices `index` (n, p) at times (n,)."""
    angle = body.speed * time
    sine, cosine = (f(angle)[:, None, None] for f in (kind.sin, kind.cos))
    across, turned = body.across[index], body.turned[index]
    center = body.offset + time[:, None] * body.drift
    position = center[:, None] + body.along[index] + cosine * across + sine * turned
    velocity = body.drift + body.speed * (cosine * turned - sine * across)
    return position, velocity


class Frame(NamedTuple):
    """A frame that turns with `spin`, and how far from straight lines bodies move in it.

    Over times in [0, 1] the difference of vertices i of A and j of B accelerates by at most
    `reach_a[i] + reach_b[j] + pivots`; along an axis in the world, reaches count as far as the axis
    lies across the spins.
    """

    spin: Array
    reach_a: Array
    reach_b: Array
    pivots: Any
    is_world: bool


def frames(a: Rotor, b: Rotor, kind: Arithmetic) -> list[Frame]:
    """Return the world and the frames of the bodies that turn."""
    circles = [body.speed**2 * body.radius for body in (a, b)]
    result = [Frame(0 * a.spin, circles[0], circles[1], 0 * a.speed, is_world=True)]
    for spin in (a.spin, b.spin):
        if spin.any():
            reach = [(1 + 64 * kind.unit) * _reach(body, spin, kind) for body in (a, b)]
            # Twice the drift turned, and the pivots' own circle at either end.
            ends = [b.offset, b.offset + b.drift]
            terms = [2 * cross(spin, b.drift), *(cross(spin, cross(spin, end)) for end in ends)]
            swing, *circling = (kind.sqrt(dot(v, v)) for v in terms)
            result.append(Frame(spin, reach[0], reach[1], swing + max(circling), is_world=False))
    return result


def _reach(body: Rotor, spin: Array, kind: Arithmetic) -> Array:
    """Return bounds (V,) of the acceleration of the arms in a turning frame.

    It is `N arm`, N = W W - 2 F W + F F with W and F as cross products; along the body's axis the
    arm stays, across it only its length does.
    """
    w, f = _as_matrix(body.spin), _as_matrix(spin)
    product = w.dot(w) - 2 * f.dot(w) + f.dot(f)
    norm = kind.sqrt((product * product).sum())
    if not body.speed:
        return norm * kind.sqrt(dot(body.along, body.along))
    lift = product.dot(body.axis)
    return norm * body.radius + kind.sqrt(dot(lift, lift)) * body.height


def _as_matrix(w: Array) -> Array:
    x, y, z = w
    return np.array([[0 * x, -z, y], [z, 0 * x, -x], [-y, x, 0 * x]])


class Apart(NamedTuple):
    """How long before and after a moment features were proven apart; 0 where nothing is."""

    before: Array
    after: Array


class Couple:
    """Two bodies in scaled units, ready to be asked about their features."""

    def __init__(self, a: Rotor, b: Rotor, kind: Arithmetic) -> None:
        self.a, self.b, self.kind = a, b, kind
        self.frames = frames(a, b, kind)
        arms = [kind.sqrt(body.radius**2 + body.height**2).max() for body in (a, b) if body.speed]
        arms += [abs(body.along).max() * 2 for body in (a, b) if not body.speed]
        length = 2 * sum(arms) + abs(b.offset).sum() + abs(b.drift).sum()
        turn = sum(body.speed * body.radius.max() for body in (a, b))
        # Positions: a few sums and products each, and the angle's rounding times the radius.
        self.margin = 32 * kind.unit * (length + turn)

    def apart(self, index_a: Array, index_b: Array, time: Array) -> Apart:
        """Return how long features (n, p), (n, q) of vertices are proven apart around times."""
        points_a, speeds_a = places(self.a, index_a, time, self.kind)
        points_b, speeds_b = places(self.b, index_b, time, self.kind)
        axes = self._with_spins(self._unit(_axes(points_a, points_b)))
        gaps = _between(axes, points_a, points_b)
        sign = np.where(gaps.min(axis=(2, 3)) >= -gaps.max(axis=(2, 3)), 1, -1)[..., None, None]
        room = sign * gaps - self.margin
        room = np.where(room > 0, room, 0 * room)
        before, after = 0 * time, 0 * time
        for frame in self.frames:
            moved_a = speeds_a - cross(frame.spin + 0 * points_a, points_a)
            moved_b = speeds_b - cross(frame.spin + 0 * points_b, points_b)
            closing = sign * _between(axes, moved_a, moved_b)
            bend = self._bend(frame, axes, index_a, index_b)
            after = np.maximum(after, self._reach(room, closing, bend))
            before = np.maximum(before, self._reach(room, -closing, bend))
        return Apart(before, after)

    def _with_spins(self, axes: Array) -> Array:
        """Return the axes and those of rotation, along which nothing turns."""
        spins = [body.axis for body in (self.a, self.b) if body.speed]
        return np.concatenate([axes, *(axis + 0 * axes[:, :1] for axis in spins)], axis=1)

    def _unit(self, axes: Array) -> Array:
        square = dot(axes, axes)
        zero = square < 1e-250
        return (
            np.where(zero[..., None], 0 * axes, axes)
            / self.kind.sqrt(np.where(zero, 1 + 0 * square, square))[..., None]
        )

    def _bend(self, frame: Frame, axes: Array, index_a: Array, index_b: Array) -> Array:
        """Return bounds of the acceleration along the axes, (n, k, p, q)."""
        arm_a, arm_b = frame.reach_a[index_a][:, None], frame.reach_b[index_b][:, None]
        if frame.is_world:
            arm_a = arm_a * self._across(axes, self.a.axis)[..., None]
            arm_b = arm_b * self._across(axes, self.b.axis)[..., None]
        total = arm_a[..., :, None] + arm_b[..., None, :] + frame.pivots
        return total * (1 + 1e-12) + self.kind.tiny

    def _across(self, axes: Array, axis: Array) -> Array:
        part = cross(axes, axis + 0 * axes)
        return self.kind.sqrt(dot(part, part)) + 8 * self.kind.unit

    def _reach(self, room: Array, closing: Array, bend: Array) -> Array:
        """Return the first root of `room + closing s - bend s^2 / 2` for the best axis, (n,)."""
        root = self.kind.sqrt(closing * closing + 2 * bend * room)
        toward = closing < 0
        denominator = np.where(toward, root - closing, 1 + 0 * root)
        late = np.where(toward, 0 * closing, closing + root) / bend
        reach = np.where(toward, 2 * room / denominator, late)
        # Without room the axis proves nothing, however fast the two part.
        reach = np.where(room > 0, reach, 0 * reach)
        return reach.min(axis=(2, 3)).max(axis=1)


def _between(axes: Array, a: Array, b: Array) -> Array:
    """Return `axis . (b_j - a_i)`, (n, k, p, q)."""
    along_a = dot(axes[:, :, None], a[:, None])
    along_b = dot(axes[:, :, None], b[:, None])
    return along_b[:, :, None, :] - along_a[:, :, :, None]


def _axes(a: Array, b: Array) -> Array:
    """Return directions (n, k, 3) among which is that of the nearest points, wherever they lie."""
    sides_a, sides_b = _sides(a), _sides(b)
    axes = [b[:, j] - a[:, i] for i in range(a.shape[1]) for j in range(b.shape[1])]
    for points, others, sides in ((a, b, sides_b), (b, a, sides_a)):
        for i in range(points.shape[1]):
            for number, side in enumerate(sides):
                axes.append(cross(side, cross(points[:, i] - others[:, number], side)))
    pairs = [(u, v) for u in sides_a for v in sides_b]
    pairs = pairs or [(sides[0], sides[1]) for sides in (sides_a, sides_b) if sides]
    axes += [cross(u, v) for u, v in pairs]
    return np.stack(axes, axis=1)


def _sides(points: Array) -> list[Array]:
    """Return the edge vectors of points (n, p, 3), number i through point i; of a point, none."""
    count = {1: 0, 2: 1, 3: 3}[points.shape[1]]
    return [points[:, i] - points[:, i - 1] for i in range(count)]
