"""The options of accuracy: every field of `Accuracy`, for all commands that ask questions."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click

from obbcli.accuracy import ASPECTS, Accuracy
from obbcli.cli.boundary import UsageError, usage_errors
from obbcli.cli.options.option import gathered, option
from obbcli.cli.options.words import Finite, Whole

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.accuracy import Aspect
    from obbcli.cli.options.option import Decorator

_SIDES = ("_a", "_b")


def _both(name: str) -> str:
    """Return the option that stands for fields of A and of B: `max_depth` for `max_depth_a`."""
    return name.removesuffix("_a").removesuffix("_b")


class AccuracyOptions:
    """What was given of the fields of `Accuracy`, and of the options that stand for A's and B's."""

    _fields = tuple(dict.fromkeys(name for own in ASPECTS for name in (_both(own), own)))

    def __init__(self, **values: Any) -> None:
        self._values = values

    def _asdict(self) -> dict[str, Any]:
        """Return every option by name, as a named tuple does; None where it was not given."""
        return self._values

    def given(self) -> dict[str, Any]:
        """Return the fields of `Accuracy` that were given, by name."""
        values = {}
        for name in ASPECTS:
            value = self._values[name]
            values[name] = self._values[_both(name)] if value is None else value
        return {name: value for name, value in values.items() if value is not None}

    def accuracy(self, base: Accuracy | None = None) -> Accuracy:
        """Return the accuracy asked for.

        Args:
            base: what stands for options that were not given; None: the defaults.

        Raises:
            UsageError: an option that has no meaning with the method.
        """
        given = self.given()
        with usage_errors():
            asked = Accuracy(**given) if base is None else replace(base, **given)
        for name in given:
            if ASPECTS[name].concerns == "sampled" and asked.method != "sampled":
                raise UsageError(f"--{name}", "has a meaning with --method sampled alone")
        return asked


def _options() -> Iterator[Decorator]:
    """Yield the options; where there is a field for A and one for B, one for both comes first."""
    for name, aspect in ASPECTS.items():
        text = f"{aspect.help} [default: {aspect.unset or _told(getattr(Accuracy, name))}]."
        if name.endswith(_SIDES):
            both = _flag(_both(name))
            if name.endswith(_SIDES[0]):
                yield _option(both, aspect, text)
            text = f"The same for {name[-1].upper()} alone [default: as {both}]."
        yield _option(_flag(name), aspect, text)


def _option(flag: str, aspect: Aspect, text: str) -> Decorator:
    kind: click.ParamType[Any] = click.Choice(aspect.words)
    if aspect.kind is float:
        kind = Finite(aspect.least)
    elif aspect.kind is int:
        kind = Whole(aspect.least)
    return option("Accuracy", flag, type=kind, metavar=aspect.metavar, help=text)


def _flag(name: str) -> str:
    return "--" + name.replace("_", "-")


def _told(default: float | str) -> str:
    """Return a default as help tells it."""
    if isinstance(default, str):
        return default
    return f"{default:,}" if isinstance(default, int) else f"{default:g}"


accuracy_options = gathered("accuracy", AccuracyOptions, tuple(_options()))
