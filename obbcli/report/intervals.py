"""The record of `obbtree intervals` and its table."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from obbcli.report.record import answer_document
from obbcli.report.rows import cost_rows, source_rows
from obbcli.report.table import Table, count

if TYPE_CHECKING:
    from collections.abc import Sequence

    from obbcli.answers.contact_piece import ContactPiece
    from obbcli.answers.counts import QueryStats
    from obbcli.report.record import Record, Setting

_COLUMNS = ("piece", "from [s]", "until [s]", "widths [s]")


class Pieces(NamedTuple):
    """Pieces that were found.

    Attributes:
        pieces: in order of time.
        complete_until: s; they say all up to then.
        unresolved_after: s; what was known when a limit of the search was reached. None: none was.
    """

    pieces: Sequence[ContactPiece]
    complete_until: float
    unresolved_after: float | None = None


def intervals_record(setting: Setting, asked: Record, found: Pieces, stats: QueryStats) -> Record:
    """Return the record of a question.

    Args:
        setting: what was asked about.
        asked: `within` and `limit`.
        found: what came out.
        stats: what it cost.
    """
    undecided = [one for one in found.pieces if one.kind == "undecided"]
    result = {
        "pieces": [
            {"kind": one.kind, "start": list(one.start), "end": list(one.end)}
            for one in found.pieces
        ],
        "undecided_count": len(undecided),
        "undecided_total": sum(one.end[1] - one.start[0] for one in undecided),
        "complete_until": found.complete_until,
        "unresolved_after": found.unresolved_after,
    }
    record = answer_document("intervals", setting, result, stats)
    tail = {name: record.pop(name) for name in ("result", "stats")}
    return record | {"asked": asked} | tail


def intervals_tables(record: Record) -> list[Table]:
    """Return the tables of a record."""
    result = record["result"]
    rows = [*source_rows(record), ("answer", _sentence(record))]
    if result["undecided_count"]:
        pieces = count(result["undecided_count"])
        rows.append(("undecided", f"{pieces} of the pieces, {result['undecided_total']!r} s"))
    rows += cost_rows(record["stats"])
    listed = [
        (
            piece["kind"],
            repr(piece["start"][0]),
            repr(piece["end"][1]),
            " ".join(f"{high - low:.2g}" for low, high in (piece["start"], piece["end"])),
        )
        for piece in result["pieces"]
    ]
    return [Table(rows), Table(listed, _COLUMNS, "pieces, earliest first")]


def intervals_bare(record: Record) -> str:
    """Return a line a piece: its kind, where its start's bracket begins, where its end's ends."""
    return "".join(
        f"{piece['kind']} {piece['start'][0]!r} {piece['end'][1]!r}\n"
        for piece in record["result"]["pieces"]
    )


def _sentence(record: Record) -> str:
    result, end = record["result"], record["motion"]["duration"]
    kinds = [piece["kind"] for piece in result["pieces"]]
    if result["unresolved_after"] is not None:
        until = result["complete_until"]
        return f"a limit was reached: complete only before t = {until!r} s"
    if result["complete_until"] < end:
        pieces = "1 piece" if len(kinds) == 1 else f"{count(len(kinds))} pieces"
        return f"{pieces}; more may follow: see --limit"
    if kinds == ["free"]:
        return "free throughout"
    if kinds == ["contact"]:
        return "in contact throughout"
    told = [f"{kinds.count(kind)} {kind}" for kind in dict.fromkeys(kinds)]
    return "pieces: " + ", ".join(told)
