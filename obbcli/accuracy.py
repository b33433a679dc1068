"""`Accuracy`: the one place where a question's speed is traded for its accuracy.

Light on purpose: the command line reads the defaults from here before anything heavy is imported.
"""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass, fields
from typing import Any, Literal, get_args

from obbcli.errors import MotionError

Leaves = Literal["triangles", "boxes"]
Method = Literal["certified", "sampled"]
Integrator = Literal["exact", "euler", "rk4"]


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

    time_tolerance: float | None = None
    distance_tolerance: float | None = None
    max_depth_a: int | None = None
    max_depth_b: int | None = None
    leaves: Leaves = "triangles"
    method: Method = "certified"
    integrator: Integrator = "exact"
    steps: int = 100
    clearance: float = 0.0
    max_iterations: int = 10_000_000
    timeout: float | None = None

    def __post_init__(self) -> None:
        self._convert("time_tolerance", _number, optional=True)
        self._convert("distance_tolerance", _number, optional=True)
        self._convert("clearance", _number)
        self._convert("timeout", _number, optional=True)
        self._convert("max_depth_a", _whole, optional=True)
        self._convert("max_depth_b", _whole, optional=True)
        self._convert("steps", _positive)
        self._convert("max_iterations", _positive)
        _one_of("leaves", self.leaves, get_args(Leaves))
        _one_of("method", self.method, get_args(Method))
        _one_of("integrator", self.integrator, get_args(Integrator))

    def _convert(self, name: str, convert: Any, *, optional: bool = False) -> None:
        """Replace a field by its plain Python value (NumPy scalars are welcome, NaN is not)."""
        value = getattr(self, name)
        if not (optional and value is None):
            object.__setattr__(self, name, convert(name, value))

    def as_dict(self) -> dict[str, float | int | str | None]:
        """Return every field by name, in the order of the class."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


def _number(name: str, value: object) -> float:
    """Return a finite float of at least 0."""
    try:
        number = float(value)  # type: ignore[arg-type]  # whatever is no number raises here
    except (TypeError, ValueError, OverflowError) as fault:
        raise MotionError(name, f"is {value!r}, expected a number") from fault
    if isinstance(value, str) or not (math.isfinite(number) and number >= 0):
        raise MotionError(name, f"is {value!r}, expected a finite number of at least 0")
    return number


def _whole(name: str, value: object, least: int = 0) -> int:
    """Return an int of at least `least`."""
    try:
        number = operator.index(value)  # type: ignore[arg-type]  # whatever is no integer raises here
    except TypeError as fault:
        raise MotionError(name, f"is {value!r}, expected a whole number") from fault
    if isinstance(value, bool) or number < least:
        raise MotionError(name, f"is {value!r}, expected a whole number of at least {least}")
    return number


def _positive(name: str, value: object) -> int:
    """Return an int of at least 1."""
    return _whole(name, value, least=1)


def _one_of(name: str, value: object, choices: tuple[str, ...]) -> None:
    """Refuse a word that is none of the choices."""
    if value not in choices:
        raise MotionError(name, f"is {value!r}", "use one of " + ", ".join(choices))
