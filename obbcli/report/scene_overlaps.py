"""The record of `obbtree scene --overlaps` and its tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from obbcli.answers.overlap import MEETING
from obbcli.report.overlap import bracket, overlap_part, relation_words
from obbcli.report.record import document, note_rows, seconds_part
from obbcli.report.rows import triangle_tests
from obbcli.report.scene import bodies_part
from obbcli.report.table import Table, count, length, seconds

if TYPE_CHECKING:
    from collections.abc import Sequence

    from obbcli.report.record import Record, Source
    from obbcli.scene.bodies import Ignore
    from obbcli.scene.overlaps import Overlaps, SceneOverlap

_COLUMNS = ("A", "B", "relation", "thickness", "A into B", "B into A", "distance")
_DEPTHS = ("thickness", "protrusion_a", "protrusion_b")


class Found(NamedTuple):
    """What came out of a scene.

    Attributes:
        pairs: those that are not clear.
        is_interrupted: whether Ctrl-C ended the search.
    """

    pairs: Sequence[SceneOverlap]
    is_interrupted: bool


def scene_overlaps_record(
    source: Source,
    meshes: Sequence[Source],
    overlaps: Overlaps,
    ignore: Sequence[Ignore],
    found: Found,
) -> Record:
    """Return the record of a scene.

    Args:
        source: the scene file.
        meshes: the files of its bodies, each once.
        overlaps: what was asked.
        ignore: what was not.
        found: what came out.
    """
    asked, wanted = overlaps.asked, overlaps.wanted
    places = {mesh.path: place for place, mesh in enumerate(meshes)}
    stats = overlaps.stats._asdict() | {"seconds": seconds_part(overlaps.stats.seconds)}
    stats["bodies"] = [body._asdict() for body in overlaps.stats.bodies]
    pairs = [
        {"body_a": one.body_a, "body_b": one.body_b, **overlap_part(one.overlap)}
        for one in found.pairs
    ]
    return document(
        "scene-overlaps",
        {"scene": source.part(), "meshes": [mesh.part() for mesh in meshes]},
        bodies=[
            told | {"pose": body.body.pose.told()}
            for told, body in zip(
                bodies_part(asked, places, with_motion=False), asked.bodies, strict=True
            )
        ],
        ignore=[dict(entry) for entry in ignore],
        accuracy=overlaps.accuracy.as_dict(),
        asked={
            "tolerance": wanted.tolerance,
            "touch": None if wanted.touch is None else list(wanted.touch),
        },
        result={"pairs": pairs, "interrupted": found.is_interrupted},
        stats=stats,
    )


def scene_overlaps_tables(record: Record) -> list[Table]:
    """Return the tables of a record: the scene, and the pairs that are not clear."""
    result, stats = record["result"], record["stats"]
    scene, meshes = record["inputs"]["scene"], record["inputs"]["meshes"]
    fates = {
        "static": "of static bodies",
        "ignored": "ignored",
        "apart_by_bounds": "apart by their bounds",
        "apart_by_trees": "apart",
        "in_contact": "touch or overlap",
        "unresolved": "unresolved",
        "later": "not asked any more",
    }
    told = [f"{count(stats[key])} {text}" for key, text in fates.items() if stats[key]]
    rows = [
        ("scene", scene["path"]),
        ("bodies", f"{count(len(record['bodies']))} of {count(len(meshes))} files"),
        *note_rows((mesh["path"], mesh) for mesh in meshes),
        ("pairs", f"{count(stats['pairs'])}: " + ", ".join(told) if told else "none"),
        ("answer", _sentence(result)),
        *_reasons(result),
        ("box tests", count(stats["box_tests"])),
        ("triangle tests", triangle_tests(stats)),
        ("time", ", ".join(f"{k} {seconds(v)}" for k, v in stats["seconds"].items())),
    ]
    tables = [Table(rows)]
    if result["pairs"]:
        tables.append(Table([_row(pair) for pair in result["pairs"]], _COLUMNS, name_count=3))
    return tables


def scene_overlaps_bare(record: Record) -> str:
    """Return a line a pair: relation and names; or that all are clear."""
    lines = [
        f"{pair['relation']} {pair['body_a']} {pair['body_b']}\n"
        for pair in record["result"]["pairs"]
    ]
    return "".join(lines) or "clear\n"


def _sentence(result: Record) -> str:
    relations = [pair["relation"] for pair in result["pairs"]]
    meeting = sum(one in MEETING for one in relations)
    touching = relations.count("touching")
    said = f"{count(meeting)} overlap, {count(touching)} touch"
    return f"interrupted: {said} so far" if result["interrupted"] else said


def _reasons(result: Record) -> list[tuple[str, str]]:
    """Return a row for each reason why pairs have no depths."""
    reasons = {
        f"{pair['body_a']}, {pair['body_b']}": pair["reason"]
        for pair in result["pairs"]
        if pair["reason"] is not None
    }
    return [("no depths", f"{names}: {reason}") for names, reason in reasons.items()]


def _row(pair: Record) -> tuple[str, ...]:
    gap = pair["distance"]
    return (
        pair["body_a"],
        pair["body_b"],
        relation_words(pair),
        *(_depth(pair[name]) for name in _DEPTHS),
        "" if gap is None else length(gap["bounds"][1]),
    )


def _depth(depth: Record | None) -> str:
    return "" if depth is None else bracket(depth["bounds"]).removesuffix(", proven")
