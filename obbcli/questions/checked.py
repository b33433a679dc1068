"""Arguments of questions, checked: numbers that are lengths, accuracies that are used whole."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import TYPE_CHECKING

from obbcli.errors import MotionError

if TYPE_CHECKING:
    from collections.abc import Callable

    from obbcli.accuracy import Accuracy


def number_of(name: str, value: object) -> float:
    """Return a finite float of at least 0.

    Raises:
        MotionError: the value is none; `where` is the name of the argument.
    """
    try:
        number = float(value)  # type: ignore[arg-type]  # whatever is no number raises here
    except (TypeError, ValueError, OverflowError) as fault:
        raise MotionError(name, f"is {value!r}", "use a finite number of at least 0") from fault
    if isinstance(value, (str, bool)) or not 0 <= number < math.inf:
        raise MotionError(name, f"is {value!r}", "use a finite number of at least 0")
    return number


def refuse_unused(
    accuracy: Accuracy, concerns: frozenset[str], why: Callable[[str], tuple[str, str]]
) -> None:
    """Refuse fields of an accuracy that say nothing about a question: none is ignored.

    Args:
        accuracy: as it was given.
        concerns: the fields that the question uses.
        why: tells of a field why it is refused, and the remedy.

    Raises:
        MotionError: another field has another value than its default.
    """
    for field in fields(accuracy):
        if field.name not in concerns and getattr(accuracy, field.name) != field.default:
            raise MotionError(field.name, *why(field.name))
