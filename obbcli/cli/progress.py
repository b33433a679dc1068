"""Progress on stderr: only on a terminal, only for work worth waiting for."""

from __future__ import annotations

import sys
import time
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rich.progress import Progress

# Smaller meshes are done before a bar could be read; drawing one would only slow them down.
WORTH_A_BAR = 300_000
# s; a question that is answered sooner shows no bar.
PATIENCE = 1.0


@contextmanager
def bar(
    title: str, triangle_count: int, *, wanted: bool
) -> Iterator[Callable[[float], None] | None]:
    """Draw a bar while the body runs, and give what moves it.

    Args:
        title: what is being done.
        triangle_count: how much there is to do, which decides whether a bar is worth it.
        wanted: False draws nothing.

    Yields:
        a function that takes the share done, 0 to 1; None where no bar is drawn.
    """
    if triangle_count < WORTH_A_BAR or not (wanted and _is_terminal()):
        yield None
        return
    with _progress() as progress:
        task = progress.add_task(title, total=None)

        def move(share: float) -> None:
            progress.update(task, total=1.0, completed=share)

        yield move


@contextmanager
def proving(duration: float, what: str, *, wanted: bool) -> Iterator[Callable[[float], None]]:
    """Give what shows up to when separation is proven, drawn once the body has run for a second.

    Args:
        duration: s, what is asked about.
        what: what is so up to the time shown, such as "no contact before".
        wanted: False draws nothing.

    Yields:
        a function that takes the time proven so far, s.
    """
    due = time.monotonic() + PATIENCE
    is_drawn = wanted and _is_terminal()
    bars: list[Progress] = []
    with ExitStack() as stack:

        def show(proven: float) -> None:
            if not is_drawn or time.monotonic() < due:
                return
            if not bars:
                bars.append(stack.enter_context(_progress()))
                bars[0].add_task("", total=duration)
                bars[0].tasks[0].start_time = due - PATIENCE
            text = f"{what} t = {proven:.6g} of {duration:g} s"
            bars[0].update(bars[0].task_ids[0], description=text, completed=proven)

        yield show


@contextmanager
def narrowing(*, wanted: bool) -> Iterator[Callable[[float, float], None]]:
    """Give what shows between which bounds a length lies, once the body has run for a second.

    Args:
        wanted: False draws nothing.

    Yields:
        a function that takes both bounds, mesh units.
    """
    due = time.monotonic() + PATIENCE
    is_drawn = wanted and _is_terminal()
    bars: list[Progress] = []
    with ExitStack() as stack:

        def show(low: float, high: float) -> None:
            if not is_drawn or time.monotonic() < due:
                return
            if not bars:
                bars.append(stack.enter_context(_progress()))
                bars[0].add_task("", total=1.0)
            text = f"least distance between {low:.6g} and {high:.6g}"
            share = low / high if high else 1.0
            bars[0].update(bars[0].task_ids[0], description=text, completed=share)

        yield show


@contextmanager
def counting(*, wanted: bool) -> Iterator[Callable[[float, int], None]]:
    """Give what shows how many rows are answered, how fast, and how long the rest takes.

    Args:
        wanted: False draws nothing.

    Yields:
        a function that takes the share of the input that is done, 0 to 1, and the rows answered
        since the body began.
    """
    if not (wanted and _is_terminal()):
        yield lambda _share, _rows: None
        return
    start = time.monotonic()
    begun: list[float] = []
    with _progress() as progress:
        task = progress.add_task("0 rows", total=1.0)

        def show(share: float, rows: int) -> None:
            # What was skipped, of a sweep that goes on, took no time.
            begun[:] = begun or [share]
            seconds = time.monotonic() - start
            done = share - begun[0]
            left = _time_left(seconds, done, 1 - share)
            text = f"{rows:,} rows, {rows / max(seconds, 1e-9):,.0f} a second{left}"
            progress.update(task, completed=share, description=text)

        yield show


@contextmanager
def trying(count: int, *, wanted: bool) -> Iterator[Callable[[int, str], None]]:
    """Give what shows how many of so many are tried, what is being tried, and what time is left.

    Args:
        count: how many there are.
        wanted: False draws nothing.

    Yields:
        a function that takes how many are done and what comes next.
    """
    if not (wanted and _is_terminal()):
        yield lambda _done, _name: None
        return
    start = time.monotonic()
    with _progress() as progress:
        task = progress.add_task("", total=count)

        def show(done: int, name: str) -> None:
            seconds = time.monotonic() - start
            left = _time_left(seconds, done, count - done)
            text = f"{done} of {count}{left}: {name}"
            progress.update(task, completed=done, description=text)

        yield show


@contextmanager
def measuring(budget: float, *, wanted: bool) -> Iterator[Callable[[float, int], None]]:
    """Give what shows how many settings are measured, and how long the rest takes at most.

    Args:
        budget: s that all of it may take.
        wanted: False draws nothing.

    Yields:
        a function that takes the seconds left and how many settings are measured.
    """
    if not (wanted and _is_terminal()):
        yield lambda _left, _settings: None
        return
    start = time.monotonic()
    with _progress() as progress:
        task = progress.add_task("the reference answer", total=budget or 1.0)

        def show(left: float, settings: int) -> None:
            done = time.monotonic() - start
            text = f"{settings} settings measured, at most {left:,.0f} s left"
            progress.update(task, total=done + left or 1.0, completed=done, description=text)

        yield show


def _time_left(seconds: float, done: float, rest: float) -> str:
    """Return how long the rest takes at the pace of what is done, once there is a pace."""
    return f", {seconds * rest / done:,.0f} s left" if done > 0 else ""


def _is_terminal() -> bool:
    return sys.stderr is not None and sys.stderr.isatty()


def _progress() -> Progress:
    """Return rich's progress display, on stderr, gone when it is done."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True, markup=False, emoji=False)
    columns = (TextColumn("{task.description}", markup=False), BarColumn(), TimeElapsedColumn())
    return Progress(*columns, console=console, transient=True)
