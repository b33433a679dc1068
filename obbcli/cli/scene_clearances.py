"""`obbtree scene --least-clearance`: how near bodies come to each other, the nearest pair first."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from obbcli.accuracy import CLEARANCE_TOLERANCE
from obbcli.cli.boundary import ExitCode, UsageError, usage_errors
from obbcli.cli.output import emit, tell_interrupted
from obbcli.cli.progress import narrowing
from obbcli.cli.scene_files import decoded, mesh_sources
from obbcli.errors import SceneError

if TYPE_CHECKING:
    from obbcli.cli.options.accuracy import AccuracyOptions
    from obbcli.cli.options.option import CommonOptions
    from obbcli.cli.scene_files import Stamps
    from obbcli.cli.scene_wanted import Wanted
    from obbcli.report.record import Record, Source
    from obbcli.report.scene_clearances import Found
    from obbcli.scene import Scene
    from obbcli.scene.clearances import Clearances, SceneClearance


@dataclass(frozen=True)
class Setting:
    """What a question is about, and how to answer it.

    Attributes:
        scene: that it is about.
        source: the scene's file.
        stamps: what the files of its bodies were when it was read.
        common: how to answer.
        explains: whether to say what of each body was used.
    """

    scene: Scene
    source: Source
    stamps: Stamps
    common: CommonOptions
    explains: bool


def refuse_of_clearances(accuracy: AccuracyOptions) -> None:
    """Refuse options that say nothing about least clearances: none is ever ignored.

    Raises:
        UsageError: one is given.
    """
    from obbcli.questions.clearance.asked import CONCERNS, why_refused

    for name in accuracy.given():
        if name not in CONCERNS:
            fault, remedy = why_refused(name)
            if name == "clearance":
                remedy = "use --at-least D, or leave out --least-clearance"
            raise UsageError("--" + name.replace("_", "-"), fault, remedy)


def clearances_of(scene: Scene, pairs: list[tuple[str, str]] | None, wanted: Wanted) -> Clearances:
    """Return the question about least clearances, not yet advanced.

    Args:
        scene: that it is about.
        pairs: the bodies asked about, by name; None: all pairs.
        wanted: what is asked.

    Raises:
        UsageError: a number is refused, or a pair is none.
        SceneError: the scene's file asks for what says nothing here.
    """
    from obbcli.errors import MotionError
    from obbcli.questions.clearance.asked import refuse_other_accuracy

    try:
        refuse_other_accuracy(scene.accuracy)
    except MotionError as fault:
        raise SceneError(f"accuracy.{fault.where}", fault.fault, fault.remedy) from fault
    width = CLEARANCE_TOLERANCE if wanted.tolerance is None else wanted.tolerance
    try:
        with usage_errors(tolerance="--tolerance"):
            return scene.clearances(
                wanted.within, wanted.at_least, pairs, wanted.solid or None, tolerance=width
            )
    except SceneError as fault:
        # What is typed is usage.
        raise UsageError(f"--{fault.where}", fault.fault, fault.remedy) from fault


def answer_clearances(
    clearances: Clearances, setting: Setting, limit: int | None, *, exit_code: bool
) -> int:
    """Ask a question about least clearances, write the answer and return the exit code.

    Args:
        clearances: the question.
        setting: what it is about.
        limit: at most so many pairs. None: all.
        exit_code: whether contact, or what is nearer than was asked, has an exit code of its own.
    """
    from obbcli.report.scene_clearances import (
        explained_clearances,
        scene_clearances_bare,
        scene_clearances_record,
        scene_clearances_tables,
    )

    common, scene = setting.common, setting.scene
    found = _run(clearances, limit, progress=common.shows_progress)
    # Hashes cost time, and only a document shows them.
    hashed = setting.stamps if common.json else None
    meshes = mesh_sources(setting.source, scene, clearances.asked, clearances.stats, hashed)
    record = scene_clearances_record(
        setting.source, meshes, clearances, scene.ignore, found, with_motion=common.json
    )
    record["stats"] |= decoded(scene)
    tables = explained_clearances if setting.explains else scene_clearances_tables
    emit(record, tables, common, bare=scene_clearances_bare)
    if found.is_interrupted:
        tell_interrupted(f"pairs not answered: {record['stats']['later']}", common)
    return _exit_code(record, asked=exit_code)


def _run(clearances: Clearances, limit: int | None, *, progress: bool) -> Found:
    """Return what came out; after Ctrl-C what is known by then."""
    from obbcli.report.scene_clearances import Found

    pairs: list[SceneClearance] = []
    is_interrupted = False
    with narrowing(wanted=progress) as show:
        while not clearances.is_finished and (limit is None or len(pairs) < limit):
            try:
                one = clearances.advance()
                show(clearances.low, float("inf"))
            except KeyboardInterrupt:
                if is_interrupted:
                    raise
                is_interrupted = True
                clearances.stop()
                continue
            if one is not None:
                pairs.append(one)
    return Found(pairs, limit, is_interrupted)


def _exit_code(record: Record, *, asked: bool) -> int:
    result = record["result"]
    if result["interrupted"]:
        return ExitCode.INTERRUPTED
    pairs = result["pairs"]
    answers = [_end_of(pair) for pair in pairs]
    is_verdict_open = any((pair["at_least"] or {}).get("verdict") == "open" for pair in pairs)
    if not result["complete"] or is_verdict_open or (asked and "unknown" in answers):
        return ExitCode.UNRESOLVED
    return ExitCode.CONTACT if asked and "near" in answers else ExitCode.ANSWERED


def _end_of(pair: Record) -> str:
    """Return whether two bodies are near, apart, or that it is not known."""
    held = pair["at_least"]
    if held is not None:
        return {"holds": "apart", "violated": "near", "open": "unknown"}[held["verdict"]]
    low, high = pair["minimum"]["bounds"]
    if high == 0:
        return "near"
    return "apart" if low > 0 else "unknown"
