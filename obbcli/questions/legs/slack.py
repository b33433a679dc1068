"""How far legs are off the true paths of their bodies: rounding, and jumps between pieces."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.motion.body import Body
    from obbcli.motion.pose import Pose
    from obbcli.tree.tree import ObbTree

# Of the coordinates: posing a vertex thrice (12 u each), a matrix product (16 u) and the pose in
# closed form (28 u) come to a third of this; the rest lets the kernels prove closeness within it.
ROUNDING = 2.0**-45


def rounding_of(tree: ObbTree, *vectors: NDArray[np.float64]) -> float:
    """Bound what rounding moves a vertex by where these are added up."""
    return ROUNDING * sum(map(norm, (*vectors, np.abs(tree.bounds).max(axis=0))))


def jump_at(body: Body, tree: ObbTree, time: float) -> float:
    """Bound how far any vertex is from the next pose where a piece ends at this time."""
    jump = body.motion.jump(time)
    if jump is None:
        return 0.0
    return _apart(tree, jump.end, jump.after) + rounding_of(tree, *jump.summands)


def _apart(tree: ObbTree, a: Pose, b: Pose) -> float:
    """Bound how far two poses put any vertex apart, but for rounding."""
    low, high = tree.bounds
    center = 0.5 * low + 0.5 * high
    turned = a.rotation - b.rotation
    middle = turned @ center + (a.translation - b.translation)
    return norm(middle) + math.hypot(*turned.ravel().tolist()) * norm(high - center)


def norm(vector: NDArray[np.float64]) -> float:
    """Return a vector's length."""
    return math.hypot(*vector.tolist())
