"""What a motion is made of: pieces, times in which velocities are constant.

Whatever asks about a motion asks about its pieces, and so need not know of which kind it is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from obbcli.motion.motion import Motion
    from obbcli.motion.pose import Pose


class Piece(NamedTuple):
    """A time in which a body has constant velocities, and where it is at the start of it.

    Attributes:
        start: s.
        end: s.
        pose: of the body at the start.
        motion: of constant velocities, on a clock that begins at the start.
        after: the pose that the next piece starts with, and after how many s; None where none
            follows. Rounding leaves the end of a piece a little off the pose after it.
    """

    start: float
    end: float
    pose: Pose
    motion: Motion
    after: tuple[Pose, float] | None = None


class Moment(NamedTuple):
    """Where a motion has taken a body by some time, and how it goes on.

    Attributes:
        pose: of the body then.
        motion: of constant velocities, on a clock that begins then, up to the end of the piece.
        summands: vectors whose lengths bound, times a rounding, how far the pose is off the path;
            none where the pose is exact.
    """

    pose: Pose
    motion: Motion
    summands: tuple[NDArray[np.float64], ...] = ()


class Jump(NamedTuple):
    """Where a piece ends, and the pose that the next piece starts with: they differ by rounding.

    Attributes:
        end: the pose that the piece's own velocities lead to.
        after: the pose that the next piece starts with.
        summands: vectors whose lengths bound, times a rounding, how far `end` itself is off.
    """

    end: Pose
    after: Pose
    summands: tuple[NDArray[np.float64], ...]
