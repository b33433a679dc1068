"""Signals at moments drawn by a seed: in calls made, which repeats, or in seconds, which does not.

A moment before the command line begins belongs to Python, which then ends as it likes: nothing of
ours runs there. From then on a command ends with 130 and one line, or with what it would have said.
"""

from __future__ import annotations

import random
import signal
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from faults.world import (
    NEVER,
    Ended,
    calls_of,
    damage,
    fill,
    finish,
    start,
    told_in_one_line,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

GEARS = ("gear.stl", "pinion.stl")
TURN = ("--omega", "0", "0", "3", "--omega-b", "0", "0", "-5.9")


# What Python says where it loses an interrupt of its own start, and goes on.
_SWALLOWED = "Failed checking if argv[0] is an import path entry\n"


class Command(NamedTuple):
    """A command line that is interrupted, and the files that it writes."""

    words: tuple[str, ...]
    written: tuple[str, ...] = ()


COMMANDS = (
    Command(("build", "gear.stl", "cube.stl", "--force"), ("gear.obbt", "cube.obbt")),
    Command(("build", "gear.stl", "-o", "old.obbt", "--force"), ("old.obbt",)),
    Command(("sweep", *GEARS, "q.csv", "-o", "out.jsonl"), ("out.jsonl",)),
    Command(("collide", *GEARS, "--all-pairs", "--json", "-o", "old.json"), ("old.json",)),
    Command(("first-contact", *GEARS, *TURN, "--all-contacts")),
    Command(("distance", *GEARS)),
    Command(("scene", "cell.toml", "--json", "-o", "old.json"), ("old.json",)),
    Command(("stability", "cube.stl", "apart.obj", "--vel", "1", "0", "0")),
    Command(("tradeoff", "cube.stl", "apart.obj", "--vel", "1", "0", "0", "--budget", "0.5")),
    Command(("view", "cube.stl", "-o", "new.glb"), ("new.glb",)),
    Command(("info", "old.obbt", "--check")),
    Command(("schema",)),
)


class Outcome(NamedTuple):
    """What a signal did.

    Attributes:
        command: what was running.
        moment: when it came.
        kind: `interrupted`, `finished` (it came too late, or was waited for), `killed`, or
            `before` the command line began.
        ended: how the command ended.
        fault: what was not as it should be; empty where all was.
        damage: what of that is of files.
    """

    command: Command
    moment: str
    kind: str
    ended: Ended
    fault: str
    damage: str


def at_calls(
    sign: signal.Signals,
    count: int,
    seed: int,
    commands: Sequence[Command] = COMMANDS,
    *,
    share: float = 1.0,
) -> Iterator[Outcome]:
    """Send a signal at the N-th call, once for each of so many moments, one command after another.

    Args:
        sign: which signal.
        count: how often.
        seed: of the moments.
        commands: that are interrupted.
        share: moments are drawn from this first part of the calls that a command makes.
    """
    rng = random.Random(seed)  # moments, not secrets
    lengths: dict[Command, int] = {}
    for number in range(count):
        command = commands[number % len(commands)]
        if command not in lengths:
            lengths[command] = calls_of(lambda one=command: _run(one, fault=NEVER)[0])
        moment = f"{sign.name}@{rng.randrange(1, int(share * lengths[command]))}"
        yield _judged(command, moment, sign, *_run(command, fault=moment, sign=sign))


def at_events() -> Iterator[Outcome]:
    """Send signals before a file is made, and before it gets its mode and its name."""
    build = Command(("build", "gear.stl", "-o", "old.obbt", "--force"), ("old.obbt",))
    for sign in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        for event in ("open", "os.chmod", "os.rename"):
            moment = f"{sign.name}@{event}"
            yield _judged(build, moment, sign, *_run(build, fault=moment, sign=sign))


def at_times(
    sign: signal.Signals, count: int, seed: int, commands: Sequence[Command] = COMMANDS
) -> Iterator[Outcome]:
    """Send a signal after a time that is drawn evenly from what the command takes by itself.

    Args:
        sign: which signal.
        count: how often.
        seed: of the times, as shares of the whole.
        commands: that are interrupted.
    """
    rng = random.Random(seed)
    seconds: dict[Command, float] = {}
    for number in range(count):
        command = commands[number % len(commands)]
        if command not in seconds:
            begun = time.perf_counter()
            _run(command)
            seconds[command] = time.perf_counter() - begun
        share = rng.random()
        ended, wrong = _run(command, sign=sign, after=share * seconds[command])
        yield _judged(command, f"{sign.name} at {share:.1%}", sign, ended, wrong)


def _run(
    command: Command,
    *,
    fault: str = "",
    sign: signal.Signals | None = None,
    after: float | None = None,
) -> tuple[Ended, str]:
    """Run a command in a folder of its own; return how it ended and what is wrong with files."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "world"
        folder.mkdir()
        before = fill(folder)
        process = start(folder, command.words, fault=fault)
        if sign is not None and after is not None:
            time.sleep(after)
            process.send_signal(sign)
        ended = finish(folder, process)
        is_killed = sign is signal.SIGKILL
        return ended, damage(folder, before, written=command.written, is_killed=is_killed)


def _judged(
    command: Command, moment: str, sign: signal.Signals, ended: Ended, wrong: str
) -> Outcome:
    """Return what a signal did, and whether that is as it should be."""
    if not ended.has_begun or ended.err.startswith(_SWALLOWED):
        return Outcome(command, moment, "before", ended, wrong, wrong)
    kind, faults = "finished", [wrong]
    if sign is signal.SIGKILL:
        kind = "killed" if ended.code == -sign else kind
    elif ended.code == 130:
        kind = "interrupted"
        if ended.err.count("\n") != 1 or "interrupted" not in ended.err:
            faults.append(f"not one line that says so: {ended.err[-300:]!r}")
    if kind == "finished" and ended.code != 0:
        faults.append(f"exit code {ended.code}: {ended.err[-300:]!r}")
    if not told_in_one_line(ended):
        faults.append(f"not one line: {ended.err[-600:]!r}")
    fault = "; ".join(fault for fault in faults if fault)
    return Outcome(command, moment, kind, ended, fault, wrong)
