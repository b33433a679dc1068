"""Numbers of scene files: finite, in range, or one clear error."""

from __future__ import annotations

from typing import Any

from obbcli.errors import SceneError


def finite_number(value: Any, where: str, least: float | None = None) -> float:
    """Return a finite number; JSON and TOML know others.

    Raises:
        SceneError: it is none, or below `least`.
    """
    wanted = "use a finite number" + ("" if least is None else f" of at least {least}")
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise SceneError(where, f"is {shown(value)}", wanted)
    try:
        number = float(value)
    except OverflowError as fault:
        raise SceneError(where, "is beyond the largest double", wanted) from fault
    if not abs(number) < float("inf") or (least is not None and number < least):
        raise SceneError(where, f"is {number}", wanted)
    return number


def above_zero(value: Any, where: str) -> float:
    """Return a finite number above 0.

    Raises:
        SceneError: it is none.
    """
    number = finite_number(value, where, least=0)
    if number == 0:
        raise SceneError(where, "is 0", "use a number above 0")
    return number


def shown(value: Any) -> str:
    """Return a value for an error, cut where it is long."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
