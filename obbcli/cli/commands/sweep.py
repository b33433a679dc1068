"""`obbtree sweep`: first contacts of one pair in many motions, row by row of a file."""

from __future__ import annotations

import time
from contextlib import ExitStack, contextmanager
from functools import partial
from importlib.util import find_spec
from itertools import islice
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import click

from obbcli.cli.boundary import CancelledError, ExitCode, OutputError, UsageError, writing
from obbcli.cli.inputs import STDIN, keep_inputs, read_pair
from obbcli.cli.options.option import Command, gathered, option
from obbcli.cli.options.two_bodies import QUESTION, about_two
from obbcli.cli.options.words import PathName, Whole
from obbcli.cli.output import emit
from obbcli.cli.progress import counting
from obbcli.threads import thread_count

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from pathlib import Path

    from obbcli.cli.inputs import Input
    from obbcli.cli.options.two_bodies import TwoBodyOptions
    from obbcli.questions.pair_question import Trees
    from obbcli.report.record import Record
    from obbcli.report.sweep import Swept
    from obbcli.sweeps.query_file import Queries
    from obbcli.sweeps.result_lines import Block
    from obbcli.sweeps.results_file import ResultsFile
    from obbcli.sweeps.row_fields import Row
    from obbcli.sweeps.row_questions import SweepSetting

    Answerer: TypeAlias = Callable[[Iterator[Row]], Iterator[Block]]


class SweepOptions(NamedTuple):
    """Where rows are answered, and what becomes of results that exist."""

    resume: bool
    force: bool
    threads: int | None
    workers: int | None
    scheduler: str | None
    solid: bool


_SWEEP = "Sweep"
sweep_options = gathered(
    "how",
    SweepOptions,
    (
        option(_SWEEP, "--resume", is_flag=True, help="Go on where an earlier run ended."),
        option(_SWEEP, "--force", is_flag=True, help="Replace results that exist."),
        option(
            _SWEEP,
            "--threads",
            type=Whole(1),
            metavar="N",
            help="Ask about N rows at a time [default: one a core].",
        ),
        option(
            _SWEEP,
            "--workers",
            type=Whole(1),
            metavar="N",
            help="Start a Dask cluster of N processes for it [default: threads alone]; needs "
            "distributed.",
        ),
        option(
            _SWEEP, "--scheduler", metavar="ADDRESS", help="Use the Dask cluster that is there."
        ),
        option(QUESTION, "--solid", is_flag=True, help="A body inside another is contact too."),
    ),
)


@click.command(
    "sweep",
    cls=Command,
    short_help="When do two bodies first touch, in each of many motions?",
    epilog="""\b
Examples:
  obbtree sweep gear.stl pinion.stl motions.csv -o contacts.jsonl --duration 2
  obbtree sweep gear.stl pinion.stl motions.csv -o contacts.jsonl --duration 2 --resume
  generate | obbtree sweep arm.stl shelf.obbt - -o contacts.jsonl --vel 0 0 -50
""",
)
@about_two(
    "Exit with 1 where any row touches, 0 where all are proven apart.",
    "Write the results to FILE, a JSON object a line; required.",
)
@click.argument("queries", metavar="QUERIES", type=PathName())
@sweep_options
def command(asked: TwoBodyOptions, queries: str, how: SweepOptions) -> int:
    """Ask first-contact of A and B for every row of QUERIES, a CSV or JSONL file.

    Columns or keys are named as the options: vel, omega, pivot, translate, rotate, the same with
    _b, and duration; id names a row. A cell holds three numbers, separated by spaces, or columns
    vel_x, vel_y and vel_z one each. What a row leaves out is as the options say.

    Results keep the order of the rows. Whatever ends a sweep, --resume goes on with the next row. A
    row that cannot be asked is an error row, and not the end.
    """
    from obbcli.report.sweep import sweep_bare, sweep_record, sweep_tables

    output = _output(asked, queries, how)
    header, swept = _sweep(asked, queries, how, output)
    summary = asked.common._replace(output=None)
    emit(sweep_record(header, swept), sweep_tables, summary, sweep_bare)
    return _exit_code(swept.tally, asked=asked.exit_code)


def _output(asked: TwoBodyOptions, queries: str, how: SweepOptions) -> Path:
    """Return where results go.

    Raises:
        UsageError: nowhere, or over an input, or standard input stands for two files.
        OutputError: there are results already.
    """
    output = asked.common.output
    if output is None:
        raise UsageError("-o", "is missing", "name the file of results, as in -o RESULTS.jsonl")
    if how.resume and how.force:
        raise UsageError("--resume", "keeps results, and --force replaces them", "leave one out")
    if queries == STDIN and STDIN in (asked.a, asked.b):
        raise UsageError("QUERIES", "is standard input, and so is a mesh", "name a file for one")
    _check_cluster(how)
    keep_inputs(output, (asked.a, asked.b, queries))
    if output.is_file() and not (how.resume or how.force):
        raise OutputError(str(output), "exists already", "add --resume, or --force to start again")
    return output


def _check_cluster(how: SweepOptions) -> None:
    """Refuse a cluster that cannot be.

    Raises:
        UsageError: two are asked for, threads as well, or the package is not there.
    """
    given = [name for name in ("scheduler", "workers", "threads") if getattr(how, name) is not None]
    if len(given) > 1:
        fault = f"--{given[0]} and --{given[1]} say differently where rows are answered"
        raise UsageError(f"--{given[1]}", fault, "leave one of them out")
    if given in (["scheduler"], ["workers"]) and find_spec("distributed") is None:
        remedy = "install it: pip install distributed"
        raise UsageError(f"--{given[0]}", "needs the package distributed", remedy)


def _sweep(
    asked: TwoBodyOptions, name: str, how: SweepOptions, output: Path
) -> tuple[Record, Swept]:
    """Answer all rows; return the header of the results and how it went."""
    from obbcli.report.sweep import Swept
    from obbcli.sweeps.query_file import opened
    from obbcli.sweeps.results_file import opened_results
    from obbcli.sweeps.stream import started

    setting = _setting(asked, solid=how.solid)
    with ExitStack() as stack:
        queries = stack.enter_context(opened(name))
        rows = started(queries.rows())  # faulty columns are told before anything is written
        files = _read(asked)
        if how.solid:
            from obbcli.sweeps.solids import require_solids

            require_solids((files[0].tree, files[1].tree))
        header = _header(asked, setting, files, queries)
        start = time.perf_counter()
        answer = stack.enter_context(_answerer(how, (files[0].tree, files[1].tree), setting))
        ready = time.perf_counter()
        with writing(output):
            results = stack.enter_context(opened_results(output, header, resumed=how.resume))
        with _keeping(output, results):
            left = islice(rows, results.row_count, None)
            with counting(wanted=asked.common.shows_progress) as show:
                for block in answer(left):
                    with writing(output):
                        results.append(block)
                    show(queries.share, results.row_count - results.resumed_from)
    loads = sum({id(file): file.seconds for file in files}.values())
    times = {"load": loads, "query": time.perf_counter() - ready}
    if how.workers is not None or how.scheduler is not None:
        times["cluster"] = ready - start
    tally = dict(results.tally)
    return header, Swept(str(output), results.row_count, results.resumed_from, tally, times)


@contextmanager
def _answerer(how: SweepOptions, trees: Trees, setting: SweepSetting) -> Iterator[Answerer]:
    """Give what turns rows into results: this process, or a cluster."""
    if how.workers is None and how.scheduler is None:
        from obbcli.sweeps.stream import answered

        yield partial(answered, trees, setting=setting, threads=thread_count(how.threads))
        return
    from obbcli.sweeps.cluster import answered_by, connected

    with connected(how.scheduler, how.workers) as client:
        yield partial(answered_by, client, trees, setting=setting)


def _setting(asked: TwoBodyOptions, *, solid: bool) -> SweepSetting:
    """Return what all rows have in common.

    Raises:
        UsageError: a number is refused, or an option has no meaning with the others.
    """
    from obbcli.sweeps.row_questions import SweepSetting

    asked.pose.poses()  # refuses what is no rotation
    given = asked.pose._asdict() | asked.motion._asdict()
    degrees = given.pop("degrees")
    defaults = {name: value for name, value in given.items() if value is not None}
    return SweepSetting(defaults, degrees, asked.accuracy.accuracy(), solid)


def _read(asked: TwoBodyOptions) -> tuple[Input, Input]:
    """Return A and B, with what is needed to know them again.

    Raises:
        ObbError: one of them cannot be read, or they state different units.
    """
    from obbcli.questions.pair_question import check_pair_units

    a, b = read_pair(
        asked.a,
        asked.b,
        (asked.units.of_a(), asked.units.of_b()),
        verify=not asked.no_verify,
        hashed=True,
        progress=asked.common.shows_progress,
    )
    check_pair_units((a.tree, b.tree))
    return a, b


def _header(
    asked: TwoBodyOptions, setting: SweepSetting, files: tuple[Input, Input], queries: Queries
) -> Record:
    """Return the first line of the results."""
    from obbcli.report.rows import about_units
    from obbcli.report.sweep import header_record
    from obbcli.sweeps.results_file import with_digest

    a, b = files
    sources = a.source(with_sha256=True), b.source(with_sha256=True)
    sources = about_units(sources, (a.tree, b.tree))
    about = {"path": queries.name, "sha256": queries.sha256, "format": queries.format}
    given = asked.pose._asdict() | asked.motion._asdict()
    options = {
        name: list(value) if isinstance(value, tuple) else value for name, value in given.items()
    }
    # What is not asked for is no key, so that results written before these options came go on.
    options |= {name: value for name, value in asked.units._asdict().items() if value is not None}
    options |= {"solid": True} if setting.solid else {}
    accuracy = setting.accuracy.as_dict()
    return with_digest(header_record(sources, about, options, accuracy))


@contextmanager
def _keeping(output: Path, results: ResultsFile) -> Iterator[None]:
    """Say of Ctrl-C what it left."""
    try:
        yield
    except KeyboardInterrupt as fault:
        kept = f"{results.row_count:,} rows are in {output}: add --resume to go on"
        raise CancelledError("", "interrupted", kept) from fault


def _exit_code(tally: Mapping[str, int], *, asked: bool) -> int:
    """Return the exit code of a sweep: of what its rows have, the highest.

    Args:
        tally: how many rows have which status.
        asked: whether contact has a code of its own.
    """
    codes = {"error": ExitCode.INPUT, "unresolved": ExitCode.UNRESOLVED}
    if asked:
        codes |= dict.fromkeys(("contact", "overlap_at_start"), ExitCode.CONTACT)
        codes["separated as sampled"] = ExitCode.UNRESOLVED
    return max((code for name, code in codes.items() if tally.get(name)), default=0)
