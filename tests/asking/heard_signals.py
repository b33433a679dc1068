"""Signals of a clock that keeps ticking, counted where the kernels hear them.

Nobody knows where in a program a signal lands. So a test does not send one and hope that it lands
in a question: it lets the clock tick, asks again and again, and raises where a single call of the
kernels has heard several ticks. Ticks that land anywhere else count for nothing.
"""

from __future__ import annotations

import signal
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import obbcli

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

PACKAGE = str(Path(obbcli.__file__).parent)
_TICK = 0.002
# A call that hears nobody leaves all ticks that came meanwhile as one, handled at its end.
_TICKS = 3
_MOST_CALLS = 200


class HeardError(Exception):
    """A call of the kernels has heard several ticks of the clock."""


class _Ear:
    """Counts ticks that are heard one after another at one place of one run of a function."""

    def __init__(self) -> None:
        self._frame: FrameType | None = None
        self._place = self._count = 0

    def hear(self, _number: int, frame: FrameType | None) -> None:
        """Take a tick; raise where it is one of several.

        Raises:
            HeardError: it is.
        """
        if frame is None or not frame.f_code.co_filename.startswith(PACKAGE):
            return
        if (self._frame, self._place) != (frame, frame.f_lasti):
            self._frame, self._place, self._count = frame, frame.f_lasti, 0
        self._count += 1
        if self._count == _TICKS:
            self._frame = None
            raise HeardError


def ask_until_heard(ask: Callable[[], object]) -> NoReturn:
    """Ask until a call of the kernels hears several ticks of a clock.

    Args:
        ask: a question that takes some milliseconds at least.

    Raises:
        HeardError: a call has.
        AssertionError: none has.
    """
    before = signal.signal(signal.SIGALRM, _Ear().hear)
    try:
        signal.setitimer(signal.ITIMER_REAL, _TICK, _TICK)
        for _ in range(_MOST_CALLS):
            ask()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    raise AssertionError("no call of the kernels has heard the clock")
