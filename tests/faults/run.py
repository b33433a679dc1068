"""Injects faults into the command line, prints a table, and exits with 1 where anything deviates.

`python tests/faults/run.py [--signals N] [--kills N] [--changes N] [--seed N] [--only TEXT]`
"""

from __future__ import annotations

import argparse
import itertools
import json
import re
import signal
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from faults.changes import changed
from faults.mounts import can_mount, mounted
from faults.scenarios import all_scenarios
from faults.signals import at_calls, at_events, at_times
from faults.world import contents, damage, fill, finish, start, told_in_one_line

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from faults.scenarios import Scenario
    from faults.signals import Outcome

_WIDTHS = (34, 50, 24, 24, 64, 5)
_HEAD = ("fault", "command", "exit code", "wanted", "standard error", "whole")


class Row(NamedTuple):
    """A line of the table; `wrong` is empty where all is as it should be."""

    fault: str
    command: str
    found: str
    wanted: str
    told: str
    wrong: str
    is_whole: bool
    count: int = 1


def run_scenario(scenario: Scenario) -> Row:
    """Run a command under a fault, and compare how it ends."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "world"
        folder.mkdir()
        fill(folder)
        if scenario.prepare is not None:
            scenario.prepare(folder)
        before = contents(folder)
        process = start(
            folder,
            scenario.words,
            shell=scenario.shell,
            limit=scenario.limit,
            environment=scenario.environment,
        )
        ended = finish(folder, process)
        left = damage(folder, before, written=scenario.written)
    wrong = [left] if left else []
    if ended.code != scenario.code:
        wrong.append(f"exit code {ended.code}")
    says = scenario.says or r"\A\Z"
    if not (told_in_one_line(ended) and re.search(says, ended.err)):
        wrong.append(f"standard error is {ended.err[-400:]!r}, wanted {scenario.says!r}")
    words = " ".join(scenario.words)
    code = str(scenario.code)
    return Row(scenario.fault, words, str(ended.code), code, ended.line, "; ".join(wrong), not left)


def run_signals(title: str, wanted: str, outcomes: Iterable[Outcome]) -> Iterator[Row]:
    """Count what signals did, a line for each command."""
    by_command: dict[str, list[Outcome]] = {}
    for outcome in outcomes:
        by_command.setdefault(" ".join(outcome.command.words), []).append(outcome)
        if outcome.fault:
            print(f"  {outcome.moment}: {outcome.fault}", file=sys.stderr, flush=True)
    for words, some in by_command.items():
        kinds = Counter(outcome.kind for outcome in some)
        found = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
        wrong = "; ".join(outcome.fault for outcome in some if outcome.fault)
        lines = Counter(outcome.ended.line for outcome in some if outcome.kind == "interrupted")
        told = lines.most_common(1)[0][0] if lines else ""
        whole = all(not outcome.damage for outcome in some)
        yield Row(title, words, found, wanted, told, wrong, whole, len(some))


def run_changes(count: int, seed: int) -> Iterator[Row]:
    """Change files in use; a line for each kind of change."""
    ended: dict[tuple[str, str], list[tuple[str, str, str]]] = {}
    for one in changed(count, seed):
        key = f"{one.words[1]} is {one.change} in use", " ".join(one.words)
        ended.setdefault(key, []).append((one.kind, one.ended.line, one.fault))
    for (fault, words), some in ended.items():
        kinds = Counter(kind for kind, _, _ in some)
        found = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
        told = next((line for _, line, _ in some if line), "")
        wrong = "; ".join(fault for _, _, fault in some if fault)
        yield Row(fault, words, found, "the truth, or 3", told, wrong, True, len(some))


def rows(options: argparse.Namespace) -> Iterator[Row]:
    """Yield the whole table."""
    scenarios = itertools.chain(all_scenarios(), mounted() if can_mount() else ())
    for scenario in scenarios:
        if options.only in scenario.fault or options.only in " ".join(scenario.words):
            yield run_scenario(scenario)
    seed, interrupted, dead = options.seed, "130, or as ever", "-9, or as ever"
    if options.only:
        return
    if not can_mount():
        print("full and read-only disks: left out, as this user may not mount", flush=True)
    yield from run_signals("signal before a step of writing", interrupted, at_events())
    half = options.signals // 2
    for sign, count in ((signal.SIGINT, half), (signal.SIGTERM, options.signals // 20)):
        title = f"{sign.name} at a random call"
        yield from run_signals(title, interrupted, at_calls(sign, count, seed))
        title = f"{sign.name} at a random time"
        yield from run_signals(title, interrupted, at_times(sign, count, seed))
    outcomes = at_times(signal.SIGKILL, options.kills, seed)
    yield from run_signals("kill -9 at a random time", dead, outcomes)
    yield from run_changes(options.changes, seed)


def _line(parts: Iterable[str]) -> str:
    """Return a line of the table, whatever stands in names."""
    cells = []
    for part, width in zip(parts, _WIDTHS, strict=True):
        text = json.dumps(part)[1:-1].replace('\\"', '"')
        cells.append((text if len(text) <= width else text[: width - 3] + "...").ljust(width))
    return "  ".join(cells).rstrip()


def main() -> int:
    """Print the table and how much of it is wrong; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--signals", type=int, default=1000, help="SIGINT, half of them by time")
    parser.add_argument("--kills", type=int, default=200, help="kill -9")
    parser.add_argument("--changes", type=int, default=60, help="files changed while in use")
    parser.add_argument("--seed", type=int, default=1, help="of all moments")
    parser.add_argument("--only", default="", help="faults or commands that hold this text")
    options = parser.parse_args()
    print(_line(_HEAD), flush=True)
    injected = wrong = 0
    for row in rows(options):
        state = "yes" if row.is_whole else "NO"
        print(_line((*row[:5], state)), flush=True)
        if row.wrong:
            print(f"  WRONG: {row.wrong}", flush=True)
        injected += row.count
        wrong += bool(row.wrong)
    print(f"{injected} faults injected; lines that deviate: {wrong}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
