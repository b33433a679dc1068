"""The record of `obbtree collide` and its table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.answers.status import Status
from obbcli.report.record import answer_document, part_names
from obbcli.report.rows import (
    as_sampled,
    contained_rows,
    cost_rows,
    part_rows,
    source_rows,
    why_open,
)
from obbcli.report.table import Table, count, length

if TYPE_CHECKING:
    from numpy import int64
    from numpy.typing import NDArray

    from obbcli.answers.collision import Collision
    from obbcli.report.record import Record, Setting

_SENTENCES = {
    "separated": "no contact",
    "overlap_at_start": "in contact at t = 0",
    "contact": "contact within the duration",
    "unresolved": "{} before the answer was known",
}


def collide_record(
    setting: Setting,
    answer: Collision,
    pairs: tuple[NDArray[int64], bool] | None = None,
) -> Record:
    """Return the record of a question.

    Args:
        setting: what was asked.
        answer: what came out.
        pairs: intersecting pairs of triangles, (N, 2), and whether these are all; None where they
            were not asked for.
    """
    unresolved = answer.status is Status.UNRESOLVED
    result: Record = {
        "status": answer.status.value,
        "collides": None if unresolved else answer.collides,
        "witness": None if answer.witness is None else [int(i) for i in answer.witness],
        "approximate": answer.approximate,
        "error_bound": float(answer.error_bound),
        "contained": answer.contained,
        **part_names(answer, setting.sources),
    }
    if pairs is not None:
        result["pairs"] = pairs[0].tolist()
        result["pairs_complete"] = pairs[1]
    return answer_document("collide", setting, result, answer.stats)


def collide_tables(record: Record) -> list[Table]:
    """Return the tables of a record: the answer, and the pairs where they were asked for."""
    result = record["result"]
    rows = [
        *source_rows(record),
        ("status", result["status"]),
        ("answer", _SENTENCES[result["status"]].format(why_open(record)) + _reservation(record)),
        *contained_rows(result),
    ]
    if result["witness"] is not None:
        of_a, of_b = result["witness"]
        meets = "is within the clearance of" if record["accuracy"]["clearance"] else "meets"
        rows.append(("witness", f"triangle {of_a} of A {meets} triangle {of_b} of B"))
    rows += part_rows(result)
    if "relation" in result:
        from obbcli.report.overlap import depth_rows

        rows += [("relation", result["relation"]), *depth_rows(result)]
    tables = [Table([*rows, *cost_rows(record["stats"])])]
    if "pairs" in result:
        tables.append(_pairs_table(result))
    return tables


def collide_bare(record: Record) -> str:
    """Return the pairs where they were asked for, two numbers a line, else the status word."""
    result = record["result"]
    if "pairs" in result:
        return "".join(f"{i} {j}\n" for i, j in result["pairs"])
    return f"{result['status']}\n"


def _reservation(record: Record) -> str:
    """Return what an approximate answer leaves open."""
    result = record["result"]
    is_separated = result["status"] == "separated"
    if not result["approximate"]:
        return ""
    if record["accuracy"]["method"] == "sampled" and result["status"] != "overlap_at_start":
        return as_sampled(result, by_boxes=result["witness"] is None and not is_separated)
    return f" of boxes: the surfaces are at most {length(result['error_bound'])} apart"


def _pairs_table(result: Record) -> Table:
    pairs = result["pairs"]
    if not pairs:
        return Table([], title="no pairs of triangles intersect")
    cut = "" if result["pairs_complete"] else ", more exist: see --limit"
    title = f"{count(len(pairs))} intersecting pairs of triangles{cut}"
    return Table([(str(i), str(j)) for i, j in pairs], ("triangle of A", "triangle of B"), title)
