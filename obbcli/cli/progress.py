"""Progress on stderr: only on a terminal, only for work worth waiting for."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

# Smaller meshes are done before a bar could be read; drawing one would only slow them down.
WORTH_A_BAR = 300_000


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
    if not wanted or triangle_count < WORTH_A_BAR or sys.stderr is None or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True, markup=False, emoji=False)
    columns = (TextColumn("{task.description}", markup=False), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task(title, total=None)

        def move(share: float) -> None:
            progress.update(task, total=1.0, completed=share)

        yield move
