"""How far A has to go in a direction to be free of B for good: the first contact of the way back.

A starts beyond B, as far as both reach along the direction, and comes back. Where it first touches
B on that way is where it last does on its way out.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from obbcli.accuracy import Accuracy
from obbcli.answers.overlap import SeparationAlong
from obbcli.answers.status import Status
from obbcli.arrays import as_vector
from obbcli.errors import MotionError
from obbcli.motion.body import Body
from obbcli.motion.motion import Motion
from obbcli.motion.pose import Pose
from obbcli.questions.pair_question import PairQuestion
from obbcli.questions.query import Query

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from obbcli.answers.contact import Vector
    from obbcli.questions.overlap.pursuit import Pursuit

# Of the largest coordinate on the way. A posed coordinate is rounded up to six times, at A's own
# place and at the start of the way back, the start itself once, none by more than 2^-53 of four
# times the largest number: 2^-47.3 at most, in each of three coordinates.
_ROUNDING = 2.0**-46


def unit_direction(along: ArrayLike) -> Vector:
    """Return a direction as a unit vector.

    Raises:
        MotionError: not three finite numbers, or all are zero.
    """
    given = as_vector(along, "along", MotionError)
    # Scaled by a power of two first: neither squares nor their sum leave the doubles.
    exponent = math.frexp(float(np.abs(given).max()))[1]
    x, y, z = (math.ldexp(value, -exponent) for value in given.tolist())
    length = math.hypot(x, y, z)
    if length == 0:
        raise MotionError("along", "has no length", "name a direction, such as 0 0 1")
    return x / length + 0.0, y / length + 0.0, z / length + 0.0


def separation_along(pair: PairQuestion, direction: Vector, pursuit: Pursuit) -> SeparationAlong:
    """Return how far A has to go in a unit direction to be free of B for good.

    Args:
        pair: A and B at rest.
        direction: unit, world coordinates.
        pursuit: the budget.

    Raises:
        MotionError: positions leave the range of double.
        TreeFileError: a tree file is damaged.
    """
    (a, b), (tree_a, tree_b) = pair.bodies, pair.trees
    unit = np.array(direction)
    here, there = (
        body.pose.apply(tree.mesh.vertices[np.unique(tree.mesh.triangles)])
        for body, tree in ((a, tree_a), (b, tree_b))
    )
    reach = float((there @ unit).max() - (here @ unit).min())
    largest = max(float(np.abs(here).max()), float(np.abs(there).max()), abs(reach))
    error = _ROUNDING * (2.0 * largest + float(np.abs(a.pose.translation).max()))
    if reach + error < 0:
        return SeparationAlong(direction=direction, bounds=(0.0, 0.0), error_bound=error)
    # Beyond all roundings of the two extents, and no further.
    way = max(reach, 0.0) + error
    found = _way_back(pair, unit, way, pursuit)
    if found is None:
        bounds: tuple[float, float | None] = 0.0, None
    else:
        low, high = found
        bounds = max(way - high, 0.0), max(way - low, 0.0)
    return SeparationAlong(direction=direction, bounds=bounds, error_bound=error)


def _way_back(
    pair: PairQuestion, unit: NDArray[np.float64], way: float, pursuit: Pursuit
) -> tuple[float, float] | None:
    """Return between which ways A first touches B as it comes back; None at a limit.

    Both are `way` where it does not.
    """
    (a, b), trees = pair.bodies, pair.trees
    start = Pose(a.pose.rotation, a.pose.translation + way * unit)
    moving = Body(trees[0], start, Motion(-unit))
    question = PairQuestion((moving, Body(trees[1], b.pose)), trees, way, Accuracy())
    query = Query.about(question)
    answer = query.advance(pursuit.steps_left, pursuit.seconds_left)
    pursuit.spend(query.counts)
    if answer.status is Status.SEPARATED:
        return way, way
    if answer.time_bounds is None or answer.time_bounds[1] is None:
        pursuit.is_complete = False
        return None
    low, high = answer.time_bounds
    return low, way if high is None else high
