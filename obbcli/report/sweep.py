"""The records of `obbtree sweep`: the header of its results, and what it tells of a whole sweep."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from obbcli.report.record import document
from obbcli.report.rows import source_rows
from obbcli.report.table import Table, count, seconds

if TYPE_CHECKING:
    from collections.abc import Mapping

    from obbcli.report.record import Record, Source

STATUSES = ("contact", "overlap_at_start", "separated", "unresolved")
_SAMPLED, _ERROR = "separated as sampled", "error"


class Swept(NamedTuple):
    """How a sweep went.

    Attributes:
        output: where the results are.
        row_count: how many rows these have.
        resumed_from: how many they had before.
        tally: how many of them have which status.
        seconds: s of wall time by stage.
    """

    output: str
    row_count: int
    resumed_from: int
    tally: Mapping[str, int]
    seconds: Mapping[str, float]


def header_record(
    sources: tuple[Source, Source], queries: Mapping[str, Any], options: Record, accuracy: Record
) -> Record:
    """Return what the first line of the results says.

    Args:
        sources: the files of A and B.
        queries: path, format and SHA-256 of the file of questions.
        options: defaults of what rows leave out.
        accuracy: as used.
    """
    a, b = (source.part() for source in sources)
    inputs = {"a": a, "b": b, "queries": dict(queries)}
    return document("sweep", inputs, options=options, accuracy=accuracy)


def sweep_record(header: Record, swept: Swept) -> Record:
    """Return what a sweep tells at its end."""
    tally = dict(swept.tally)
    sampled = tally.pop(_SAMPLED, 0)
    statuses = {name: tally.get(name, 0) for name in STATUSES}
    statuses["separated"] += sampled
    result = {
        "output": swept.output,
        "row_count": swept.row_count,
        "resumed_from": swept.resumed_from,
        "statuses": statuses,
        "error_count": tally.get(_ERROR, 0),
    }
    shared = {name: header[name] for name in ("options", "accuracy", "digest")}
    stats = {"seconds": dict(swept.seconds)}
    return document("sweep-summary", header["inputs"], **shared, result=result, stats=stats)


def sweep_tables(record: Record) -> list[Table]:
    """Return the table of a record."""
    inputs, result = record["inputs"], record["result"]
    new = result["row_count"] - result["resumed_from"]
    rows = [
        *source_rows({"inputs": {name: inputs[name] for name in ("a", "b")}}),
        ("queries", inputs["queries"]["path"]),
        ("results", f"{result['output']} ({_rows(result['row_count'])})"),
    ]
    if result["resumed_from"]:
        rows.append(("resumed", f"{_rows(result['resumed_from'])} were there already"))
    rows += [(name, count(number)) for name, number in result["statuses"].items() if number]
    if result["error_count"]:
        rows.append(("refused", f"{_rows(result['error_count'])}: see their errors"))
    stages = record["stats"]["seconds"]
    rate = f" ({count(round(new / stages['query']))} rows a second)" if new else ""
    rows.append(("time", ", ".join(f"{k} {seconds(v)}" for k, v in stages.items()) + rate))
    return [Table(rows)]


def sweep_bare(record: Record) -> str:
    """Return how many rows have which status, one a line."""
    result = record["result"]
    statuses = result["statuses"] | {"error": result["error_count"]}
    return "".join(f"{name} {number}\n" for name, number in statuses.items() if number)


def _rows(number: int) -> str:
    return "1 row" if number == 1 else f"{count(number)} rows"
