"""What the commands that put a question share: refusals, limits, Ctrl-C, exit codes."""

from __future__ import annotations

import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from obbcli import __version__
from obbcli.cli.boundary import CancelledError, ExitCode, UsageError
from obbcli.cli.progress import proving
from obbcli.errors import MotionError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from obbcli.accuracy import Accuracy
    from obbcli.cli.inputs import Input
    from obbcli.cli.question import Question
    from obbcli.contact import Query
    from obbcli.report.record import Record
    from obbcli.results import FirstContact


def refuse_unanswered(asked: Iterable[tuple[str, Any, str]]) -> None:
    """Refuse what this version cannot answer: to ignore it would make the answer a lie.

    Args:
        asked: what, whether it was asked for, and what to do instead.

    Raises:
        UsageError: one of them was.
    """
    for what, is_asked, remedy in asked:
        if is_asked:
            raise UsageError(what, f"not answered by version {__version__} yet", remedy)


def run(query: Query, accuracy: Accuracy, *, progress: bool) -> FirstContact:
    """Advance a query to its end or to a limit of `accuracy`, and return its answer.

    Args:
        query: not yet advanced.
        accuracy: whose `max_iterations` and `timeout` end it.
        progress: whether a bar may be drawn.

    Raises:
        CancelledError: Ctrl-C; it says up to when separation is proven.
    """
    from obbcli.question import POPS_A_SLICE

    left = accuracy.max_iterations
    stop = None if accuracy.timeout is None else time.perf_counter() + accuracy.timeout
    try:
        with proving(query.duration, wanted=progress) as show:
            while True:
                # The slices of `Query.advance` itself: a bar changes no answer.
                answer = query.advance(min(left, POPS_A_SLICE))
                left -= POPS_A_SLICE
                is_late = stop is not None and time.perf_counter() >= stop
                if query.is_finished or left <= 0 or is_late:
                    return answer
                show(query.lower_bound)
    except KeyboardInterrupt as fault:
        raise CancelledError("", "interrupted", _proven(query)) from fault


def _proven(query: Query) -> str:
    bound = query.lower_bound
    if bound > 0:
        return f"no contact before t = {bound!r} of {query.duration:g} s: proven"
    return "nothing was proven yet"


@contextmanager
def naming_options(question: Question) -> Iterator[None]:
    """Name the options behind a refused pose or motion: what is typed is usage."""
    try:
        yield
    except MotionError as fault:
        where = " ".join(question.given.get(fault.where, ())) or fault.where
        raise UsageError(where, fault.fault, fault.remedy) from fault


def with_load_time(record: Record, files: Iterable[Input]) -> Record:
    """Return the record with the time that the files took: they were read before the question."""
    # One file that stands for both bodies was read once.
    record["stats"]["seconds"]["load"] = sum({id(file): file.seconds for file in files}.values())
    return record


def exit_code(status: str, *, asked: bool) -> int:
    """Return the exit code of an answer; `asked` is whether contact has one of its own."""
    if status == "unresolved":
        return ExitCode.UNRESOLVED
    return ExitCode.CONTACT if asked and status != "separated" else ExitCode.ANSWERED
