"""Runs the command line as its installed script does, with a signal at a chosen event.

`launch.py EVENTS FAULT WORDS...`: FAULT is empty, `NAME@N` for a signal at the N-th call of a
function, Python's or C's, or `NAME@EVENT` for one at the first audit event of that name about a
file that is not yet whole. EVENTS is a file: there stands that the command line has begun, and at
its end how many calls it made.
"""

from __future__ import annotations

import signal
import sys
from pathlib import Path

TEMPORARY = ".obbtree-"


def at_call(number: int, sign: signal.Signals, calls: list[int]) -> None:
    """Count calls; send the signal at one of them."""

    def count(_frame: object, event: str, _argument: object) -> None:
        if event in ("call", "c_call"):
            calls[0] += 1
            if calls[0] == number:
                signal.raise_signal(sign)

    sys.setprofile(count)


def at_event(name: str, sign: signal.Signals) -> None:
    """Send the signal before the first event of a name that is about a temporary file."""
    sent = []

    def hear(event: str, arguments: tuple[object, ...]) -> None:
        if event == name and TEMPORARY in str(arguments[0]) and not sent:
            sent.append(event)
            signal.raise_signal(sign)

    sys.addaudithook(hear)


def launch(events: Path, fault: str) -> int:
    """Run the command line, and note what is told of it."""
    calls = [0]
    sign, _, moment = fault.partition("@")
    if moment and not moment.isdigit():
        at_event(moment, signal.Signals[sign])
    from obbcli.cli import run_process

    with events.open("ab", buffering=0) as told:
        told.write(b"begun\n")
        if moment.isdigit():
            at_call(int(moment), signal.Signals[sign], calls)
        code = run_process()
        sys.setprofile(None)
        told.write(b"%d\n" % calls[0])
    return code


if __name__ == "__main__":
    place, what = Path(sys.argv[1]), sys.argv[2]
    del sys.argv[1:3]
    sys.exit(launch(place, what))
