"""The record of `obbtree scene --least-clearance` and its tables."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from obbcli.report.clearance import clearance_part
from obbcli.report.overlap import bracket
from obbcli.report.record import document, note_rows, seconds_part
from obbcli.report.rows import triangle_tests
from obbcli.report.scene import bodies_part, used_table
from obbcli.report.table import Table, count, length, seconds

if TYPE_CHECKING:
    from collections.abc import Sequence

    from obbcli.report.record import Record, Source
    from obbcli.scene.bodies import Ignore
    from obbcli.scene.clearances import Clearances, SceneClearance

_COLUMNS = ("A", "B", "least distance", "time [s]", "triangle of A", "triangle of B")


class Found(NamedTuple):
    """What came out of a scene.

    Attributes:
        pairs: the nearest first.
        limit: at most so many were asked for. None: all.
        is_interrupted: whether Ctrl-C ended the search.
    """

    pairs: Sequence[SceneClearance]
    limit: int | None
    is_interrupted: bool


def scene_clearances_record(
    source: Source,
    meshes: Sequence[Source],
    clearances: Clearances,
    ignore: Sequence[Ignore],
    found: Found,
    *,
    with_motion: bool,
) -> Record:
    """Return the record of a scene.

    Args:
        source: the scene file.
        meshes: the files of its bodies, each once.
        clearances: what was asked.
        ignore: what was not.
        found: what came out.
        with_motion: whether to say where bodies are and how they move: centroids cost time.
    """
    asked, wanted = clearances.asked, clearances.wanted
    places = {mesh.path: place for place, mesh in enumerate(meshes)}
    stats = clearances.stats._asdict() | {"seconds": seconds_part(clearances.stats.seconds)}
    stats["bodies"] = [body._asdict() for body in clearances.stats.bodies]
    return document(
        "scene-clearances",
        {"scene": source.part(), "meshes": [mesh.part() for mesh in meshes]},
        duration=asked.duration,
        bodies=bodies_part(asked, places, with_motion=with_motion),
        ignore=[dict(entry) for entry in ignore],
        accuracy=clearances.accuracy.as_dict(),
        solid=wanted.solid,
        asked={
            "tolerance": wanted.tolerance,
            "at_least": wanted.at_least,
            "within": clearances.within,
            "limit": found.limit,
        },
        result=_result_part(meshes, clearances, found),
        stats=stats,
    )


def _result_part(meshes: Sequence[Source], clearances: Clearances, found: Found) -> Record:
    by_path = {mesh.path: mesh for mesh in meshes}
    files = {body.name: by_path.get(str(body.body.shape)) for body in clearances.asked.bodies}
    pairs = []
    for one in found.pairs:
        # Bodies that are parts of the scene's own file have no file.
        named = [file for file in (files[one.body_a], files[one.body_b]) if file is not None]
        part = clearance_part(one.clearance, named)
        pairs.append({"body_a": one.body_a, "body_b": one.body_b, **part})
    low = clearances.low
    is_whole = not clearances.is_stopped and all(one.clearance.complete for one in found.pairs)
    return {
        "pairs": pairs,
        "others_at_least": low if math.isfinite(low) else None,
        "complete": is_whole,
        "interrupted": found.is_interrupted,
    }


def scene_clearances_tables(record: Record) -> list[Table]:
    """Return the tables of a record: the scene, and its pairs, the nearest first."""
    result, stats, asked = record["result"], record["stats"], record["asked"]
    scene, meshes = record["inputs"]["scene"], record["inputs"]["meshes"]
    rows = [
        ("scene", scene["path"]),
        ("bodies", f"{count(len(record['bodies']))} of {count(len(meshes))} files"),
        *note_rows((mesh["path"], mesh) for mesh in meshes),
        ("pairs", _fates(stats, asked)),
        ("answer", _sentence(record)),
        *_open_rows(result),
        ("box tests", count(stats["box_tests"])),
        ("triangle tests", triangle_tests(stats)),
        ("time", ", ".join(f"{k} {seconds(v)}" for k, v in stats["seconds"].items())),
    ]
    tables = [Table(rows)]
    if result["pairs"]:
        is_verdict = asked["at_least"] is not None
        columns = (*_COLUMNS[:2], "verdict", *_COLUMNS[2:]) if is_verdict else _COLUMNS
        title = f"pairs: {count(len(result['pairs']))}, nearest first"
        names = 3 if is_verdict else 2
        lines = [_row(pair) for pair in result["pairs"]]
        tables.append(Table(lines, columns, title, name_count=names))
    return tables


def explained_clearances(record: Record) -> list[Table]:
    """Return the tables of a record, and one that says what of each body was used."""
    return [*scene_clearances_tables(record), used_table(record)]


def scene_clearances_bare(record: Record) -> str:
    """Return a line a pair: verdict or upper end of the bracket, and names; `none` without."""
    lines = []
    for pair in record["result"]["pairs"]:
        high = pair["minimum"]["bounds"][1]
        said = "unknown" if high is None else repr(high)
        if pair["at_least"] is not None:
            said = pair["at_least"]["verdict"]
        lines.append(f"{said} {pair['body_a']} {pair['body_b']}\n")
    return "".join(lines) or "none\n"


def _fates(stats: Record, asked: Record) -> str:
    is_verdict = asked["at_least"] is not None
    limits = [one for one in (asked["within"], asked["at_least"]) if one is not None]
    bounds = f"further than {length(min(limits))} by their bounds" if limits else "by bounds"
    fates = {
        "static": "of static bodies",
        "ignored": "ignored",
        "apart_by_bounds": bounds,
        "apart_by_trees": "apart",
        "in_contact": "nearer than asked" if is_verdict else "touch",
        "unresolved": "unresolved",
        "later": "not answered",
    }
    told = [f"{count(stats[key])} {text}" for key, text in fates.items() if stats[key]]
    return f"{count(stats['pairs'])}: " + ", ".join(told) if told else "none"


def _sentence(record: Record) -> str:
    result, asked = record["result"], record["asked"]
    pairs = result["pairs"]
    if result["interrupted"]:
        return f"interrupted: {count(len(pairs))} pairs so far"
    if asked["at_least"] is not None:
        verdicts = [pair["at_least"]["verdict"] for pair in pairs]
        near, open_ = verdicts.count("violated"), verdicts.count("open")
        said = f"{count(near)} pairs come nearer than {length(asked['at_least'])}"
        return f"{said}, {count(open_)} are open" if open_ or not result["complete"] else said
    if not pairs:
        return "no pair" if result["complete"] else "a limit was reached before any pair was known"
    first = pairs[0]
    names = f"{first['body_a']} and {first['body_b']}"
    bounds = first["minimum"]["bounds"]
    return f"{names} touch" if bounds[1] == 0 else f"least distance {_distance(bounds)}, of {names}"


def _open_rows(result: Record) -> list[tuple[str, str]]:
    """Return the rows that say what is not known, or was not asked."""
    rows = []
    if not result["complete"]:
        rows.append(("limit", "a limit was reached: brackets are wider than asked, pairs may lack"))
    if result["others_at_least"] is not None:
        rows.append(("others", f"never nearer than {length(result['others_at_least'])}, proven"))
    return rows


def _row(pair: Record) -> tuple[str, ...]:
    least, held = pair["minimum"], pair["at_least"]
    return (
        pair["body_a"],
        pair["body_b"],
        *(() if held is None else (held["verdict"],)),
        _distance(least["bounds"]),
        "" if least["time"] is None else repr(least["time"]),
        *("" if least[key] is None else str(least[key]) for key in ("triangle_a", "triangle_b")),
    )


def _distance(bounds: list[float | None]) -> str:
    low, high = bounds
    if high is not None and length(low or 0.0) == length(high):
        return length(high)
    return bracket(bounds).removesuffix(", proven")
