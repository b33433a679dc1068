"""The record of `obbtree overlap` and its table."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any

from obbcli.report.record import answer_document
from obbcli.report.rows import cost_rows, source_rows
from obbcli.report.shared_mesh import shared_mesh_rows
from obbcli.report.table import Table, count, length, point

if TYPE_CHECKING:
    from obbcli.answers.overlap import Overlap
    from obbcli.questions.overlap.asked import Asked
    from obbcli.report.record import Record, Setting

_SENTENCES = {
    "clear": "apart",
    "near": "apart, but closer than wanted",
    "touching": "they touch, within the band",
    "overlapping": "each has a part in the other",
    "contained": "one lies in the other",
    "duplicate": "both are the same solid",
    "crossing": "triangles meet of a surface that does not close",
    "unresolved": "a limit was reached before the answer was known",
}
_PARTS = ("part_a", "part_b")
_DEPTHS = {
    "thickness": "thickness",
    "protrusion_a": "A into B",
    "protrusion_b": "B into A",
}

# Of the regions, as many as the table names: the thickest.
_MOST_REGIONS = 8


def overlap_record(
    setting: Setting, asked: Asked, answer: Overlap, command: str = "overlap"
) -> Record:
    """Return the record of a question.

    Args:
        setting: what was asked about.
        asked: what was asked.
        answer: what came out.
        command: whose document it is.
    """
    record = answer_document(command, setting, overlap_part(answer), answer.stats)
    part = {"tolerance": asked.tolerance, "deeper_than": asked.deeper_than}
    tail = {name: record.pop(name) for name in ("result", "stats")}
    return record | {"asked": part} | tail


def overlap_part(answer: Overlap) -> Record:
    """Return what documents say of an answer: its fields, less what it cost."""
    part = {field.name: plain(getattr(answer, field.name)) for field in fields(answer)}
    del part["stats"]
    return part


def relation_part(answer: Overlap) -> Record:
    """Return what `obbtree collide --relation` adds to its answer."""
    part = overlap_part(answer)
    return {name: part[name] for name in ("relation", *_DEPTHS)}


def plain(value: object) -> Any:
    """Return a value of an answer as documents hold it: classes as objects, tuples as lists."""
    if is_dataclass(value) and not isinstance(value, type):
        told = {field.name: plain(getattr(value, field.name)) for field in fields(value)}
        # Parts are named where some were selected.
        return {k: v for k, v in told.items() if v is not None or k not in _PARTS}
    return [plain(part) for part in value] if isinstance(value, tuple) else value


def overlap_tables(record: Record) -> list[Table]:
    """Return the table of a record."""
    result = record["result"]
    rows = [
        *source_rows(record),
        ("relation", relation_words(result)),
        ("answer", _SENTENCES[result["relation"]]),
        *_deeper_rows(record),
        *distance_rows(result),
        *depth_rows(result),
        *_volume_rows(result),
        *_region_rows(result),
        *_along_rows(result),
        *shared_mesh_rows(result.get("mesh")),
        ("band", _band(result["band"])),
    ]
    if result["reason"] is not None:
        rows.append(("depths" if result["thickness"] else "no depths", result["reason"]))
    if not result["complete"]:
        rows.append(("limit", "a limit was reached: brackets are wider than asked for"))
    return [Table([*rows, *_cost_rows(record["stats"])])]


def overlap_bare(record: Record) -> str:
    """Return the relation's word."""
    return f"{record['result']['relation']}\n"


def relation_words(result: Record) -> str:
    """Return the relation, and of a contained solid which it is."""
    inner = result["contained"]
    if inner is None:
        return str(result["relation"])
    return f"{result['relation']}: {inner.upper()} in {'A' if inner == 'b' else 'B'}"


def distance_rows(result: Record) -> list[tuple[str, str]]:
    """Return the row that says how far apart surfaces are, where they are."""
    gap = result["distance"]
    if gap is None or gap["bounds"] == [0, 0]:
        return []
    return [("distance", bracket(gap["bounds"]))]


def depth_rows(result: Record) -> list[tuple[str, str]]:
    """Return a row for each depth that is known."""
    rows = []
    for name, words in _DEPTHS.items():
        depth = result[name]
        if depth is None:
            continue
        place = "" if depth["point"] is None else f", at {point(depth['point'])}{_parts(depth)}"
        rows.append((words, f"{bracket(depth['bounds'])}{place}"))
    return rows


def _parts(depth: Record) -> str:
    """Return the selected parts that a depth is of."""
    named = [f"{depth[k]} of {name}" for k, name in zip(_PARTS, "AB", strict=True) if k in depth]
    return f" ({' and '.join(named)})" if named else ""


def bracket(bounds: list[float | None]) -> str:
    """Return a bracket, six digits of each end."""
    low, high = bounds
    if high is None:
        return f"at least {length(low)}, proven"
    if low == high:
        return f"{length(low)}, proven"
    return f"{length(low)} to {length(high)}, proven"


def _cost_rows(stats: Record) -> list[tuple[str, str]]:
    """Return the rows that say what a question cost."""
    rows = cost_rows(stats)
    if not stats["cells"]:
        return rows
    told = f"{count(stats['cells'])} ({count(stats['points'])} points, {count(stats['rays'])} rays)"
    return [*rows[:-2], ("cells", told), *rows[-2:]]


def _volume_rows(result: Record) -> list[tuple[str, str]]:
    shared = result["volume"]
    if shared is None:
        return []
    place = "" if shared["centroid"] is None else f", about {point(shared['centroid'])}"
    return [("volume", f"{bracket(shared['bounds'])}{place}")]


def _region_rows(result: Record) -> list[tuple[str, str]]:
    """Return a row that counts the regions, and one for each of the thickest."""
    regions = result["regions"]
    if regions is None:
        return []
    told = f"{count(len(regions))}, told apart by boxes of at most {length(result['resolution'])}"
    if not regions:
        told = "none"
    if result["unproven"]:
        told += f"; {count(result['unproven'])} without a point proven inside both left out"
    rows = [("regions", told)]
    for number, region in enumerate(regions[:_MOST_REGIONS], 1):
        thick = bracket(region["thickness"])
        place = f"at {point(region['point'])}{_parts(region)}"
        rows.append((f"region {number}", f"thickness {thick}, {place}"))
    if len(regions) > _MOST_REGIONS:
        rows.append(("", f"{count(len(regions) - _MOST_REGIONS)} more, with --json"))
    return rows


def _deeper_rows(record: Record) -> list[tuple[str, str]]:
    limit, result = record["asked"]["deeper_than"], record["result"]
    if limit is None:
        return []
    if result["deeper"] is None:
        said = "not known"
    else:
        said = f"yes, by {_DEPTHS[result['by']]}" if result["deeper"] else "no"
    return [(f"deeper than {length(limit)}", said)]


def _along_rows(result: Record) -> list[tuple[str, str]]:
    way = result["separation_along"]
    if way is None:
        return []
    low, high = way["bounds"]
    far = f"at least {length(low)}; a limit was reached" if high is None else bracket([low, high])
    return [(f"A is free along {point(way['direction'])}", f"after {far}")]


def _band(band: Record) -> str:
    gap, overlap = length(band["gap"]), length(band["overlap"])
    return f"gap {gap}, overlap {overlap}: {band['reason']}"
