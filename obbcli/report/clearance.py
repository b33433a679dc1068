"""The record of `obbtree clearance` and its table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.report.contacts import contact_part
from obbcli.report.overlap import bracket, plain
from obbcli.report.record import answer_document, part_names
from obbcli.report.rows import cost_rows, part_rows, source_rows
from obbcli.report.table import Table, length, point

if TYPE_CHECKING:
    from collections.abc import Sequence

    from obbcli.answers.clearance import Clearance, CurvePiece
    from obbcli.questions.clearance.asked import Asked
    from obbcli.report.record import Record, Setting, Source

# Stretches of time that a table lists.
_MOST_STRETCHES = 3
_CURVE_COLUMNS = ("from (s)", "to (s)", "least distance", "at (s)")


def clearance_record(setting: Setting, asked: Asked, answer: Clearance) -> Record:
    """Return the record of a question.

    Args:
        setting: what was asked about.
        asked: what was asked.
        answer: what came out.
    """
    result = clearance_part(answer, setting.sources)
    record = answer_document("clearance", setting, result, answer.stats)
    tail = {name: record.pop(name) for name in ("result", "stats")}
    return record | {"asked": {"tolerance": asked.tolerance, "at_least": asked.at_least}} | tail


def clearance_part(answer: Clearance, sources: Sequence[Source]) -> Record:
    """Return what documents say of an answer: its fields, less what it cost."""
    minimum = plain(answer.minimum)
    for name in ("part_a", "part_b"):
        minimum.pop(name, None)
    contact = answer.first_contact
    return {
        "minimum": minimum | part_names(answer.minimum, sources),
        "maximum": plain(answer.maximum),
        "curve": _curve(answer.curve),
        "at_least": plain(answer.at_least),
        "first_contact": None if contact is None else contact_part(contact, sources),
        "complete": answer.complete,
    }


def _curve(pieces: tuple[CurvePiece, ...] | None) -> list[Record] | None:
    if pieces is None:
        return None
    return [
        {"from": one.start, "to": one.end, "bounds": list(one.bounds), "time": one.time}
        for one in pieces
    ]


def clearance_tables(record: Record) -> list[Table]:
    """Return the table of a record."""
    result = record["result"]
    least = result["minimum"]
    rows = [*source_rows(record), *_verdict_rows(result), ("answer", _sentence(record))]
    if least["bounds"] != [0, 0]:
        rows.append(("least distance", bracket(least["bounds"])))
    if least["time"] is not None:
        rows += [("at", f"t = {least['time']!r} s"), *_when_rows(record)]
    if least["point_a"] is not None:
        rows += [("point of A", point(least["point_a"])), ("point of B", point(least["point_b"]))]
    if least["triangle_a"] is not None:
        rows.append(("triangles", f"{least['triangle_a']} of A and {least['triangle_b']} of B"))
    most = result["maximum"]
    if most is not None:
        rows.append(("greatest distance", f"{bracket(most['bounds'])}, at t = {most['time']!r} s"))
    table = Table([*rows, *part_rows(least), *cost_rows(record["stats"])])
    return [table] if result["curve"] is None else [table, _curve_table(result["curve"])]


def _curve_table(pieces: list[Record]) -> Table:
    """Return the table of a curve, a row an interval."""
    rows = [
        (
            f"{one['from']:.6g}",
            f"{one['to']:.6g}",
            bracket(one["bounds"]),
            "" if one["time"] is None else f"{one['time']:.6g}",
        )
        for one in pieces
    ]
    return Table(rows, _CURVE_COLUMNS, "least distance, interval by interval")


def clearance_bare(record: Record) -> str:
    """Return the verdict where one was asked for, else the upper end of the bracket."""
    result = record["result"]
    if result["at_least"] is not None:
        return f"{result['at_least']['verdict']}\n"
    high = result["minimum"]["bounds"][1]
    return f"{'unknown' if high is None else repr(high)}\n"


def _verdict_rows(result: Record) -> list[tuple[str, str]]:
    held = result["at_least"]
    if held is None:
        return []
    words = {"holds": "holds, proven", "open": "open: neither is proven"}
    said = words.get(held["verdict"]) or f"violated at t = {held['time']!r} s"
    return [(f"at least {length(held['distance'])}", said)]


def _sentence(record: Record) -> str:
    result = record["result"]
    contact = result["first_contact"]
    if contact is not None:
        if contact["contained"] is not None:
            return "one body is inside the other"
        time = contact["time"]
        return "in contact at t = 0" if time == 0 else f"first contact at t = {time!r} s"
    low, high = result["minimum"]["bounds"]
    if high == 0:
        return "they touch; a limit was reached before it was known when first"
    if not result["complete"]:
        return "a limit was reached: the bracket is wider than asked for"
    if low == 0 and record["asked"]["at_least"] is None:
        return "as near as rounding can tell; whether they touch is not known"
    if result["at_least"] is not None:
        return "asked no further than that"
    return "apart at all times"


def _when_rows(record: Record) -> list[tuple[str, str]]:
    """Return the row that says outside of which times the bodies are proven further apart."""
    result, duration = record["result"], record["motion"]["duration"]
    stretches = result["minimum"]["when"]
    is_whole = result["complete"] and result["at_least"] is None
    if result["first_contact"] is not None or not duration or not is_whole:
        return []
    if stretches == [[0, duration]]:
        return [("as near", "maybe at any other time")]
    shown = ", ".join(f"{low:.6g} to {high:.6g} s" for low, high in stretches[:_MOST_STRETCHES])
    more = len(stretches) - _MOST_STRETCHES
    tail = f" and {more:,} more" if more > 0 else ""
    return [("as near", f"at most at t = {shown}{tail}")]
