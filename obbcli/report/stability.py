"""The record of `obbtree stability` and its tables."""

from __future__ import annotations

from collections import Counter
from dataclasses import fields
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from obbcli.answers.distance import Distance
from obbcli.answers.overlap import Overlap
from obbcli.report.contacts import contact_part
from obbcli.report.overlap import (
    bracket,
    depth_rows,
    distance_rows,
    overlap_part,
    relation_words,
)
from obbcli.report.record import document, finite
from obbcli.report.rows import part_rows, source_rows
from obbcli.report.table import Table, count, seconds
from obbcli.study.asks import ASKS
from obbcli.study.stability.rows import RestRow

if TYPE_CHECKING:
    from collections.abc import Sequence

    from obbcli.answers.contact import FirstContact
    from obbcli.report.record import Record, Setting, Source
    from obbcli.study.asks import Ask
    from obbcli.study.stability.rows import Row, Stability

    Answered: TypeAlias = FirstContact | Distance | Overlap

_OUTCOMES = ("same", "agrees", "within bound", "unresolved", "refused", "broken")
_COLUMNS = ("changed", "tried", "same bits", "agree", "in bound", "open", "refused", "broken")


class Studied(NamedTuple):
    """How a study went.

    Attributes:
        stability: what came out.
        planned: how many extremes there were to try.
        is_interrupted: whether Ctrl-C ended it.
        seconds: s of wall time.
    """

    stability: Stability
    planned: int
    is_interrupted: bool
    seconds: float


def stability_record(setting: Setting, studied: Studied, ask: Ask = ASKS[0]) -> Record:
    """Return the record of a study.

    Args:
        setting: what was asked about.
        studied: what came out.
        ask: which question.
    """
    answer, rows = studied.stability.answer, studied.stability.rows
    a, b = setting.sources
    result = {
        # What documents of earlier versions did not say is no key where they say the same.
        **({} if ask == ASKS[0] else {"ask": ask}),
        "answer": answer_part(answer, setting.sources),
        "extreme_count": studied.planned,
        "tried_count": len(rows),
        "broken_count": len(studied.stability.broken),
        "interrupted": studied.is_interrupted,
        "families": _families(rows),
        "rows": [_row_part(row) for row in rows],
    }
    return document(
        "stability",
        {"a": a.part(), "b": b.part()},
        motion=setting.motion,
        accuracy=setting.accuracy.as_dict(),
        result=result,
        stats={"seconds": {"total": studied.seconds}},
    )


def _row_part(row: Row) -> Record:
    values: Record = {field.name: getattr(row, field.name) for field in fields(row)}
    values["magnitude"] = finite(row.magnitude)
    values["bound"] = finite(row.bound)
    values["status"] = None if row.status is None else row.status.value
    if isinstance(row, RestRow):
        values["bounds"] = {name: list(bounds) for name, bounds in row.bounds.items()}
    return values


def answer_part(answer: Answered, sources: Sequence[Source]) -> Record:
    """Return what is said of the answer that a study is about."""
    if isinstance(answer, Overlap):
        return overlap_part(answer)
    if isinstance(answer, Distance):
        return {
            "distance": answer.distance,
            "bounds": list(answer.bounds),
            # A study goes on from whatever bounds there are.
            "complete": True,
        }
    return contact_part(answer, sources)


def answer_rows(answer: Record) -> list[tuple[str, str]]:
    """Return the rows of a table that say what the answer is that a study is about."""
    if "relation" in answer:
        return [("answer", relation_words(answer)), *distance_rows(answer), *depth_rows(answer)]
    if "complete" in answer:
        return [("answer", f"distance {bracket(answer['bounds'])}")]
    time = "" if answer["time"] is None else f", t = {answer['time']!r} s"
    return [("answer", f"{answer['status']}{time}"), *part_rows(answer)]


def _families(rows: Sequence[Row]) -> list[Record]:
    """Return what became of each family, and where it first gave other bits."""
    families: dict[str, list[Row]] = {}
    for row in rows:
        families.setdefault(row.family, []).append(row)
    parts = []
    for family, tried in families.items():
        tally = Counter[str](row.outcome for row in tried)
        changed = next((row for row in tried if row.outcome != "same"), None)
        parts.append(
            {
                "family": family,
                "tried_count": len(tried),
                "outcomes": {name: tally[name] for name in _OUTCOMES},
                "same_bits_end_at": None if changed is None else changed.extreme,
                "why": None if changed is None else changed.reason,
            }
        )
    return parts


def stability_tables(record: Record) -> list[Table]:
    """Return the tables of a record: the answer, the families, where bits change, what broke."""
    result = record["result"]
    answer, families = result["answer"], result["families"]
    cut = " (interrupted)" if result["interrupted"] else ""
    heads = [
        *source_rows(record),
        *answer_rows(answer),
        ("extremes", f"{count(result['tried_count'])} of {count(result['extreme_count'])}{cut}"),
        ("broken", count(result["broken_count"])),
        ("time", seconds(record["stats"]["seconds"]["total"])),
    ]
    tables = [Table(heads)]
    if families:
        rows = [
            (
                part["family"],
                count(part["tried_count"]),
                *(
                    count(part["outcomes"][name]) if part["outcomes"][name] else ""
                    for name in _OUTCOMES
                ),
            )
            for part in families
        ]
        tables.append(Table(rows, _COLUMNS))
    ends = [
        (part["family"], f"{part['same_bits_end_at']}: {part['why']}")
        for part in families
        if part["same_bits_end_at"] is not None and part["why"]
    ]
    if ends:
        tables.append(Table(ends, title="where the bits of the answer first change, and why"))
    broken = [row for row in result["rows"] if not row["held"]]
    if broken:
        lines = [(f"{row['family']}, {row['extreme']}", row["reason"]) for row in broken]
        tables.append(Table(lines, title="BROKEN: what ought to hold and does not"))
    return tables


def stability_bare(record: Record) -> str:
    """Return how many extremes held and how many did not."""
    result = record["result"]
    broken = result["broken_count"]
    return f"held {result['tried_count'] - broken}\nbroken {broken}\n"
