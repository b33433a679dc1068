"""`obbtree scene --overlaps`: which bodies touch or overlap at t = 0, and how deep."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.accuracy import DEPTH_TOLERANCE
from obbcli.cli.boundary import ExitCode, UsageError, usage_errors
from obbcli.cli.output import emit, tell_interrupted
from obbcli.cli.scene_files import decoded, mesh_sources
from obbcli.errors import SceneError

if TYPE_CHECKING:
    from obbcli.cli.options.accuracy import AccuracyOptions
    from obbcli.cli.options.option import CommonOptions
    from obbcli.cli.scene_files import Stamps
    from obbcli.report.record import Record, Source
    from obbcli.report.scene_overlaps import Found
    from obbcli.scene import Scene
    from obbcli.scene.overlaps import Overlaps


def refuse_of_overlaps(accuracy: AccuracyOptions, duration: float | None) -> None:
    """Refuse options that say nothing about overlaps at t = 0: none is ever ignored.

    Raises:
        UsageError: one is given.
    """
    from obbcli.questions.overlap.asked import CONCERNS

    given = [name for name in accuracy.given() if name not in CONCERNS]
    if duration is not None:
        given.append("duration")
    for name in given:
        fault = "says nothing about overlaps at t = 0"
        raise UsageError("--" + name.replace("_", "-"), fault, "leave it out")


def overlaps_of(
    scene: Scene,
    pairs: list[tuple[str, str]] | None,
    tolerance: float | None,
    touch: tuple[float, float] | None,
) -> Overlaps:
    """Return the question about overlaps, not yet advanced.

    Args:
        scene: that it is about.
        pairs: the bodies asked about, by name; None: all pairs.
        tolerance: relative width of brackets; None: the default.
        touch: gap and overlap that count as touching, mesh units; None: the default.

    Raises:
        UsageError: a number is refused, or a pair is none.
    """
    width = DEPTH_TOLERANCE if tolerance is None else tolerance
    try:
        with usage_errors(tolerance="--tolerance"):
            return scene.overlaps(pairs, tolerance=width, touch=touch)
    except SceneError as fault:
        # What is typed is usage.
        raise UsageError(f"--{fault.where}", fault.fault, fault.remedy) from fault


def answer_overlaps(
    overlaps: Overlaps,
    scene: Scene,
    source: Source,
    stamps: Stamps,
    common: CommonOptions,
    *,
    exit_code: bool,
) -> int:
    """Ask a question about overlaps to its end, write the answer and return the exit code.

    Args:
        overlaps: the question.
        scene: that it is about.
        source: the scene's file.
        stamps: what the files of its bodies were when it was read.
        common: how to answer.
        exit_code: whether overlap has an exit code of its own.
    """
    from obbcli.report.scene_overlaps import (
        scene_overlaps_bare,
        scene_overlaps_record,
        scene_overlaps_tables,
    )

    found = _run(overlaps)
    # Hashes cost time, and only a document shows them.
    hashed = stamps if common.json else None
    meshes = mesh_sources(source, scene, overlaps.asked, overlaps.stats, hashed)
    record = scene_overlaps_record(source, meshes, overlaps, scene.ignore, found)
    record["stats"] |= decoded(scene)
    emit(record, scene_overlaps_tables, common, bare=scene_overlaps_bare)
    if found.is_interrupted:
        tell_interrupted(f"pairs not asked: {record['stats']['later']}", common)
    return _exit_code(record["result"], asked=exit_code)


def _run(overlaps: Overlaps) -> Found:
    """Return what came out; after Ctrl-C what is known by then."""
    from obbcli.report.scene_overlaps import Found

    pairs = []
    try:
        for one in overlaps:
            pairs.append(one)  # an interrupt keeps those that are known
    except KeyboardInterrupt:
        return Found(pairs, is_interrupted=True)
    return Found(pairs, is_interrupted=False)


def _exit_code(result: Record, *, asked: bool) -> int:
    from obbcli.answers.overlap import MEETING

    relations = {pair["relation"] for pair in result["pairs"]}
    if result["interrupted"]:
        return ExitCode.INTERRUPTED
    if "unresolved" in relations:
        return ExitCode.UNRESOLVED
    return ExitCode.CONTACT if asked and relations.intersection(MEETING) else ExitCode.ANSWERED
