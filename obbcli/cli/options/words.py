"""What a word of the command line must be: a number, a whole number, a path."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

_UNITS = {"": 1, "K": 1 << 10, "M": 1 << 20, "G": 1 << 30, "T": 1 << 40}


def byte_count(context: click.Context, param: click.Parameter, text: str | None) -> int | None:
    """Return a number of bytes from digits and an optional K, M, G or T (powers of 1024)."""
    if text is None:
        return None
    unit = text[-1:].upper() if text[-1:].isalpha() else ""
    digits = text[: len(text) - len(unit)]
    if unit not in _UNITS or not (digits.isascii() and digits.isdigit()):
        fault = f"{text!r} is no number of bytes, such as 500M or 2G"
        raise click.BadParameter(fault, ctx=context, param=param)
    return int(digits) * _UNITS[unit]


def spelt_out(word: str) -> list[str]:
    """Return the words that one word of several stands for: `1,0,0` or `"1 0 0"`.

    Commas part numbers, or spaces do. A word of both, such as `"1,5 0 0"`, is parted at its commas
    alone, so that the comma of a decimal fraction never makes two numbers.

    Args:
        word: as it was typed; what holds no comma and no space is one word already.
    """
    return [part.strip() for part in word.split(",")] if "," in word else word.split()


class Finite(click.types.FloatParamType):
    """A finite number, at least `minimum` where one is given."""

    def __init__(self, minimum: float = -math.inf) -> None:
        self.minimum = minimum

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Return the number, or fail with what was found."""
        # Python's own grouping of digits: elsewhere a slip of the finger.
        if isinstance(value, str) and "_" in value:
            self.fail(f"{value!r} is not a number", param, ctx)
        number = float(super().convert(value, param, ctx))
        if not (math.isfinite(number) and number >= self.minimum):
            least = f" of at least {self.minimum:g}" if math.isfinite(self.minimum) else ""
            self.fail(f"{value!r} is not a finite number{least}", param, ctx)
        return number


class Whole(click.types.IntParamType):
    """A whole number of at least `minimum`, in plain digits."""

    def __init__(self, minimum: int = 0) -> None:
        self.minimum = minimum

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:
        """Return the number, or fail with what was found."""
        text = str(value).strip()
        # int() refuses what no machine word could count, such as ten thousand digits.
        is_plain = text.isascii() and text.removeprefix("+").isdigit() and len(text) < 1000
        if not is_plain or int(text) < self.minimum:
            self.fail(f"{value!r} is not a whole number of at least {self.minimum}", param, ctx)
        return int(text)


class PathName(click.types.StringParamType):
    """A path as it was written, `-` included; the shell completes files and folders."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Return the path; an empty word, as an unset variable leaves it, names nothing."""
        if value == "":
            self.fail("an empty word names no file", param, ctx)
        return str(value)

    def shell_complete(
        self,
        ctx: click.Context,  # noqa: ARG002  # click's signature
        param: click.Parameter,  # noqa: ARG002
        incomplete: str,
    ) -> list[CompletionItem]:
        """Leave the work to the shell, which knows its files."""
        from click.shell_completion import CompletionItem

        return [CompletionItem(incomplete, type="file")]
