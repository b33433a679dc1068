"""What is asked about an overlap, checked: `Asked`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

from obbcli.accuracy import DEPTH_TOLERANCE
from obbcli.errors import MotionError
from obbcli.questions.checked import number_of, refuse_unused
from obbcli.questions.overlap.along import unit_direction
from obbcli.questions.overlap.band import checked_touch

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from obbcli.accuracy import Accuracy
    from obbcli.answers.contact import Vector

CONCERNS = frozenset({"clearance", "max_iterations", "timeout"})
"""The fields of `Accuracy` that say something about an overlap."""


class Asked(NamedTuple):
    """What is asked about an overlap, beside the bodies.

    Attributes:
        tolerance: the relative width asked of brackets.
        deeper_than: mesh units; whether a depth exceeds it is asked, and then no value.
        touch: gap and overlap that count as touching, mesh units. None: the default.
        direction: unit; the way on which A is to leave B. None: not asked.
        values: whether depths are to be narrowed down to the tolerance: `"all"`; `"deep"`, those
            of bodies that do more than touch; `"none"`, as far as the answer needs it.
        resolution: mesh units; the regions are asked for, told apart at this. 0: at a fiftieth of
            the diagonal of the box that both bodies have in common. None: not asked.
        has_volume: whether the shared volume is asked for where depths are narrowed down.
    """

    tolerance: float = DEPTH_TOLERANCE
    deeper_than: float | None = None
    touch: tuple[float, float] | None = None
    direction: Vector | None = None
    values: Literal["all", "deep", "none"] = "all"
    has_volume: bool = True
    resolution: float | None = None

    @classmethod
    def of(
        cls,
        tolerance: float = DEPTH_TOLERANCE,
        deeper_than: float | None = None,
        touch: Sequence[float] | None = None,
        along: ArrayLike | None = None,
        regions: float | bool | None = None,
    ) -> Asked:
        """Return what is asked, as `overlap` takes it.

        Raises:
            MotionError: an argument is no number that it may be; `where` is its name.
        """
        width = number_of("tolerance", tolerance)
        if width == 0:
            fault = "is 0, which no bracket reaches"
            raise MotionError("tolerance", fault, "use a number above 0, such as 0.01")
        limit = None if deeper_than is None else number_of("deeper_than", deeper_than)
        band = None if touch is None else checked_touch(touch)
        direction = None if along is None else unit_direction(along)
        values: Literal["all", "none"] = "all" if limit is None else "none"
        resolution = _resolution(regions)
        return cls(width, limit, band, direction, values, resolution=resolution)


def refuse_other_accuracy(accuracy: Accuracy) -> None:
    """Refuse fields of `Accuracy` that say nothing about an overlap: they are never ignored.

    Raises:
        MotionError: one of them has another value than its default.
    """
    refuse_unused(accuracy, CONCERNS, lambda _: ("says nothing about an overlap", "leave it out"))


def _resolution(regions: float | bool | None) -> float | None:
    """Return the resolution of regions as `Asked` has it."""
    if regions is None or regions is False:
        return None
    if regions is True:
        return 0.0
    resolution = number_of("regions", regions)
    if resolution == 0:
        remedy = "use a number above 0, or True for one that suits the bodies"
        raise MotionError("regions", "is a resolution of 0", remedy)
    return resolution
