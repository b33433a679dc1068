"""Where a body is: `Pose`, a rotation and a translation taken literally."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from obbcli import kernels
from obbcli.arrays import as_floats, as_vector
from obbcli.errors import MotionError
from obbcli.motion.rotation import rotation_matrix

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

# What a matrix read from a file with ten digits still meets; boxes and bounds allow for it.
ORTHONORMAL_TOLERANCE = 1e-9
_NO_TURN = as_floats(np.eye(3), (3, 3), "rotation", MotionError)
_ORIGIN = as_vector((0.0, 0.0, 0.0), "translation", MotionError)


@kernels.made_by_kernels
@dataclass(frozen=True, init=False, eq=False)
class Pose(kernels.Pose):
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

    Example:
        >>> quarter = Pose(rotation=[0, 0, np.pi / 2], translation=[10, 0, 0])
        >>> quarter.apply(np.array([[1.0, 0, 0]])).round(12).tolist()
        [[10.0, 1.0, 0.0]]
    """

    rotation: NDArray[np.float64]
    translation: NDArray[np.float64]

    def __init__(
        self, rotation: ArrayLike | None = None, translation: ArrayLike | None = None
    ) -> None:
        # Arrays of doubles and triples of numbers do not come here: the kernels look at them.
        self._hold(_as_rotation(rotation), vector_or_zero(translation, "translation"))

    def __repr__(self) -> str:
        """Return what makes the same pose again."""
        parts = []
        if not np.array_equal(self.rotation, np.eye(3)):
            parts.append(f"rotation={self.rotation.tolist()}")
        if self.translation.any():
            parts.append(f"translation={self.translation.tolist()}")
        return f"Pose({', '.join(parts)})"

    @classmethod
    def carried(cls, rotation: NDArray[np.float64], translation: NDArray[np.float64]) -> Pose:
        """Return where a motion has carried a checked pose, of which no more is asked.

        Turning leaves the size of `Q Q^T - I` as it is, but not its largest entry, which the check
        looks at: a pose that just passed need not pass again.

        Raises:
            MotionError: not finite.
        """
        pose = cls.__new__(cls)
        pose._hold(
            as_floats(rotation, (3, 3), "rotation", MotionError),
            as_vector(translation, "translation", MotionError),
        )
        return pose

    @property
    def kernel(self) -> kernels.Pose:
        """The pose as the kernels see it: itself."""
        return self

    def told(self) -> dict[str, object]:
        """Return the pose as documents show it: names and plain numbers."""
        return {"rotation": self.rotation.tolist(), "translation": self.translation.tolist()}

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


def _as_rotation(rotation: ArrayLike | None) -> NDArray[np.float64]:
    """Return a checked, read-only rotation matrix from a matrix, a rotation vector or None."""
    if rotation is None:
        return _NO_TURN
    if _is_vector(rotation):
        matrix = rotation_matrix(rotation)
        matrix.setflags(write=False)
        return matrix
    matrix = as_floats(rotation, (3, 3), "rotation", MotionError)
    # Python's own floats: for nine numbers NumPy takes five times as long.
    x, y, z = matrix.tolist()
    dots = _dot(x, x) - 1.0, _dot(y, y) - 1.0, _dot(z, z) - 1.0, _dot(x, y), _dot(y, z), _dot(z, x)
    # Huge entries overflow to NaN, which fails this comparison and is refused.
    if not all(abs(defect) <= ORTHONORMAL_TOLERANCE for defect in dots):
        # Entries are clipped first: the products of huge ones would overflow with a warning.
        tame = matrix.clip(-2.0, 2.0)
        defect = float(np.abs(tame @ tame.T - np.eye(3)).max())
        raise MotionError(
            "rotation",
            f"is not orthonormal to {ORTHONORMAL_TOLERANCE:g}: Q Q^T is off by {defect:.3g}",
            "re-orthonormalise it",
        )
    across = x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]
    if _dot(across, z) < 0:
        raise MotionError("rotation", "is a reflection (determinant -1)", "mirror the mesh instead")
    return matrix


def _dot(p: Sequence[float], q: Sequence[float]) -> float:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def _is_vector(value: ArrayLike) -> bool:
    """Return whether a value has one dimension; ragged lists have none."""
    try:
        return np.ndim(value) == 1
    except ValueError:
        return False


def vector_or_zero(value: ArrayLike | None, name: str) -> NDArray[np.float64]:
    """Return a checked, read-only (3,) array; None stands for zero."""
    return _ORIGIN if value is None else as_vector(value, name, MotionError)
