"""The record of `obbtree view` and its tables: what was drawn, and of a contact the answer."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from obbcli.questions.overlap.asked import Asked
from obbcli.report.contacts import contact_part
from obbcli.report.first_contact import first_contact_bare, first_contact_tables
from obbcli.report.overlap import overlap_bare, overlap_record, overlap_tables
from obbcli.report.record import answer_document, document, seconds_part
from obbcli.report.rows import source_rows
from obbcli.report.shared_mesh import drawn_rows, solid_part
from obbcli.report.table import Table, count, seconds

if TYPE_CHECKING:
    from collections.abc import Mapping

    from obbcli.answers.contact import FirstContact
    from obbcli.answers.overlap import Overlap
    from obbcli.report.record import Record, Setting, Source
    from obbcli.view.boxes import Boxes
    from obbcli.view.contact import Moment
    from obbcli.view.shared_solid import SharedSolid


class Output(NamedTuple):
    """The file of a picture.

    Attributes:
        file: its path, as the user wrote it.
        format: `png`, `html` or `glb`.
        byte_count: its size.
        size: width and height in pixels; None where the format has none.
    """

    file: str
    format: str
    byte_count: int
    size: tuple[int, int] | None

    def part(self) -> Record:
        """Return what a record says of it."""
        width, height = self.size or (None, None)
        return self._asdict() | {"size": None if width is None else [width, height]}


class Choice(NamedTuple):
    """Which boxes were asked for.

    Attributes:
        level: all at this depth; None where it was not asked for.
        node: the last box above each triangle under this one; None where it was not
            asked for.
    """

    level: int | None
    node: int | None


def boxes_record(
    source: Source, output: Output, choice: Choice, boxes: Boxes, times: Mapping[str, float]
) -> Record:
    """Return the record of a tree's picture.

    Args:
        source: the mesh or tree file.
        output: where it was drawn.
        choice: which boxes.
        boxes: what they are.
        times: s of wall time by stage.
    """
    depths = boxes.depths.tolist()
    drawn = output.part() | {
        "what": "boxes",
        **choice._asdict(),
        "triangle_count": source.triangle_count,
        "box_count": len(depths),
        "depths": [
            {"depth": depth, "box_count": depths.count(depth)} for depth in sorted(set(depths))
        ],
        "nodes": boxes.nodes.tolist(),
    }
    stats = {"seconds": seconds_part(times)}
    return document("view", {"a": source.part()}, result={"drawn": drawn}, stats=stats)


def contact_record(
    setting: Setting, answer: FirstContact, output: Output, moment: Moment
) -> Record:
    """Return the record of a contact's picture: the answer, as `first-contact` has it, and more.

    Args:
        setting: what was asked.
        answer: what came out.
        output: where it was drawn.
        moment: what was drawn of it.
    """
    drawn = output.part() | {
        "what": "contact",
        "time": moment.time,
        "ghost_times": moment.ghost_times,
        "ghosts_of": [name.lower() for name in moment.moving],
        "marks": marks_of(answer),
    }
    result = contact_part(answer, setting.sources) | {"drawn": drawn}
    return answer_document("view", setting, result, answer.stats)


def overlap_view_record(
    setting: Setting, answer: Overlap, output: Output, solid: SharedSolid
) -> Record:
    """Return the record of an overlap's picture: the answer, as `overlap` has it, and more.

    Args:
        setting: what was asked.
        answer: what came out.
        output: where it was drawn.
        solid: what was drawn in full.
    """
    record = overlap_record(setting, Asked(), answer, "view")
    drawn = output.part() | {"what": "overlap", **solid_part(solid, answer.volume)}
    record["result"]["drawn"] = drawn
    return record


def marks_of(answer: FirstContact) -> list[str]:
    """Return which fields of an answer are marked in its picture."""
    names = ("point", "normal", "triangle_a", "triangle_b")
    marked = answer.point is not None
    return [n for n in names if getattr(answer, n) is not None and (marked or n[0] == "t")]


def view_tables(record: Record) -> list[Table]:
    """Return the tables of a record."""
    drawn = record["result"]["drawn"]
    if drawn["what"] == "contact":
        answer = first_contact_tables(record)
        return [*answer, Table([*_contact_rows(drawn), _file_row(drawn)])]
    if drawn["what"] == "overlap":
        return [*overlap_tables(record), Table([*drawn_rows(drawn), _file_row(drawn)])]
    where = f"under node {drawn['node']}" if drawn["level"] is None else "of the tree"
    per_depth = ", ".join(f"{count(d['box_count'])} at {d['depth']}" for d in drawn["depths"])
    times = ", ".join(f"{k} {seconds(v)}" for k, v in record["stats"]["seconds"].items())
    rows = [
        *source_rows(record),
        ("boxes", f"{count(drawn['box_count'])} {where}"),
        ("levels", per_depth),
        _file_row(drawn),
        ("time", times),
    ]
    return [Table(rows)]


def view_bare(record: Record) -> str:
    """Return the status and time of a contact, a relation, or the number of boxes."""
    drawn = record["result"]["drawn"]
    if drawn["what"] == "overlap":
        return overlap_bare(record)
    if drawn["what"] == "contact":
        return first_contact_bare(record)
    return f"{drawn['box_count']}\n"


def _contact_rows(drawn: Record) -> list[tuple[str, str]]:
    rows = [("drawn", f"A and B at t = {drawn['time']!r} s")]
    ghosts = len(drawn["ghost_times"])
    if ghosts:
        bodies = " and ".join(name.upper() for name in drawn["ghosts_of"])
        rows.append(("faintly", f"{bodies} at t = 0 and {ghosts - 1} times on the way"))
    if drawn["marks"]:
        rows.append(("marked", ", ".join(name.replace("_", " ") for name in drawn["marks"])))
    return rows


def _file_row(drawn: Record) -> tuple[str, str]:
    pixels = "" if drawn["size"] is None else " ({} x {} pixels)".format(*drawn["size"])
    return "picture", f"{drawn['file']}{pixels}"
