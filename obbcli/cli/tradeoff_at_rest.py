"""`obbtree tradeoff --ask distance|overlap`: what a tolerance costs of bodies at rest."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.cli.boundary import ExitCode
from obbcli.cli.options.two_bodies import meeting_of
from obbcli.cli.output import emit, tell_interrupted

if TYPE_CHECKING:
    from obbcli.cli.options.option import CommonOptions
    from obbcli.report.record import Record, Source
    from obbcli.study.tradeoff.at_rest import RestStudy


def answer_at_rest(
    study: RestStudy,
    names: tuple[str, str],
    sources: tuple[Source, Source],
    words: tuple[list[str], float | None],
    common: CommonOptions,
    *,
    is_interrupted: bool,
) -> int:
    """Write what a study found, and return the exit code.

    Args:
        study: which has run.
        names: A and B as they were written.
        sources: their files.
        words: the options that place them, and the longest time a setting is wanted for, s.
        common: how to answer.
        is_interrupted: whether Ctrl-C ended it.
    """
    from obbcli.report.record import Setting, shown_motion
    from obbcli.report.tradeoff_at_rest import (
        RestWording,
        rest_tradeoff_bare,
        rest_tradeoff_record,
        rest_tradeoff_tables,
    )

    motion = shown_motion(study.bodies, 0.0, in_document=common.json)
    record = rest_tradeoff_record(
        Setting(sources, motion, study.accuracy),
        study.result(),
        RestWording(names, *words),
        is_interrupted=is_interrupted,
    )
    emit(record, rest_tradeoff_tables, common, bare=rest_tradeoff_bare)
    if is_interrupted:
        tell_interrupted("what was measured by then is shown", common)
    return _exit_code(record["result"])


def _exit_code(result: Record) -> int:
    if result["interrupted"]:
        return ExitCode.INTERRUPTED
    if result["claims_broken"]:
        return ExitCode.BROKEN
    is_open, _ = meeting_of(result["reference"])
    return ExitCode.UNRESOLVED if is_open else ExitCode.ANSWERED
