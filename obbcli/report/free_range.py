"""The record of `obbtree range` and its table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.report.contacts import contact_part
from obbcli.report.record import answer_document
from obbcli.report.rows import cost_rows, source_rows
from obbcli.report.table import Table

if TYPE_CHECKING:
    from obbcli.answers.free_range import FreeRange
    from obbcli.report.record import Record, Setting


def range_record(setting: Setting, answer: FreeRange) -> Record:
    """Return the record of a question.

    Args:
        setting: what was asked about.
        answer: what came out.
    """
    result = {
        "free": None if answer.free is None else list(answer.free),
        "complete": answer.complete,
        "before": contact_part(answer.before, setting.sources),
        "after": contact_part(answer.after, setting.sources),
    }
    return answer_document("range", setting, result, answer.stats)


def range_tables(record: Record) -> list[Table]:
    """Return the table of a record."""
    result = record["result"]
    rows = [*source_rows(record), ("answer", _sentence(result))]
    if result["free"] is not None:
        rows += [(name, _stop(result[name])) for name in ("before", "after")]
    return [Table([*rows, *cost_rows(record["stats"])])]


def range_bare(record: Record) -> str:
    """Return both ends of the free interval, or a word where there is none."""
    free = record["result"]["free"]
    return "none\n" if free is None else f"{free[0]!r} {free[1]!r}\n"


def _sentence(result: Record) -> str:
    if result["free"] is None:
        return "in contact at t = 0"
    low, high = result["free"]
    least = "" if result["complete"] else "; a limit was reached, there may be more"
    return f"free from t = {low!r} to {high!r} s{least}"


def _stop(stop: Record) -> str:
    """Return what ends the free interval on one side."""
    if stop["status"] == "separated":
        return "nothing stops them"
    if stop["status"] == "unresolved":
        return "not known what stops them"
    if stop["triangle_a"] is None:
        return "they touch"
    return f"triangle {stop['triangle_a']} of A meets {stop['triangle_b']} of B"
