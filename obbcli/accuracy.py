"""`Accuracy`: the one place where a question's speed is traded for its accuracy.

Options of the command line, schemas and checks all follow its fields, each of which says what it is
by its `Aspect`. Light on purpose: the command line reads it before anything heavy is imported.
"""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass, field, fields
from typing import Any, Literal, NamedTuple, get_args

from obbcli.errors import MotionError

Leaves = Literal["triangles", "boxes"]
Method = Literal["certified", "sampled"]
Integrator = Literal["exact", "euler", "rk4"]

DEFAULT_DURATION = 1.0
"""s; of a question where a body moves and goes on."""
TIME_TOLERANCE = 1e-9
"""Of the duration: the width asked of a bracket where the caller asks for none."""

DEPTH_TOLERANCE = 1e-2
"""The relative width asked of a depth's bracket where the caller asks for none."""

CLEARANCE_TOLERANCE = 1e-6
"""The relative width asked of a least clearance's bracket where the caller asks for none."""


class Aspect(NamedTuple):
    """What a field of `Accuracy` is, beside its name and default.

    Attributes:
        kind: float, int or str.
        help: what its option does, as the command line tells it.
        metavar: what help calls a number.
        unset: what None means, as help tells it; empty where it may not be None.
        least: the number it must not be below.
        words: those it is one of.
        concerns: the questions that it makes a difference to: `"all"`, those about a `"motion"`,
            or those asked by the `"sampled"` method alone.
        is_shared: whether it says what is asked or for how long, and not how: `tradeoff` varies
            the other fields.
    """

    kind: type
    help: str
    metavar: str | None = None
    unset: str = ""
    least: int = 0
    words: tuple[str, ...] = ()
    concerns: Literal["all", "motion", "sampled"] = "all"
    is_shared: bool = False

    def checked(self, name: str, value: object) -> object:
        """Return a value as plain Python has it; NumPy scalars are welcome.

        Raises:
            MotionError: it is of the wrong type or out of range.
        """
        if value is None and self.unset:
            return None
        if self.kind is float:
            return _number(name, value)
        if self.kind is int:
            return _whole(name, value, self.least)
        if value not in self.words:
            raise MotionError(name, f"is {value!r}", "use one of " + ", ".join(self.words))
        return value


def _aspect(kind: type, text: str, **more: Any) -> dict[str, Aspect]:
    return {"aspect": Aspect(kind, text, **more)}


_DEPTH = _aspect(
    int,
    "Use trees down to level N only, 0 the root boxes",
    metavar="N",
    unset="to the triangles",
)


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """How far a question is pursued.

    The defaults ask for the best answer that double precision supports. Every limit below keeps
    certified answers honest: `separated` stays a proof, and what is lost is said by `approximate`
    and `error_bound` of the result, or by the status `unresolved`.

    Attributes:
        time_tolerance: s; the width asked of the bracket around a first contact. None: 1e-9 of the
            duration.
        distance_tolerance: mesh units; a search may stop at points this close. None: go on until
            the answer is proven or rounding forbids more.
        max_depth_a: the deepest level of A's tree that is used, 0 being its root box. None: down to
            the triangles.
        max_depth_b: the same for B.
        leaves: `"triangles"`, or `"boxes"`: a leaf of several triangles stands for its box (the
            coarse leaves of Eberly 2008 §6).
        method: `"certified"`, or `"sampled"`: the stepping of Eberly 2008 §5, in which bodies keep
            their orientation during a step and jump to the next. It proves nothing but by how much
            its paths are off (`error_bound`); what touches only between may be missed.
        integrator: how `"sampled"` turns a frame from step to step: `"exact"`, in closed form;
            `"euler"` or `"rk4"`, by the differential equation, orthonormalized after each step.
        steps: how many equal steps `"sampled"` divides the duration into.
        clearance: mesh units; surfaces this close or closer count as contact.
        max_iterations: queue pops before the answer is `unresolved`.
        timeout: s of wall time before the answer is `unresolved`. None: no limit.

    Raises:
        MotionError: a value is of the wrong type or out of range; `where` is the field's name.

    Example:
        >>> coarse = Accuracy(time_tolerance=1e-3, max_depth_a=4)
        >>> coarse.max_depth_a, coarse.max_depth_b, coarse.max_iterations
        (4, None, 10000000)
    """

    time_tolerance: float | None = field(
        default=None,
        metadata=_aspect(
            float,
            "Bracket a first contact this closely, in s",
            metavar="S",
            unset="1e-9 of the duration",
            concerns="motion",
        ),
    )
    distance_tolerance: float | None = field(
        default=None,
        metadata=_aspect(
            float,
            "Stop at points this close, in mesh units",
            metavar="D",
            unset="go on until proven",
        ),
    )
    max_depth_a: int | None = field(default=None, metadata=_DEPTH)
    max_depth_b: int | None = field(default=None, metadata=_DEPTH)
    leaves: Leaves = field(
        default="triangles",
        metadata=_aspect(
            str, "What a leaf of several triangles stands for", words=get_args(Leaves)
        ),
    )
    method: Method = field(
        default="certified",
        metadata=_aspect(
            str, "Prove the answer, or sample it", words=get_args(Method), concerns="motion"
        ),
    )
    integrator: Integrator = field(
        default="exact",
        metadata=_aspect(
            str, "How sampling turns a frame", words=get_args(Integrator), concerns="sampled"
        ),
    )
    steps: int = field(
        default=100,
        metadata=_aspect(
            int, "Sample in N equal steps of time", metavar="N", least=1, concerns="sampled"
        ),
    )
    clearance: float = field(
        default=0.0,
        metadata=_aspect(
            float,
            "Surfaces this close count as contact, in mesh units",
            metavar="D",
            concerns="motion",
            is_shared=True,
        ),
    )
    max_iterations: int = field(
        default=10_000_000,
        metadata=_aspect(
            int,
            "Give up, unresolved, after N pops of the queue",
            metavar="N",
            least=1,
            is_shared=True,
        ),
    )
    timeout: float | None = field(
        default=None,
        metadata=_aspect(
            float,
            "Give up, unresolved, after S seconds of work",
            metavar="S",
            unset="never",
            is_shared=True,
        ),
    )

    def __post_init__(self) -> None:
        for name, aspect in ASPECTS.items():
            object.__setattr__(self, name, aspect.checked(name, getattr(self, name)))

    def as_dict(self) -> dict[str, float | int | str | None]:
        """Return every field by name, in the order of the class."""
        return {name: getattr(self, name) for name in ASPECTS}


ASPECTS: dict[str, Aspect] = {one.name: one.metadata["aspect"] for one in fields(Accuracy)}
"""Of every field, in the order of the class."""


def _number(name: str, value: object) -> float:
    """Return a finite float of at least 0."""
    try:
        number = float(value)  # type: ignore[arg-type]  # whatever is no number raises here
    except (TypeError, ValueError, OverflowError) as fault:
        raise MotionError(name, f"is {value!r}, expected a number") from fault
    if isinstance(value, str) or not (math.isfinite(number) and number >= 0):
        raise MotionError(name, f"is {value!r}, expected a finite number of at least 0")
    return number


def _whole(name: str, value: object, least: int) -> int:
    """Return an int of at least `least`."""
    try:
        number = operator.index(value)  # type: ignore[arg-type]  # whatever is no integer raises here
    except TypeError as fault:
        raise MotionError(name, f"is {value!r}, expected a whole number") from fault
    if isinstance(value, bool) or number < least:
        raise MotionError(name, f"is {value!r}, expected a whole number of at least {least}")
    return number
