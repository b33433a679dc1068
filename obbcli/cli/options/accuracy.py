"""The options of accuracy: every field of `Accuracy`, for all commands that ask questions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, get_args

import click

from obbcli.accuracy import Accuracy, Integrator, Leaves, Method
from obbcli.cli.boundary import UsageError, usage_errors
from obbcli.cli.options.option import gathered, option
from obbcli.cli.options.words import Finite, Whole

if TYPE_CHECKING:
    from obbcli.cli.options.option import Decorator


class AccuracyOptions(NamedTuple):
    """Every field of `Accuracy`, None where it was not given, and `--max-depth` for both trees."""

    time_tolerance: float | None
    distance_tolerance: float | None
    max_depth: int | None
    max_depth_a: int | None
    max_depth_b: int | None
    leaves: Leaves | None
    method: Method | None
    integrator: Integrator | None
    steps: int | None
    clearance: float | None
    max_iterations: int | None
    timeout: float | None

    def given(self) -> dict[str, Any]:
        """Return the fields of `Accuracy` that were given, by name."""
        values = self._asdict()
        both = values.pop("max_depth")
        for name in ("max_depth_a", "max_depth_b"):
            if values[name] is None:
                values[name] = both
        return {name: value for name, value in values.items() if value is not None}

    def accuracy(self) -> Accuracy:
        """Return the accuracy asked for.

        Raises:
            UsageError: an option that has no meaning with the method.
        """
        given = self.given()
        for name in ("integrator", "steps"):
            if name in given and self.method != "sampled":
                raise UsageError(f"--{name}", "has a meaning with --method sampled alone")
        with usage_errors():
            return Accuracy(**given)


def _accuracy(name: str, **attributes: Any) -> Decorator:
    return option("Accuracy", name, **attributes)


_COUNT = Whole(1)
_DEPTH = Whole(0)
accuracy_options = gathered(
    "accuracy",
    AccuracyOptions,
    (
        _accuracy(
            "--time-tolerance",
            type=Finite(0),
            metavar="S",
            help="Bracket a first contact this closely, in s [default: 1e-9 of the duration].",
        ),
        _accuracy(
            "--distance-tolerance",
            type=Finite(0),
            metavar="D",
            help="Stop at points this close, in mesh units [default: go on until proven].",
        ),
        _accuracy(
            "--max-depth",
            type=_DEPTH,
            metavar="N",
            help="Use trees down to level N only, 0 the root boxes [default: to the triangles].",
        ),
        _accuracy(
            "--max-depth-a",
            type=_DEPTH,
            metavar="N",
            help="The same for A alone [default: as --max-depth].",
        ),
        _accuracy(
            "--max-depth-b",
            type=_DEPTH,
            metavar="N",
            help="The same for B alone [default: as --max-depth].",
        ),
        _accuracy(
            "--leaves",
            type=click.Choice(get_args(Leaves)),
            help=f"What a leaf of several triangles stands for [default: {Accuracy.leaves}].",
        ),
        _accuracy(
            "--method",
            type=click.Choice(get_args(Method)),
            help=f"Prove the answer, or sample it [default: {Accuracy.method}].",
        ),
        _accuracy(
            "--integrator",
            type=click.Choice(get_args(Integrator)),
            help=f"How sampling turns a frame [default: {Accuracy.integrator}].",
        ),
        _accuracy(
            "--steps",
            type=_COUNT,
            metavar="N",
            help=f"Sample in N equal steps of time [default: {Accuracy.steps}].",
        ),
        _accuracy(
            "--clearance",
            type=Finite(0),
            metavar="D",
            help="Surfaces this close count as contact, in mesh units [default: 0].",
        ),
        _accuracy(
            "--max-iterations",
            type=_COUNT,
            metavar="N",
            help="Give up, unresolved, after N pops of the queue "
            f"[default: {Accuracy.max_iterations:,}].",
        ),
        _accuracy(
            "--timeout",
            type=Finite(0),
            metavar="S",
            help="Give up, unresolved, after S seconds of work [default: never].",
        ),
    ),
)
