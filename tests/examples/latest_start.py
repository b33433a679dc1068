"""How late may the finger start to close, and still meet the workpiece before a deadline?

A whole program against the package: it loads two meshes, asks for a certified first contact, says
what is proven, and ends with an exit code. `python tests/examples/latest_start.py --help`.
"""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from obbcli import Accuracy, Body, Motion, ObbError, ObbTree, Status, first_contact

if TYPE_CHECKING:
    from collections.abc import Sequence

    from obbcli import FirstContact


def closing_time(finger: ObbTree, workpiece: ObbTree, speed: float, gap: float) -> FirstContact:
    """Return when a finger that closes along -y comes within a gap of the workpiece.

    Args:
        finger: its tree.
        workpiece: its tree; at rest.
        speed: mesh units a second.
        gap: mesh units; closer than this counts as contact.
    """
    closing = Body(finger, motion=Motion(linear_velocity=[0.0, -speed, 0.0]))
    return first_contact(closing, workpiece, accuracy=Accuracy(clearance=gap))


def report(found: FirstContact, deadline: float) -> tuple[str, int]:
    """Return what is proven about a deadline, s, and the exit code for it."""
    if found.status is Status.SEPARATED:
        return "the finger never meets the workpiece: proven", 1
    if found.status is Status.UNRESOLVED or found.time_bounds is None:
        return f"a limit was reached; no contact before t = {found.time!r} s: proven", 2
    low, high = found.time_bounds
    if high is None or high > deadline:
        return f"the finger is late: no contact before t = {low!r} s", 1
    late = deadline - high
    return f"the finger may start {late:.6g} s later: contact by t = {high!r} s", 0


def main(words: Sequence[str] | None = None) -> int:
    """Answer the question of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("finger")
    parser.add_argument("workpiece")
    parser.add_argument("--speed", type=float, default=10.0, help="mesh units a second")
    parser.add_argument("--gap", type=float, default=0.0, help="mesh units")
    parser.add_argument("--deadline", type=float, default=1.0, help="s")
    options = parser.parse_args(words)
    try:
        trees = ObbTree.build(options.finger), ObbTree.build(options.workpiece)
        found = closing_time(*trees, options.speed, options.gap)
    except ObbError as fault:
        print(fault, file=sys.stderr)
        return 2
    text, code = report(found, options.deadline)
    print(text)
    return code


if __name__ == "__main__":
    sys.exit(main())
