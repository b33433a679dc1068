"""Faults injected into whole commands: the part of `make faults` that is quick and repeats."""

from __future__ import annotations

import signal
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from faults.changes import KINDS, changed, removed_at_both_ends
from faults.run import run_scenario
from faults.scenarios import all_scenarios, ask
from faults.signals import COMMANDS, at_calls, at_events
from faults.world import fill, finish, start

from obbcli.files import TEMPORARY

if TYPE_CHECKING:
    from pathlib import Path

    from faults.scenarios import Scenario

# The first of each kind of fault; what takes a whole library to draw with is left to `make faults`.
SCENARIOS = list({one.fault: one for one in reversed(list(all_scenarios()))}.values())
QUICK = [one for one in COMMANDS if one.words[0] in ("build", "sweep", "scene")]

# A callback whose exceptions Python prints and forgets.
LOST = """
import gc, signal, sys, time
from obbcli.cli.process import SIGNALS

class Dying:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)
        time.sleep(0)

signal.signal(signal.SIGINT, signal.default_int_handler)  # background jobs ignore it
SIGNALS.install()
SIGNALS.are_heard = True
try:
    dying = Dying()
    del dying
    while True:
        time.sleep(0.001)
except KeyboardInterrupt:
    print("heard")
"""


@pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda one: one.fault)
def test_fault_ends_as_it_must(scenario: Scenario) -> None:
    assert run_scenario(scenario).wrong == ""


def test_interrupts_at_any_call_are_told_in_one_line() -> None:
    outcomes = list(at_calls(signal.SIGINT, 8, seed=7, commands=QUICK, share=0.5))

    assert [one.fault for one in outcomes if one.fault] == []
    # A signal that comes while a module is imported waits, and may then be too late.
    kinds = {one.kind for one in outcomes}
    assert "interrupted" in kinds <= {"interrupted", "finished"}


def test_signals_before_each_step_of_writing_leave_files_whole() -> None:
    outcomes = list(at_events())

    assert [one.fault for one in outcomes if one.fault] == []
    assert [one.kind for one in outcomes] == ["interrupted"] * 6 + ["killed"] * 3


def test_killed_write_leaves_a_file_that_is_known_by_its_name(tmp_path: Path) -> None:
    folder = tmp_path / "world"
    folder.mkdir()
    before = fill(folder)
    words = ("build", "gear.stl", "-o", "old.obbt", "--force")

    finish(folder, start(folder, words, fault="SIGKILL@os.rename"))

    (left,) = {path.name for path in folder.iterdir()} - before.keys()
    assert left.startswith(TEMPORARY)
    # Nobody takes it for a mesh or a tree, and the next run is not in its way.
    assert finish(folder, start(folder, words)).code == 0


def test_interrupt_that_somebody_else_ignores_stays_ignored(tmp_path: Path) -> None:
    folder = tmp_path / "world"
    folder.mkdir()
    fill(folder)

    def ignore() -> None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)

    ended = finish(folder, start(folder, ask(), fault="SIGINT@90000", limit=ignore))

    assert (ended.code, ended.err) == (0, "")


def test_interrupt_in_a_callback_is_not_lost() -> None:
    ended = subprocess.run(
        [sys.executable, "-c", LOST], capture_output=True, text=True, timeout=600, check=False
    )

    assert (ended.stdout, ended.stderr) == ("heard\n", "")


def test_file_that_changes_in_use_is_told_or_does_not_matter() -> None:
    outcomes = list(changed(10, seed=3))

    assert [one.fault for one in outcomes if one.fault] == []
    assert {one.kind for one in outcomes} <= {"answered", "refused"}


def test_file_that_is_removed_is_refused_until_it_is_read() -> None:
    outcomes = list(removed_at_both_ends())

    assert [one.fault for one in outcomes if one.fault] == []
    assert [one.kind for one in outcomes] == ["refused", "answered"] * len(KINDS)
