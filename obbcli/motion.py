"""Where a body is and how it moves: `Pose`, `Motion` and the `Body` that carries them.

World position of a vertex `p`: `x(0) = Q p + s`, then `x(t) = K + t V + R(t W) (x(0) - K)`.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol, TypeAlias

import numpy as np

from obbcli import kernels
from obbcli.arrays import as_floats, as_vector
from obbcli.errors import MotionError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class Surface(Protocol):
    """What a body can be made of: an `ObbTree` or a `Mesh`."""

    @property
    def bounds(self) -> NDArray[np.float64]:
        """Lower and upper corner, (2, 3)."""

    @property
    def surface_centroid(self) -> NDArray[np.float64]:
        """The default pivot, unposed, (3,)."""


Shape: TypeAlias = "Surface | str | os.PathLike[str]"

# What a matrix read from a file with ten digits still meets; boxes and bounds allow for it.
ORTHONORMAL_TOLERANCE = 1e-9


@dataclass(frozen=True, init=False, eq=False)
class Pose:
    """Where a body is at t = 0: `x(0) = Q p + s`.

    Args:
        rotation: Q as a (3, 3) matrix, orthonormal to 1e-9 and right-handed, used literally; or a
            (3,) rotation vector in radians (axis times angle). None: no turn.
        translation: s, (3,) mesh units. None: no shift.

    Attributes:
        rotation: float64 (3, 3), read-only.
        translation: float64 (3,), read-only.

    Raises:
        MotionError: not finite, of another shape, not orthonormal, or a reflection.
    """

    rotation: NDArray[np.float64]
    translation: NDArray[np.float64]

    def __init__(
        self, rotation: ArrayLike | None = None, translation: ArrayLike | None = None
    ) -> None:
        object.__setattr__(self, "rotation", _as_rotation(rotation))
        object.__setattr__(self, "translation", _vector_or_zero(translation, "translation"))

    @property
    def is_identity(self) -> bool:
        """Return whether the pose moves nothing; such a pose rounds nothing either."""
        return not self.translation.any() and np.array_equal(self.rotation, np.eye(3))

    @cached_property
    def kernel(self) -> kernels.Pose:
        """The pose as the kernels see it."""
        return kernels.Pose(self.rotation, self.translation)

    def apply(self, points: ArrayLike) -> NDArray[np.float64]:
        """Return the posed points, float64 (N, 3), rounded as the queries round them.

        Args:
            points: (N, 3) mesh units.

        Raises:
            MotionError: not (N, 3) finite numbers.
        """
        p = as_floats(points, (None, 3), "points", MotionError)
        if self.is_identity:
            return p
        q = self.rotation
        return p[:, :1] * q[:, 0] + p[:, 1:2] * q[:, 1] + p[:, 2:] * q[:, 2] + self.translation


@dataclass(frozen=True, init=False, eq=False)
class Motion:
    """How a body moves: constant linear and angular velocity in the world frame.

    Args:
        linear_velocity: V, (3,) mesh units a second. None: 0.
        angular_velocity: W, (3,) rad/s. None: 0.
        pivot: K, (3,) world coordinates: where the axis of rotation passes at t = 0; it travels
            with V. None: the centroid of the body's surface, posed.

    Attributes:
        linear_velocity: float64 (3,), read-only.
        angular_velocity: float64 (3,), read-only.
        pivot: float64 (3,), read-only, or None.
        is_at_rest: whether neither velocity moves anything.

    Raises:
        MotionError: not three finite numbers.
    """

    linear_velocity: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    pivot: NDArray[np.float64] | None
    is_at_rest: bool

    def __init__(
        self,
        linear_velocity: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        pivot: ArrayLike | None = None,
    ) -> None:
        velocity = _vector_or_zero(linear_velocity, "linear_velocity")
        spin = _vector_or_zero(angular_velocity, "angular_velocity")
        point = None if pivot is None else as_vector(pivot, "pivot", MotionError)
        object.__setattr__(self, "linear_velocity", velocity)
        object.__setattr__(self, "angular_velocity", spin)
        object.__setattr__(self, "pivot", point)
        object.__setattr__(self, "is_at_rest", not (velocity.any() or spin.any()))


def rotation_matrix(vector: ArrayLike, *, degrees: bool = False) -> NDArray[np.float64]:
    """Return the float64 (3, 3) matrix that turns by the length of `vector` about its direction.

    A zero vector gives the identity exactly; in degrees, quarter turns about a coordinate axis
    are exact as well.

    Args:
        vector: (3,) axis times angle.
        degrees: whether the angle is in degrees rather than radians.

    Raises:
        MotionError: not three finite numbers.
    """
    turn = as_vector(vector, "rotation", MotionError)
    angle = math.hypot(*turn)
    if angle == 0.0:
        return np.eye(3)
    if not math.isfinite(angle):
        raise MotionError("rotation", f"turns by {angle}", "give an angle that a double can hold")
    x, y, z = (turn / angle).tolist()
    cosine, sine, versine = _trigonometry(angle, degrees)
    matrix = np.array(
        [
            [cosine + versine * x * x, versine * x * y - sine * z, versine * x * z + sine * y],
            [versine * x * y + sine * z, cosine + versine * y * y, versine * y * z - sine * x],
            [versine * x * z - sine * y, versine * y * z + sine * x, cosine + versine * z * z],
        ]
    )
    return matrix + 0.0  # no negative zeros


def _trigonometry(angle: float, degrees: bool) -> tuple[float, float, float]:
    """Return cos, sin and 1 - cos of an angle, the last without cancellation near 0."""
    if not degrees:
        return math.cos(angle), math.sin(angle), 2.0 * math.sin(0.5 * angle) ** 2
    # The remainder is exact, so that right angles stay right.
    angle = math.remainder(angle, 360.0)
    quarter = round(angle / 90.0)
    rest = math.radians(angle - 90.0 * quarter)
    pairs = (
        (math.cos(rest), math.sin(rest)),
        (-math.sin(rest), math.cos(rest)),
        (-math.cos(rest), -math.sin(rest)),
        (math.sin(rest), -math.cos(rest)),
    )
    cosine, sine = pairs[quarter % 4]
    versine = 2.0 * math.sin(0.5 * rest) ** 2 if quarter % 4 == 0 else 1.0 - cosine
    return cosine, sine, versine


def _as_rotation(rotation: ArrayLike | None) -> NDArray[np.float64]:
    """Return a checked, read-only rotation matrix from a matrix, a rotation vector or None."""
    if rotation is None or _is_vector(rotation):
        matrix = rotation_matrix((0.0, 0.0, 0.0) if rotation is None else rotation)
        matrix.setflags(write=False)
        return matrix
    matrix = as_floats(rotation, (3, 3), "rotation", MotionError)
    # Cut to a tame size first: the products of huge entries would overflow with a warning.
    tame = matrix.clip(-2.0, 2.0)
    defect = float(np.abs(tame @ tame.T - np.eye(3)).max())
    if defect > ORTHONORMAL_TOLERANCE:
        raise MotionError(
            "rotation",
            f"is not orthonormal to {ORTHONORMAL_TOLERANCE:g}: Q Q^T is off by {defect:.3g}",
            "re-orthonormalise it",
        )
    if np.linalg.det(matrix) < 0:
        raise MotionError("rotation", "is a reflection (determinant -1)", "mirror the mesh instead")
    return matrix


def _is_vector(value: ArrayLike) -> bool:
    """Return whether a value has one dimension; ragged lists have none."""
    try:
        return np.ndim(value) == 1
    except ValueError:
        return False


def _vector_or_zero(value: ArrayLike | None, name: str) -> NDArray[np.float64]:
    """Return a checked, read-only (3,) array; None stands for zero."""
    return as_vector((0.0, 0.0, 0.0) if value is None else value, name, MotionError)


def _refuse(name: str, value: object, remedy: str) -> None:
    """Raise for an argument of another kind."""
    raise MotionError(name, f"is of type {type(value).__name__}", remedy)


_AS_LOADED = Pose()
_AT_REST = Motion()


@dataclass(frozen=True, eq=False)
class Body:
    """A shape with its place and motion; taken wherever a tree, a mesh or a path is.

    Args:
        shape: an `ObbTree`, a `Mesh`, or the path of a mesh or tree file.
        pose: where it is at t = 0.
        motion: how it moves from there.

    Raises:
        MotionError: an argument is of another kind.
    """

    shape: Shape
    pose: Pose = _AS_LOADED
    motion: Motion = _AT_REST

    def __post_init__(self) -> None:
        # Told by what it has: trees belong to a layer above this one. By its type, since a tree's
        # bounds cost as much as a whole mesh, and may find it damaged.
        if not isinstance(self.shape, (str, os.PathLike)) and not hasattr(
            type(self.shape), "bounds"
        ):
            _refuse("shape", self.shape, "pass an ObbTree, a Mesh or a path")
        if not isinstance(self.pose, Pose):
            _refuse("pose", self.pose, "pass a Pose")
        if not isinstance(self.motion, Motion):
            _refuse("motion", self.motion, "pass a Motion")


def as_body(shape: Body | Shape) -> Body:
    """Return a `Body` as it is, and anything else at rest where its file put it.

    Raises:
        MotionError: neither a body nor a tree, a mesh or a path.
    """
    return shape if isinstance(shape, Body) else Body(shape)
