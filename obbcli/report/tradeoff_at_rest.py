"""The record of `obbtree tradeoff --ask distance|overlap` and its tables."""

from __future__ import annotations

import shlex
from dataclasses import asdict
from typing import TYPE_CHECKING, NamedTuple

from obbcli.report.record import document
from obbcli.report.rows import source_rows
from obbcli.report.stability import answer_part, answer_rows
from obbcli.report.table import Table, count, length, seconds

if TYPE_CHECKING:
    from collections.abc import Sequence

    from obbcli.report.record import Record, Setting
    from obbcli.study.tradeoff.at_rest import RestTradeoff, RestTrial

_COLUMNS = ("setting", "width", "time", "quartiles", "on the front")


class RestWording(NamedTuple):
    """What a command line needs besides a setting.

    Attributes:
        names: A and B as they were written.
        words: the options that place them, as they were written.
        max_time: s; the longest time that a setting is wanted for. None: not asked.
    """

    names: tuple[str, str]
    words: Sequence[str]
    max_time: float | None = None

    def command(self, ask: str, options: Sequence[str]) -> str:
        """Return the command line that asks with options."""
        return shlex.join(["obbtree", ask, *self.names, *self.words, *options])


def rest_tradeoff_record(
    setting: Setting, found: RestTradeoff, wording: RestWording, *, is_interrupted: bool
) -> Record:
    """Return the record of a study.

    Args:
        setting: what was asked.
        found: what was measured.
        wording: what command lines are made of.
        is_interrupted: whether Ctrl-C ended it.
    """
    rows = [_row_part(row, found.ask, wording) for row in found.rows]
    result = {
        "ask": found.ask,
        "reference": answer_part(found.reference, setting.sources),
        "rows": rows,
        "unreached": [wording.command(found.ask, words) for words in found.unreached],
        "recommended": _recommended(found, wording),
        "claims_checked": sum(row.claims_checked for row in found.rows),
        "claims_broken": sum(len(row.faults) for row in found.rows),
        "interrupted": is_interrupted,
    }
    a, b = setting.sources
    return document(
        "tradeoff",
        {"a": a.part(), "b": b.part()},
        motion=setting.motion,
        accuracy=setting.accuracy.as_dict(),
        result=result,
        stats={"budget": found.budget, "seconds": {"study": found.seconds}},
    )


def _row_part(row: RestTrial, ask: str, wording: RestWording) -> Record:
    timing = asdict(row.warm)
    timing["interval"] = None if row.warm.interval is None else list(row.warm.interval)
    return {
        "command": wording.command(ask, row.words),
        "options": list(row.words),
        "relation": row.relation,
        "bounds": {name: list(bounds) for name, bounds in row.bounds.items()},
        "width": row.width,
        "claims_checked": row.claims_checked,
        "faults": list(row.faults),
        "warm_seconds": timing,
        "on_front": row.on_front,
    }


def _recommended(found: RestTradeoff, wording: RestWording) -> int | None:
    """Return the row of the narrowest setting that takes no longer than wanted."""
    most = wording.max_time
    fitting = [
        (row.width, row.warm.median, number)
        for number, row in enumerate(found.rows)
        if most is not None and row.width is not None and row.warm.median <= most
    ]
    return min(fitting)[2] if fitting else None


def rest_tradeoff_tables(record: Record) -> list[Table]:
    """Return the tables of a record: the narrowest answer, and what each setting cost."""
    result, stats = record["result"], record["stats"]
    rows = sorted(result["rows"], key=lambda row: row["warm_seconds"]["median"])
    heads = [
        *source_rows(record),
        *answer_rows(result["reference"]),
        ("settings", f"{count(len(rows))}, not reached: {count(len(result['unreached']))}"),
        ("claims", f"{count(result['claims_checked'])} checked, "
                   f"{count(result['claims_broken'])} broken"),
        ("time", f"{seconds(stats['seconds']['study'])} of {seconds(stats['budget'])}"),
    ]  # fmt: skip
    if result["recommended"] is not None:
        heads.append(("recommended", result["rows"][result["recommended"]]["command"]))
    tables = [Table(heads), Table([_cells(row) for row in rows], _COLUMNS)]
    broken = [(row["command"], fault) for row in rows for fault in row["faults"]]
    if broken:
        tables.append(Table(broken, title="BROKEN: claims that the narrowest answer contradicts"))
    return tables


def _cells(row: Record) -> tuple[str, ...]:
    timing = row["warm_seconds"]
    return (
        " ".join(row["options"]) or "the defaults",
        "" if row["width"] is None else length(row["width"]),
        seconds(timing["median"]),
        f"{seconds(timing['low_quartile'])} to {seconds(timing['high_quartile'])}",
        "yes" if row["on_front"] else "",
    )


def rest_tradeoff_bare(record: Record) -> str:
    """Return the recommended command line, or those of the front, fastest first."""
    result = record["result"]
    if result["recommended"] is not None:
        return f"{result['rows'][result['recommended']]['command']}\n"
    front = [row for row in result["rows"] if row["on_front"]]
    front.sort(key=lambda row: row["warm_seconds"]["median"])
    return "".join(f"{row['command']}\n" for row in front)
