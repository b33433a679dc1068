"""How the tests are run: the same examples every time, on all cores, in an order that may be drawn.

Tests that need large packages say so: `@pytest.mark.needs("matplotlib")`. `make test` leaves them
out and says at its end how many; `make test-extras` installs what they need and runs them alone.
"""

from __future__ import annotations

import os
import random
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, settings

if TYPE_CHECKING:
    from collections.abc import Sequence

# Bytes that a worker may need: some tests hold large trees, or start processes of their own.
_ROOM = 2 << 30
_LEFT_OUT = pytest.StashKey[Counter[str]]()

settings.register_profile(
    "repeatable",
    deadline=None,
    derandomize=True,
    database=None,
    # It is a clock too: on a busy machine any example takes long to make.
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("repeatable")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that draws an order."""
    told = "run the tests in an order drawn by this seed: none may depend on another"
    parser.addoption("--shuffle", type=int, metavar="SEED", help=told)


def pytest_configure(config: pytest.Config) -> None:
    """Make room for what is left out."""
    config.stash[_LEFT_OUT] = Counter()


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Draw an order where one is asked for; every worker draws the same."""
    seed = config.getoption("--shuffle")
    if seed is not None:
        random.Random(seed).shuffle(items)


def pytest_make_parametrize_id(val: object, argname: str) -> str | None:
    """Name values that are bytes by their argument: every worker must call a test the same.

    Archives made when tests are collected hold the time, so that their bytes may differ.
    """
    return argname if isinstance(val, bytes) else None


# ---- Workers


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """Return how many workers `-n auto` starts: as many as cores, and as memory for them."""
    if hasattr(os, "sched_getaffinity"):
        cores = len(os.sched_getaffinity(0))
    else:
        cores = os.cpu_count() or 1
    return max(1, min(cores, _memory() // _ROOM))


def _memory() -> int:
    """Return how many bytes of memory there are, of the machine or of the container it is in."""
    machine = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    for name in ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"):
        limit = Path(name)
        if limit.exists() and (text := limit.read_text().strip()).isdigit():
            return min(machine, int(text))
    return machine


# ---- What is left out


def pytest_deselected(items: Sequence[pytest.Item]) -> None:
    """Count what is left out, by the package that it needs."""
    for item in items:
        if (marker := item.get_closest_marker("needs")) is not None:
            item.config.stash[_LEFT_OUT][marker.args[0]] += 1


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Tell the process that started this worker, if one did."""
    if (output := getattr(session.config, "workeroutput", None)) is not None:
        output["left_out"] = dict(session.config.stash[_LEFT_OUT])


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: object) -> None:
    """Take what a worker tells: all collect the same."""
    told = getattr(node, "workeroutput", {}).get("left_out", {})
    node.config.stash[_LEFT_OUT] = Counter(told)  # type: ignore[attr-defined]


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Say what was left out, and how to run it."""
    left_out = terminalreporter.config.stash[_LEFT_OUT]
    if left_out:
        parts = ", ".join(f"{count} {name}" for name, count in sorted(left_out.items()))
        terminalreporter.write_line(
            f"left out: {left_out.total()} tests that need large packages ({parts});"
            " to run them: make test-extras"
        )
