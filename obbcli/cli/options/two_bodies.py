"""What the commands about A and B share: options, refusals, limits, Ctrl-C, exit codes."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

import click

from obbcli.cli.boundary import CancelledError, ExitCode, UsageError
from obbcli.cli.inputs import keep_inputs, read_pair
from obbcli.cli.options.accuracy import AccuracyOptions, accuracy_options
from obbcli.cli.options.option import (
    TO_FILE,
    CommonOptions,
    common_options,
    gathered,
    option,
    verify_option,
)
from obbcli.cli.options.placement import (
    MotionOptions,
    PoseOptions,
    QuestionOptions,
    UnitOptions,
    motion_options,
    pose_options,
    unit_options,
)
from obbcli.cli.options.words import PathName
from obbcli.cli.progress import proving
from obbcli.errors import MotionError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from obbcli.accuracy import Accuracy
    from obbcli.answers.contact import FirstContact
    from obbcli.cli.inputs import Input
    from obbcli.cli.options.option import Decorator
    from obbcli.questions.pair_question import PairQuestion
    from obbcli.questions.query import Query
    from obbcli.report.record import Record, Setting

QUESTION = "Question"
"""The heading over the options of one command about A and B alone."""


class TwoBodyOptions(NamedTuple):
    """What every command about A and B is told."""

    a: str
    b: str
    exit_code: bool
    units: UnitOptions
    pose: PoseOptions
    motion: MotionOptions
    accuracy: AccuracyOptions
    no_verify: bool
    common: CommonOptions

    def question(self) -> QuestionOptions:
        """Return the question.

        Raises:
            UsageError: a number is refused, or an option has no meaning with the others.
        """
        return QuestionOptions.of(self.pose, self.motion, self.accuracy)

    def read(self) -> tuple[Input, Input]:
        """Return A and B.

        Raises:
            UsageError: the answer would go where one of them is, or both are standard input.
            ObbError: one of them cannot be read, as `read` says.
        """
        keep_inputs(self.common.output, (self.a, self.b))
        return read_pair(
            self.a,
            self.b,
            (self.units.of_a(), self.units.of_b()),
            verify=not self.no_verify,
            hashed=self.common.json,
            progress=self.common.shows_progress,
        )

    def setting(
        self, files: tuple[Input, Input], pair: PairQuestion, solid: bool | None = None
    ) -> Setting:
        """Return what a record says of the question."""
        from obbcli.report.record import Setting, shown_motion
        from obbcli.report.rows import about_units

        # Hashes cost time, and only a document shows them.
        is_shown = self.common.json
        sources = files[0].source(with_sha256=is_shown), files[1].source(with_sha256=is_shown)
        if not self.common.quiet:
            sources = about_units(sources, pair.trees)
        motion = shown_motion(pair.bodies, pair.duration, in_document=is_shown)
        return Setting(sources, motion, pair.accuracy, solid)


def about_two(
    exit_code: str,
    output: str = TO_FILE,
    *,
    is_b_required: bool = True,
    takes_dash: bool = True,
) -> Decorator:
    """Return what gives a command its A and B, and all options of `asked`.

    Args:
        exit_code: the help of `--exit-code`.
        output: the help of `-o`.
        is_b_required: whether there is no command without B, which is an empty word then.
        takes_dash: whether `-o -` means standard output.
    """
    return gathered(
        "asked",
        TwoBodyOptions,
        (
            click.argument("a", metavar="A", type=PathName()),
            click.argument(
                "b",
                metavar="B" if is_b_required else "[B]",
                type=PathName(),
                required=is_b_required,
                callback=lambda _context, _param, name: name or "",
            ),
            option(QUESTION, "--exit-code", is_flag=True, help=exit_code),
            unit_options,
            pose_options,
            motion_options,
            accuracy_options,
            verify_option,
            common_options(output, takes_dash=takes_dash),
        ),
    )


# s between two looks at the clock, where steps of few pops take the time.
_LOOK = 0.1


def run(query: Query, accuracy: Accuracy, *, progress: bool) -> FirstContact:
    """Advance a query to its end or to a limit of `accuracy`, and return its answer.

    Args:
        query: not yet advanced.
        accuracy: whose `max_iterations` and `timeout` end it.
        progress: whether a bar may be drawn.

    Raises:
        CancelledError: Ctrl-C; it says up to when separation is proven.
    """
    from obbcli.questions.budget import Budget

    budget = Budget(accuracy.max_iterations, accuracy.timeout).start()
    taken = 0
    try:
        with proving(query.duration, _shown(accuracy), wanted=progress) as show:
            while True:
                # The slices of `Query.advance` itself: a bar changes no answer.
                answer = query.advance(budget.slice(), _LOOK)
                budget.spend(answer.stats.pops - taken)
                taken = answer.stats.pops
                if query.is_finished or budget.is_over:
                    return answer
                show(query.time)
    except KeyboardInterrupt as fault:
        raise CancelledError("", "interrupted", _proven(query)) from fault


def _shown(accuracy: Accuracy) -> str:
    """Return what the time that a question has come to is the end of."""
    return "sampled until" if accuracy.method == "sampled" else "no contact before"


def _proven(query: Query) -> str:
    bound = query.lower_bound
    if bound > 0:
        return f"no contact before t = {bound!r} of {query.duration:g} s: proven"
    return "nothing was proven yet"


@contextmanager
def naming_options(question: QuestionOptions) -> Iterator[None]:
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


def exit_code(result: Record, *, asked: bool) -> int:
    """Return the exit code of an answer; `asked` is whether contact has one of its own.

    Who asks takes 0 for proof, which samples do not give.
    """
    is_separated = result["status"] == "separated"
    is_open = result["status"] == "unresolved" or (
        result.get("contacts_unresolved_after") is not None
    )
    if is_open or (asked and is_separated and result["approximate"]):
        return ExitCode.UNRESOLVED
    return ExitCode.CONTACT if asked and not is_separated else ExitCode.ANSWERED


def refuse_what_moves(motion: MotionOptions, ask: str) -> None:
    """Refuse options of motion where the question is about t = 0: none is ever ignored.

    Raises:
        UsageError: one is given.
    """
    for name, value in motion._asdict().items():
        if value is not None:
            fault = f"moves bodies; the {ask} is that at t = 0"
            remedy = "leave it out, or see obbtree first-contact"
            raise UsageError("--" + name.replace("_", "-"), fault, remedy)


def meeting_of(answer: Record) -> tuple[bool, bool]:
    """Return whether an answer of a study is open, and whether its bodies meet."""
    if "status" in answer:
        return answer["status"] == "unresolved", answer["status"] != "separated"
    if "relation" in answer:
        from obbcli.answers.overlap import MEETING

        return answer["relation"] == "unresolved", answer["relation"] in MEETING
    return not answer["complete"], answer["distance"] == 0
