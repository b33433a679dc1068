"""Tables of the rows of `bench_first_contact`, in Markdown: ours, beside others, and who errs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from harness import OURS, Row, markdown, time_text
from moving_ours import TOLERANCES, YES_NO
from moving_peers import ADVANCEMENT, LOOP, PEERS

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

SLOWEST = 10


def tables(rows: Sequence[Row]) -> str:
    """Return all of them, one below the other."""
    parts = {
        "Time a question, median and 95 of 100": _times(rows),
        "Tests a question, median and 95 of 100: boxes, triangles": _counts(rows),
        f"Others, times as long as {OURS} to the default accuracy": _ratios(rows),
        "Answers of others, judged; error of times in parts of the duration": _verdicts(rows),
        f"The slowest questions of {OURS}": _slowest(rows),
    }
    asked, hits = (sum(_notes(row, OURS)[name] for row in rows) for name in ("asked", "hits"))
    checked = f"{asked:,} questions, {hits:,} contacts; every answer of {OURS} checked: none wrong."
    return "\n\n".join([checked, *(f"{title}:\n\n{text}" for title, text in parts.items())])


def short(rows: Sequence[Row]) -> str:
    """Return what a page has room for: the largest blobs, and how often others erred."""
    asked, hits = (sum(_notes(row, OURS)[name] for row in rows) for name in ("asked", "hits"))
    most = max(row.triangles for row in rows)
    who = [OURS, LOOP, ADVANCEMENT]
    lines = [["motion", "outcome", *who]]
    for row in (row for row in rows if row.triangles == most):
        times = [time_text(row.timings[one].median) for one in who]
        lines.append([*row.case.split(" / ")[1:], *times])
    judged = [["who", "asked", "misses", "false hits", "earliest", "latest", "time"]]
    peers = (
        one for one in _others(rows) if "samples" not in one and one not in (LOOP, ADVANCEMENT)
    )
    for one in (LOOP, ADVANCEMENT, *peers):
        asked_of, misses, false, _, earliest, latest, time = _summed(rows, one)
        judged.append([one, asked_of, misses, false, earliest, latest, time])
    return "\n\n".join(
        [
            f"{asked:,} questions, {hits:,} contacts; every answer of {OURS} checked: none wrong.",
            f"Medians of {most:,} triangles each:",
            markdown(lines),
            "Answers of others over all meshes, with the errors of their times in parts of the\n"
            "duration and the range of their medians:",
            markdown(judged),
        ]
    )


def _notes(row: Row, who: str) -> Any:
    return row.notes[who]


def _times(rows: Sequence[Row]) -> str:
    columns = (*TOLERANCES, YES_NO)
    lines = [["pair", "motion", "outcome", "asked", "hits", *columns]]
    for row in rows:
        ours = _notes(row, OURS)
        cells = [
            f"{time_text(row.timings[who].median)}, {time_text(_notes(row, who)['p95'])}"
            for who in columns
        ]
        lines.append([*row.case.split(" / "), str(ours["asked"]), str(ours["hits"]), *cells])
    return markdown(lines)


def _counts(rows: Sequence[Row]) -> str:
    lines = [["pair", "motion", "outcome", *TOLERANCES]]
    for row in rows:
        cells = []
        for who in TOLERANCES:
            facts = _notes(row, who)
            tests = (
                f"{facts[name]:,} ({facts[f'{name} p95']:,})" for name in ("boxes", "triangles")
            )
            cells.append(", ".join(tests))
        lines.append([*row.case.split(" / "), *cells])
    return markdown(lines)


def _ratios(rows: Sequence[Row]) -> str:
    who = [LOOP, ADVANCEMENT]
    who += [name for name in _others(rows) if name not in who]
    lines = [["pair", "motion", "outcome", OURS, *who]]
    for row in rows:
        ours = row.timings[OURS].median
        cells = [
            f"{row.timings[name].median / ours:.3g}x" if name in row.timings else "-"
            for name in who
        ]
        lines.append([*row.case.split(" / "), time_text(ours), *cells])
    return markdown(lines)


def _others(rows: Sequence[Row]) -> list[str]:
    """Return who else was timed."""
    ours = {*TOLERANCES, YES_NO}
    return list(dict.fromkeys(name for row in rows for name in row.timings if name not in ours))


def _verdicts(rows: Sequence[Row]) -> str:
    lines = [
        ["motion", "who", "asked", "misses", "false hits", "refused", "earliest", "latest", "time"]
    ]
    for motion in dict.fromkeys(row.case.split(" / ")[1] for row in rows):
        chosen = [row for row in rows if row.case.split(" / ")[1] == motion]
        named = {who for row in chosen for who in row.notes}
        for who in (peer.name for peer in PEERS if peer.name in named):
            lines.append([motion, who, *_summed(chosen, who)])
    return markdown(lines)


def _summed(rows: Sequence[Row], who: str) -> Iterator[str]:
    """Yield one peer's cells over some rows: counts, extreme errors, the range of its medians."""
    facts = [_notes(row, who) for row in rows if who in row.notes]
    for name in ("asked", "misses", "false hits", "refused"):
        yield f"{sum(one[name] for one in facts):,}"
    timed = any(one["compared times"] for one in facts)
    yield f"{min(one['earliest'] for one in facts):.2g}" if timed else "-"
    yield f"{max(one['latest'] for one in facts):.2g}" if timed else "-"
    medians = [row.timings[who].median for row in rows if who in row.timings]
    yield f"{time_text(min(medians))} .. {time_text(max(medians))}" if medians else "-"


def _slowest(rows: Sequence[Row]) -> str:
    lines = [["pair", "motion", "outcome", "number", "time", "boxes", "triangles", "pops"]]
    found = [
        (one["seconds"], row.case.split(" / "), one)
        for row in rows
        for one in _notes(row, OURS)["slowest"]
    ]
    for seconds, case, one in sorted(found, key=lambda item: -item[0])[:SLOWEST]:
        counts = [f"{one[name]:,}" for name in ("boxes", "triangles", "pops")]
        lines.append([*case, str(one["index"]), time_text(seconds), *counts])
    return markdown(lines)
