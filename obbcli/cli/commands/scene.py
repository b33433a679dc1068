"""`obbtree scene`: every first contact between many moving bodies, earliest first."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from obbcli.accuracy import CLEARANCE_TOLERANCE, DEPTH_TOLERANCE
from obbcli.cli.boundary import ExitCode, UsageError
from obbcli.cli.inputs import keep_inputs
from obbcli.cli.options.accuracy import AccuracyOptions, accuracy_options
from obbcli.cli.options.option import Command, common_options, option, verify_option
from obbcli.cli.options.placement import checked_sag, sag_option
from obbcli.cli.options.two_bodies import QUESTION
from obbcli.cli.options.words import Finite, PathName, Whole
from obbcli.cli.output import emit, tell_interrupted
from obbcli.cli.progress import proving
from obbcli.cli.scene_files import decoded, mesh_sources, read_scene
from obbcli.cli.scene_wanted import Wanted, refuse_contradictions
from obbcli.errors import SceneError

if TYPE_CHECKING:
    from obbcli.cli.options.option import CommonOptions
    from obbcli.cli.scene_files import Stamps
    from obbcli.report.record import Record, Source
    from obbcli.report.scene import Answer
    from obbcli.scene import Scene
    from obbcli.scene.contact_stream import ContactStream
    from obbcli.scene.results import SceneContact


@click.command(
    "scene",
    cls=Command,
    short_help="When do which of many moving bodies first touch?",
    epilog="""\b
Examples:
  obbtree scene cell.toml
  obbtree scene cell.toml --first --json
  obbtree scene robot.glb                   which of its parts touch?
  obbtree scene robot.glb --overlaps        which overlap, and how deep?
  obbtree scene cell.toml --least-clearance --within 5
  obbtree scene cell.toml --pairs gripper,part --pairs gripper,table --all-contacts
  obbtree scene cell.toml --exit-code --quiet && echo "nothing touches"
""",
)
@click.argument("file", metavar="SCENE", type=PathName())
@option(
    QUESTION,
    "--pairs",
    multiple=True,
    metavar="A,B",
    help="Ask about these two bodies alone; repeatable [default: all pairs].",
)
@option(QUESTION, "--first", is_flag=True, help="Stop at the scene's earliest contact.")
@option(QUESTION, "--all-contacts", is_flag=True, help="List every pair of triangles that meets.")
@option(
    QUESTION,
    "--limit",
    type=Whole(1),
    metavar="N",
    help="List the first N contacts, or pairs [default: all].",
)
@option(QUESTION, "--solid", is_flag=True, help="A body inside another is contact too.")
@option(
    QUESTION,
    "--threads",
    type=Whole(1),
    metavar="N",
    help="Ask about N pairs at a time [default: one a core]; nothing else depends on it.",
)
@option(
    QUESTION,
    "--overlaps",
    is_flag=True,
    help="Ask which bodies touch or overlap at t = 0, as solids, and how deep.",
)
@option(
    QUESTION,
    "--tolerance",
    type=Finite(0.0),
    metavar="E",
    help="With --overlaps, --least-clearance: relative width of brackets, in mesh units no "
    f"less than rounding [default: {DEPTH_TOLERANCE:g}, {CLEARANCE_TOLERANCE:g}].",
)
@option(
    QUESTION,
    "--touch",
    nargs=2,
    type=Finite(0.0),
    metavar="GAP OVERLAP",
    help="With --overlaps: what still counts as touching, in mesh units "
    "[default: the files' own rounding].",
)
@option(
    QUESTION,
    "--least-clearance",
    is_flag=True,
    help="Ask how near bodies come to each other as they move, the nearest pair first.",
)
@option(
    QUESTION,
    "--within",
    type=Finite(0.0),
    metavar="R",
    help="With --least-clearance: leave out pairs proven further apart than R, in mesh units "
    "[default: all pairs].",
)
@option(
    QUESTION,
    "--at-least",
    type=Finite(0.0),
    metavar="D",
    help="With --least-clearance: ask only whether each two never come nearer than D, in mesh "
    "units [default: ask how near].",
)
@option(QUESTION, "--explain", is_flag=True, help="Say what of each body was used.")
@option(
    QUESTION,
    "--exit-code",
    is_flag=True,
    help="Exit with 1 where bodies touch (with --overlaps: overlap; --at-least: come nearer), 0 "
    "where proven apart, 4 where only sampled so.",
)
@option(
    "Motion",
    "--duration",
    type=Finite(0),
    metavar="T",
    help="Ask about 0 <= t <= T, in s [default: as the file says].",
)
@sag_option
@accuracy_options
@verify_option
@common_options()
def command(file: str, common: CommonOptions, accuracy: AccuracyOptions, **flags: Any) -> int:
    """When do which of many moving bodies first touch, where, and with which triangles?

    SCENE is a TOML or JSON file that names meshes, where they are and how they move; - stands for
    standard input. It may be a mesh file too, all parts of which are asked about at rest. What is
    given here overrides what it says. Ctrl-C prints what is known by then.
    """
    wanted = Wanted(*(flags[name] for name in Wanted._fields))
    refuse_contradictions(wanted)
    if wanted.overlaps:
        from obbcli.cli.scene_overlaps import refuse_of_overlaps

        refuse_of_overlaps(accuracy, flags["duration"])
    if wanted.least_clearance:
        from obbcli.cli.scene_clearances import refuse_of_clearances

        refuse_of_clearances(accuracy)
    scene, source, stamps = read_scene(
        file, accuracy, flags["duration"], checked_sag(flags["sag"]), verify=not flags["no_verify"]
    )
    _refuse_of_scene(wanted, scene)
    keep_inputs(common.output, (file, *stamps))
    if wanted.overlaps:
        from obbcli.cli.scene_overlaps import answer_overlaps, overlaps_of

        overlaps = overlaps_of(scene, _pairs(scene, wanted), wanted.tolerance, wanted.touch)
        return answer_overlaps(
            overlaps, scene, source, stamps, common, exit_code=flags["exit_code"]
        )
    if wanted.least_clearance:
        from obbcli.cli.scene_clearances import Setting, answer_clearances, clearances_of

        clearances = clearances_of(scene, _pairs(scene, wanted), wanted)
        setting = Setting(scene, source, stamps, common, explains=flags["explain"])
        return answer_clearances(clearances, setting, wanted.limit, exit_code=flags["exit_code"])
    found = _ask(scene, wanted)
    answer = _run(found, wanted, progress=common.shows_progress)
    # Hashes cost time, and only a document shows them.
    record = _record(source, scene, found, answer, stamps if common.json else None)
    _show(record, common, explains=flags["explain"])
    return _exit_code(record["result"], asked=flags["exit_code"])


def _refuse_of_scene(wanted: Wanted, scene: Scene) -> None:
    """Refuse what does not go together with what the scene's file says."""
    if wanted.all_contacts and scene.solid:
        fault = "lists triangles that meet, and the scene asks about solids"
        raise UsageError("--all-contacts", fault, "leave out it, or solid = true in the scene")
    if wanted.all_contacts and scene.accuracy.method == "sampled":
        fault = "lists contacts of triangles, and sampling finds the first contact alone"
        raise UsageError("--all-contacts", fault, "ask for --method certified")


def _pairs(scene: Scene, wanted: Wanted) -> list[tuple[str, str]] | None:
    """Return the pairs that are asked about, by name; None: all."""
    names = {body.name for body in scene.bodies}
    return [_pair(text, names) for text in wanted.pairs] or None


def _ask(scene: Scene, wanted: Wanted) -> ContactStream:
    """Return the question, not yet advanced."""
    pairs = _pairs(scene, wanted)
    try:
        if wanted.all_contacts:
            return scene.contacts(wanted.limit, pairs)
        return scene.first_contacts(wanted.first, pairs, wanted.solid or None, wanted.threads)
    except SceneError as fault:
        # What is typed is usage.
        raise UsageError(f"--{fault.where}", fault.fault, fault.remedy) from fault


def _pair(text: str, names: set[str]) -> tuple[str, str]:
    """Return the two names in a word. Names may have commas."""
    parts = text.split(",")
    ways = [(",".join(parts[:k]), ",".join(parts[k:])) for k in range(1, len(parts))]
    known = [way for way in ways if names.issuperset(way)] or ways
    if len(known) != 1:
        fault = "names no two bodies" if not ways else "can be read in several ways"
        raise UsageError(f"--pairs {text}", fault, "write --pairs A,B")
    return known[0]


def _run(found: ContactStream, wanted: Wanted, *, progress: bool) -> Answer:
    """Return the answer; after Ctrl-C what is known by then."""
    from obbcli.answers.status import Status
    from obbcli.report.scene import Answer

    contacts: list[SceneContact] = []
    known = 0
    is_interrupted = False
    with proving(found.asked.duration, "all known before", wanted=progress) as show:
        while not found.is_finished and (wanted.limit is None or known < wanted.limit):
            try:
                one = found.advance()
                show(found.time)
            except KeyboardInterrupt:
                if is_interrupted:
                    raise
                is_interrupted = True
                found.stop()
                continue
            if one is not None:
                contacts.append(one)
                known += one.status is not Status.UNRESOLVED
    is_cut = (wanted.limit is not None and known == wanted.limit) or (wanted.first and known > 0)
    is_open = any(one.status is Status.UNRESOLVED for one in contacts)
    return Answer(contacts, found.stats, not (is_cut or is_open), is_interrupted)


def _record(
    source: Source,
    scene: Scene,
    found: ContactStream,
    answer: Answer,
    stamps: Stamps | None,
) -> Record:
    """Return the record of an answer, with hashes where there are stamps to hold them against.

    Raises:
        ObbError: a body's file is not what it was when the scene was read.
    """
    from obbcli.report.scene import scene_record

    asked = found.asked
    meshes = mesh_sources(source, scene, asked, found.stats, stamps)
    is_hashed = stamps is not None
    record = scene_record(source, meshes, asked, scene.ignore, answer, with_motion=is_hashed)
    record["stats"] |= decoded(scene)
    return record


def _show(record: Record, common: CommonOptions, *, explains: bool) -> None:
    """Write the answer."""
    from obbcli.report.scene import explained_tables, scene_bare, scene_tables

    emit(record, explained_tables if explains else scene_tables, common, bare=scene_bare)
    result = record["result"]
    if result["interrupted"]:
        tell_interrupted(f"unresolved pairs: {len(result['unresolved'])}", common)


def _exit_code(result: Record, *, asked: bool) -> int:
    if result["interrupted"]:
        return ExitCode.INTERRUPTED
    is_separated = result["status"] == "separated"
    if result["unresolved"] or (asked and is_separated and result["approximate"]):
        return ExitCode.UNRESOLVED
    return ExitCode.CONTACT if asked and not is_separated else ExitCode.ANSWERED
