"""The tables of `obbtree tradeoff`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.accuracy import Accuracy
from obbcli.report.rows import source_rows
from obbcli.report.table import Table, count, length, seconds, size
from obbcli.report.tradeoff import accuracy_words, build_words, number

if TYPE_CHECKING:
    from obbcli.report.record import Record

_COLUMNS = ("setting", "error [s]", "gap", "claim", "time", "quartiles", "build", "memory",
            "box tests", "triangle tests")  # fmt: skip
# Of the settings off the front: how many are shown.
_SHOWN = 12


def tradeoff_tables(record: Record) -> list[Table]:
    """Return the tables of a record: the answer, the front, the rest, prices, recommendations."""
    result = record["result"]
    rows = sorted(result["rows"], key=_time)
    front = [row for row in rows if row["on_front"]]
    rest = [row for row in rows if not row["on_front"]]
    tables = [Table(_summary(record))]
    if front:
        title = "the front: none is both faster and nearer to the truth"
        tables.append(Table([_cells(row) for row in front], _COLUMNS, title))
    if rest:
        left = len(rest) - _SHOWN
        more = f"; {left} more with --json" if left > 0 else ""
        cells = [_cells(row) for row in rest[:_SHOWN]]
        tables.append(Table(cells, _COLUMNS, f"off the front, fastest first{more}"))
    if result["prices"] and rows:
        tables.append(_prices(result))
    tables += [_advice(result, part) for part in result["recommended"]]
    return tables


def tradeoff_bare(record: Record) -> str:
    """Return the recommended command lines, one a line, or those of the front."""
    result = record["result"]
    rows = result["rows"]
    if result["recommended"]:
        numbers = [part["row"] for part in result["recommended"] if part["row"] is not None]
        return "".join(f"{rows[number]['command']}\n" for number in numbers)
    front = sorted((row for row in rows if row["on_front"]), key=_time)
    return "".join(f"{row['command']}\n" for row in front)


def label(row: Record) -> str:
    """Return the options of a setting that are not defaults."""
    build = " ".join(build_words(row["build"]))
    way = " ".join(accuracy_words(Accuracy(**row["accuracy"])))
    parts = [*([f"build {build}"] if build else []), *([way] if way else [])]
    return "; ".join(parts) or "the defaults"


def _time(row: Record) -> float:
    median: float = row["warm_seconds"]["median"]
    return median


def _summary(record: Record) -> list[tuple[str, str]]:
    result, stats = record["result"], record["stats"]
    broken = result["claims_broken"]
    checked = result["claims_checked"]
    claims = f"{count(checked)} checked, all true" if checked else "none checked"
    if broken:
        claims = f"{count(checked)} checked, {count(broken)} BROKEN: a fault of obbtree"
    rows = [
        *source_rows(record),
        ("reference", _reference(record)),
        ("settings", _measured(result)),
        ("claims", claims),
    ]
    for row in result["rows"]:
        rows += [("broken", f"{label(row)}: {fault}") for fault in row["faults"]]
    rows.append(("time", f"{seconds(stats['seconds']['study'])} of {number(stats['budget'])} s"))
    return rows


def _measured(result: Record) -> str:
    text = f"{count(len(result['rows']))} measured"
    late = result["unreached"]
    if late:
        text += f", {count(len(late))} not reached: {_short(late[0])}"
        text += f" and {count(len(late) - 1)} more" if len(late) > 1 else ""
    return f"{text}; interrupted" if result["interrupted"] else text


def _short(one: Record) -> str:
    refused = "" if one["why"].startswith("the budget") else f" ({one['why']})"
    return label(one) + refused


def _reference(record: Record) -> str:
    found = record["result"]["reference"]
    if found["status"] == "unresolved":
        return f"unresolved; no contact before t = {found['time']!r} s"
    if found["status"] == "separated":
        return "separated, proven"
    low, high = found["time_bounds"]
    return f"{found['status']}, proven between {low!r} and {high!r} s"


def _cells(row: Record) -> tuple[str, ...]:
    warm = row["warm_seconds"]
    spread = f"{seconds(warm['low_quartile'])} to {seconds(warm['high_quartile'])}"
    return (
        label(row),
        _error(row),
        "-" if row["gap"] is None else f"{row['gap']:.2g}",
        _claim(row),
        seconds(warm["median"]),
        spread if warm["rounds"] else "first call",
        seconds(row["build_seconds"]),
        size(row["tree_bytes"]),
        count(row["box_tests"]),
        count(row["triangle_tests"]),
    )


def _error(row: Record) -> str:
    error = row["time_error"]
    if row["verdict_wrong"]:
        return f"wrong: {row['status']}"
    if error is None:
        return str(row["status"])
    if error == 0:
        return "0"
    return f"{abs(error):.2g} {'early' if error < 0 else 'late'}"


def _claim(row: Record) -> str:
    """Return what an answer says of its own error."""
    if row["status"] == "unresolved":
        return "none"
    if not row["approximate"]:
        near = row["distance"]
        return f"proof, to {near:.2g}" if near else "proof"
    bound = row["error_bound"]
    kind = "boxes" if row["evidence"] == "boxes" else "paths"
    return f"{kind} {length(bound) if bound is None else f'{bound:.2g}'}"


def _prices(result: Record) -> Table:
    """Return what an error costs at least: proven, and sampled."""
    rows = result["rows"]
    steps = [row["accuracy"]["steps"] for row in rows if row["accuracy"]["method"] == "sampled"]
    none = f"none of up to {count(max(steps))} steps" if steps else "none"
    cells = []
    for part in result["prices"]:
        share = f"{part['share_of_duration']:g} of the duration"
        cells.append(
            (
                share,
                *_priced(rows, part["cheapest_proven"], "none"),
                *_priced(rows, part["cheapest_sampled"], none),
                "-" if part["ratio_seconds"] is None else f"{part['ratio_seconds']:.3g}",
            )
        )
    columns = ("error at most", "fastest proof", "fastest sampled", "proof", "sampled",
               "defaults / sampled")  # fmt: skip
    cells = [(a, b, d, c, e, f) for a, b, c, d, e, f in cells]
    return Table(cells, columns, "what an error costs", name_count=3)


def _priced(rows: list[Record], index: int | None, none: str) -> tuple[str, str]:
    return (none, "-") if index is None else (label(rows[index]), seconds(_time(rows[index])))


def _advice(result: Record, part: Record) -> Table:
    """Return the settings for a limit, with their command lines."""
    limits = part["limits"]
    best = "most accurate" if "max_time" in limits else "fastest"
    lines = []
    for kind, text in (("row", best), ("row_proven", f"{best} proof")):
        if part[kind] is None:
            lines.append((text, "none was measured"))
            continue
        row = result["rows"][part[kind]]
        lines.append((text, row["command"]))
        lines.append(("", f"{seconds(_time(row))}, error {_error(row)}, {_claim(row)}"))
    words = [f"--{name.replace('_', '-')} {number(limit)}" for name, limit in limits.items()]
    return Table(lines, title=f"for {' '.join(words)}")
