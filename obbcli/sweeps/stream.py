"""Rows to results in chunks: on this machine's cores, or handed on to a cluster."""

from __future__ import annotations

import time
from itertools import chain, islice
from typing import TYPE_CHECKING

from obbcli.sweeps.result_lines import answer_rows

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.questions.pair_question import Trees
    from obbcli.sweeps.result_lines import Block
    from obbcli.sweeps.row_fields import Row
    from obbcli.sweeps.row_questions import SweepSetting

# s: what an interruption may lose, and how often progress shows.
_CHUNK_SECONDS = 0.5
_MOST = 8192
_GROWTH = 4


class Chunks:
    """How many rows to ask at a time: as many as take about half a second.

    Few at first, for nobody knows how long they take.

    Args:
        least: how many there are at least.
    """

    def __init__(self, least: int) -> None:
        self._least = self.row_count = least

    def measured(self, row_count: int, seconds: float) -> None:
        """Take note of how long some rows took, s."""
        fitting = int(_CHUNK_SECONDS * row_count / max(seconds, 1e-9))
        self.row_count = max(self._least, min(fitting, _GROWTH * self.row_count, _MOST))


def started(rows: Iterator[Row]) -> Iterator[Row]:
    """Return rows of which the first was read already, so that a fault before it shows.

    Raises:
        ObbError: there is none, or none can be read.
    """
    first = next(rows)
    return chain([first], rows)


def answered(
    trees: Trees, rows: Iterator[Row], setting: SweepSetting, threads: int
) -> Iterator[Block]:
    """Yield the results of rows in order, some at a time.

    Raises:
        TreeFileError: a tree file is damaged.
        ObbError: the rows cannot be read on.
    """
    chunks = Chunks(threads)
    while some := list(islice(rows, chunks.row_count)):
        start = time.perf_counter()
        yield answer_rows(trees, some, setting, threads)
        chunks.measured(len(some), time.perf_counter() - start)
