"""`obbtree view`: pictures of a tree's boxes, and of two bodies at their first contact."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from obbcli.cli.boundary import OutputError, UsageError, writing
from obbcli.cli.inputs import keep_inputs, read
from obbcli.cli.options.option import Command, option
from obbcli.cli.options.two_bodies import (
    QUESTION,
    about_two,
    exit_code,
    naming_options,
    run,
    with_load_time,
)
from obbcli.cli.output import emit, require_free
from obbcli.cli.picture import GHOSTS, LEVEL, SIZE, view_options
from obbcli.errors import ObbError
from obbcli.files import write_whole

if TYPE_CHECKING:
    from obbcli.cli.inputs import Input
    from obbcli.cli.options.two_bodies import TwoBodyOptions
    from obbcli.cli.picture import ViewOptions
    from obbcli.report.record import Record
    from obbcli.report.view import Output
    from obbcli.view.picture import Picture

_FORMATS = (".glb", ".html", ".png")
_NAMED = ".glb, .html or .png"
_MOST_GHOSTS, _MOST_PIXELS = 100, 8192
# Closer, a step of depth is wider than a pixel, and what hides what is no longer seen.
_MOST_ZOOM = 1_000_000


@click.command(
    "view",
    cls=Command,
    short_help="Pictures: boxes of a tree, or a first contact.",
    epilog="""\b
Examples:
  obbtree view gear.stl --level 4 -o boxes.png
  obbtree view gear.obbt --node 17 -o boxes.html
  obbtree view gear.stl pinion.stl --omega 0 0 3 -o contact.png --zoom 4
  obbtree view gear.stl pinion.stl --translate-b -0.5 0 0 --overlap -o overlap.html
  obbtree view arm.stl shelf.obj --vel 0 0 -50 --duration 3 -o contact.glb --ghosts 8
""",
)
@option(QUESTION, "--solid", is_flag=True, help="A body inside another is contact too.")
@view_options
@about_two(
    "Exit with 1 where they touch, 0 where proven apart, 4 where only sampled so.",
    f"Draw into FILE, which is required: {_NAMED}.",
    is_b_required=False,
    takes_dash=False,
)
def command(asked: TwoBodyOptions, how: ViewOptions, solid: bool) -> int:
    """Draw the boxes of A's tree over its mesh, or A and B as they move and first touch.

    A .png is painted without a display, a .html is one file that turns under the mouse and opens
    offline, a .glb is for other viewers. Of two bodies it shows the start and the way there
    faintly, both where they touch, the point, the normal from A to B and the two triangles; where
    they do not touch, the end. The answer goes to standard output, as first-contact has it. With
    --overlap it shows what both solids share at t = 0, and answers as overlap does.
    """
    target = _target(asked, how)
    if not asked.b:
        _refuse_questions(asked, how, solid=solid)
        record = _draw_boxes(asked, how, target)
        code = 0
    elif how.overlap:
        record, code = _draw_overlap(asked, how, target, solid=solid)
    else:
        record = _draw_contact(asked, how, target, solid=solid)
        code = exit_code(record["result"], asked=asked.exit_code)
    from obbcli.report.view import view_bare, view_tables

    emit(record, view_tables, asked.common._replace(output=None), bare=view_bare)
    return code


def _target(asked: TwoBodyOptions, how: ViewOptions) -> Path:
    """Return where the picture goes, once it is known that it can be drawn there.

    Raises:
        UsageError: no such picture is drawn.
        OutputError: it may not be written.
    """
    target = asked.common.output
    if target is None:
        raise UsageError("-o", f"is needed: a picture is a {_NAMED} file", "add -o FILE")
    suffix = target.suffix.lower()
    if suffix not in _FORMATS:
        raise UsageError(f"-o {target}", f"is no {_NAMED} file", "name one that is")
    for name, value in (("--zoom", how.zoom), ("--size", how.size)):
        if value is not None and suffix != ".png":
            raise UsageError(name, f"has no meaning for a {suffix} file", "leave it out")
    _check_look(how, suffix)
    keep_inputs(target, (asked.a, asked.b))
    require_free(target, force=how.force)
    if not target.resolve().parent.is_dir():
        fault = "cannot be written: its folder is not there"
        raise OutputError(str(target), fault, "create it first")
    return target


def _check_look(how: ViewOptions, suffix: str) -> None:
    """Refuse numbers that no picture is made with."""
    if how.view_from is not None and suffix == ".glb":
        raise UsageError("--from", "has no meaning for a .glb file", "leave it out")
    if how.view_from is not None and not any(how.view_from):
        raise UsageError("--from", "is no direction", "let a number differ from 0")
    if max(how.size or SIZE) > _MOST_PIXELS:
        raise UsageError("--size", f"is beyond {_MOST_PIXELS} pixels", "take less")
    if how.ghosts is not None and how.ghosts > _MOST_GHOSTS:
        raise UsageError("--ghosts", f"is beyond {_MOST_GHOSTS}", "take less")
    if how.zoom is not None and how.zoom > _MOST_ZOOM:
        raise UsageError("--zoom", f"is beyond {_MOST_ZOOM:,}", "take less")


def _refuse_questions(asked: TwoBodyOptions, how: ViewOptions, *, solid: bool) -> None:
    """Refuse what is asked about two bodies where there is one."""
    given = asked.pose._asdict() | asked.motion._asdict() | asked.accuracy._asdict()
    given |= {"solid": solid, "exit_code": asked.exit_code, "ghosts": how.ghosts}
    given["overlap"] = how.overlap
    given |= {"scale_b": asked.units.scale_b}
    for name, value in given.items():
        if value not in (None, False):
            fault = "is about two bodies, and there is no B"
            raise UsageError(f"--{name.replace('_', '-')}", fault, "name B, or leave it out")
    if how.level is not None and how.node is not None:
        raise UsageError("--node", "cannot be drawn together with --level", "leave one out")


def _draw_boxes(asked: TwoBodyOptions, how: ViewOptions, target: Path) -> Record:
    """Draw the boxes of a tree and return the record."""
    common = asked.common
    file = read(
        asked.a,
        asked.units.of_a(),
        verify=not asked.no_verify,
        hashed=common.json,
        progress=common.shows_progress,
    )
    from obbcli.report.view import Choice, boxes_record
    from obbcli.view.boxes import boxes_of_level, last_boxes_under, tree_picture

    start = time.perf_counter()
    if how.node is not None:
        choice, boxes = Choice(None, how.node), last_boxes_under(file.tree, how.node)
        words = f"the last boxes under node {how.node}"
    else:
        level = LEVEL if how.level is None else how.level
        boxes = boxes_of_level(file.tree, level, or_last=how.level is None)
        level = int(boxes.depths[0])
        choice, words = Choice(level, None), f"boxes of level {level}"
    title = f"{_base(file)}: {words}"
    picture = tree_picture(file.tree, boxes, title)
    output = _write(picture, [title, f"{len(boxes.nodes)} boxes, colored by depth"], how, target)
    times = {"draw": time.perf_counter() - start}
    record = boxes_record(file.source(with_sha256=common.json), output, choice, boxes, times)
    return with_load_time(record, [file])


def _draw_contact(asked: TwoBodyOptions, how: ViewOptions, target: Path, *, solid: bool) -> Record:
    """Ask for the first contact, draw it and return the record."""
    for name, value in (("--level", how.level), ("--node", how.node)):
        if value is not None:
            raise UsageError(name, "is about the boxes of one tree", "leave it or B out")
    question = asked.question()
    files = asked.read()
    with naming_options(question):
        from obbcli.questions.query import Query

        pair = question.pair(files)
        query = Query.about(pair, solid=solid)
        answer = run(query, pair.accuracy, progress=asked.common.shows_progress)
        setting = asked.setting(files, pair, solid)
    from obbcli.report.view import contact_record
    from obbcli.view.contact import contact_picture, moment_of

    start = time.perf_counter()
    ghosts = GHOSTS if how.ghosts is None else how.ghosts
    moment = moment_of(pair.bodies, answer, pair.duration, ghosts)
    a, b = (_base(file) for file in files)
    title = f"{a} and {b}: {answer.status.value}, t = {moment.time:.6g} s"
    picture = contact_picture(pair.bodies, answer, moment, title, how.zoom or 1.0)
    output = _write(picture, [title, f"blue: A, {a}", f"orange: B, {b}"], how, target)
    record = contact_record(setting, answer, output, moment)
    record["stats"]["seconds"]["draw"] = time.perf_counter() - start
    return with_load_time(record, files)


def _draw_overlap(
    asked: TwoBodyOptions, how: ViewOptions, target: Path, *, solid: bool
) -> tuple[Record, int]:
    """Ask how two solids overlap, draw what they share; return the record and the exit code."""
    from obbcli.cli.commands.overlap import overlap_exit_code, refuse_what_says_nothing
    from obbcli.cli.shared_mesh import require_solids
    from obbcli.view.shared_solid import require_package, shared_solid

    refuse_what_says_nothing(asked)
    meaningless = {"solid": solid, "ghosts": how.ghosts, "level": how.level, "node": how.node}
    for name, value in meaningless.items():
        if value not in (None, False):
            raise UsageError(f"--{name}", "has no meaning with --overlap", "leave it out")
    require_package("--overlap")
    question = asked.question()
    files = asked.read()
    with naming_options(question):
        from obbcli.questions.overlap.asked import Asked
        from obbcli.questions.overlap.overlap import overlap_of

        pair = question.pair(files)
        require_solids(pair)
        answer = overlap_of(pair, Asked())
        setting = asked.setting(files, pair)
    from obbcli.report.view import overlap_view_record
    from obbcli.view.overlap import overlap_picture

    start = time.perf_counter()
    shared = shared_solid(pair.bodies)
    a, b = (_base(file) for file in files)
    title = f"{a} and {b}: {answer.relation}"
    picture = overlap_picture(pair.bodies, shared if len(shared.triangles) else None, title)
    legend = [title, f"blue: A, {a}", f"orange: B, {b}", _shared_words(len(shared.triangles))]
    output = _write(picture, legend, how, target)
    record = overlap_view_record(setting, answer, output, shared)
    record["stats"]["seconds"]["draw"] = time.perf_counter() - start
    return with_load_time(record, files), overlap_exit_code(record["result"], asked=asked.exit_code)


def _shared_words(triangle_count: int) -> str:
    return "red: what both share, not proven" if triangle_count else "they share no solid"


def _base(file: Input) -> str:
    return Path(file.name).name


def _write(picture: Picture, legend: list[str], how: ViewOptions, target: Path) -> Output:
    """Draw a picture into its file, whole or not at all."""
    from obbcli.report.view import Output
    from obbcli.view.picture import seen_from

    if how.view_from is not None:
        picture = seen_from(picture, how.view_from)
    kind = target.suffix.lower().removeprefix(".")
    size = (how.size or SIZE) if kind == "png" else None
    try:
        data = _bytes(picture, legend, kind, size or SIZE, how.zoom or 1.0)
    except ObbError as fault:
        raise ObbError(str(target), fault.fault, fault.remedy) from fault
    with writing(target):
        write_whole(target, data)
    return Output(str(target), kind, len(data), size)


def _bytes(
    picture: Picture, legend: list[str], kind: str, size: tuple[int, int], zoom: float
) -> bytes:
    if kind == "png":
        from obbcli.view.png import png_bytes

        return png_bytes(picture, size, zoom)
    if kind == "html":
        from obbcli.view.html import html_page

        return html_page(picture, legend)
    from obbcli.view.gltf import glb_bytes

    return glb_bytes(picture)
