"""What is asked about a clearance, checked: `Asked`."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from obbcli.accuracy import CLEARANCE_TOLERANCE
from obbcli.errors import MotionError
from obbcli.questions.border import whole_limit
from obbcli.questions.checked import number_of, refuse_unused

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy

CONCERNS = frozenset({"max_iterations", "timeout"})
"""The fields of `Accuracy` that say something about a least clearance."""
MOST_INTERVALS = 1_000_000
"""Intervals that a curve may have: each is a search, and a row of the answer."""


class Asked(NamedTuple):
    """What is asked about the distance of two moving bodies.

    Attributes:
        tolerance: the relative width asked of the bracket.
        at_least: mesh units; only whether the bodies keep this distance is asked.
        solid: whether closed surfaces hold what is inside them.
        greatest: whether the greatest distance is asked for, too.
        intervals: in how many equal intervals the least distance is asked for, too; 0: none.
    """

    tolerance: float = CLEARANCE_TOLERANCE
    at_least: float | None = None
    solid: bool = False
    greatest: bool = False
    intervals: int = 0

    @classmethod
    def of(
        cls,
        tolerance: float = CLEARANCE_TOLERANCE,
        at_least: float | None = None,
        solid: bool = False,
        greatest: bool = False,
        intervals: int | None = None,
    ) -> Asked:
        """Return what is asked, as `clearance` takes it.

        Raises:
            MotionError: an argument is no number that it may be; `where` is its name.
        """
        width = number_of("tolerance", tolerance)
        if not 0 < width < 1:
            raise MotionError("tolerance", f"is {tolerance!r}", "use a number between 0 and 1")
        limit = None if at_least is None else number_of("at_least", at_least)
        if greatest and solid:
            fault = "is that of surfaces, and solid asks about what they hold"
            raise MotionError("greatest", fault, "leave one of the two out")
        count = 0 if intervals is None else whole_limit(intervals, "intervals")
        if count > MOST_INTERVALS:
            fault = f"is {count:,}, more than {MOST_INTERVALS:,}"
            raise MotionError("intervals", fault, "ask for fewer intervals")
        if count and solid:
            fault = "are those of surfaces, and solid asks about what they hold"
            raise MotionError("intervals", fault, "leave one of the two out")
        return cls(width, limit, bool(solid), bool(greatest), count)


def refuse_other_accuracy(accuracy: Accuracy) -> None:
    """Refuse fields of `Accuracy` that say nothing about a least clearance: none is ignored.

    Raises:
        MotionError: one of them has another value than its default.
    """
    refuse_unused(accuracy, CONCERNS, why_refused)


def why_refused(name: str) -> tuple[str, str]:
    """Return why a field of `Accuracy` is refused, and the remedy."""
    if name == "clearance":
        return "would mean two things here", "use at_least, or first_contact with it"
    return "says nothing about a least clearance", "leave it out"
