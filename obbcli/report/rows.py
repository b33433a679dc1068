"""The rows that tables of several commands share: inputs, cost, what an answer leaves open."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.report.record import note_rows
from obbcli.report.table import count, length, point, seconds

if TYPE_CHECKING:
    from collections.abc import Sequence

    from obbcli.mesh import Mesh
    from obbcli.report.record import Record, Source
    from obbcli.tree.tree import ObbTree


def source_rows(record: Record) -> list[tuple[str, str]]:
    """Return the rows that name A and B, that say what of them was changed, and where they turn."""
    sources = [(name.upper(), source) for name, source in record["inputs"].items()]
    rows = [
        (name, f"{source['path']} ({count(source['triangle_count'])} triangles)")
        for name, source in sources
    ]
    return [*rows, *note_rows(sources), *_pivot_rows(record.get("motion", {}))]


def _pivot_rows(motion: Record) -> list[tuple[str, str]]:
    """Return the rows that say where the axes of A and B pass at t = 0, of those that turn."""
    if not motion.get("duration"):
        return []
    bodies = [(name, motion[name.lower()]) for name in "AB" if name.lower() in motion]
    return [
        (f"pivot of {name}", point(body["pivot"]))
        for name, body in bodies
        if any(body.get("angular_velocity", ()))
    ]


def part_rows(result: Record) -> list[tuple[str, str]]:
    """Return the row that names the selected parts that an answer's triangles are of."""
    found = [(name, result.get(f"part_{name.lower()}")) for name in "AB"]
    words = [f"{path or 'no name'} of {name}" for name, path in found if path is not None]
    return [("parts", " and ".join(words))] if words else []


def about_units(
    sources: tuple[Source, Source], trees: tuple[Mesh | ObbTree, Mesh | ObbTree]
) -> tuple[Source, Source]:
    """Return what is said of A and B, with notes on units that may be mistaken."""
    from obbcli.questions.notes import unit_notes

    a, b = (
        source._replace(notes=(*source.notes, *more))
        for source, more in zip(sources, unit_notes(trees, "--unit, --scale"), strict=True)
    )
    return a, b


def told_units(meshes: Sequence[Source]) -> list[Source]:
    """Return what is said of a scene's files, with a note where some alone state a unit."""
    found = list(meshes)
    silent = sum(mesh.unit is None for mesh in found)
    if 0 < silent < len(found):
        place = next(k for k, mesh in enumerate(found) if mesh.unit is not None)
        mesh = found[place]
        others = "1 other file states" if silent == 1 else f"{silent:,} other files state"
        note = f"is in {mesh.unit}, {others} no unit of length: see unit and scale of scenes"
        found[place] = mesh._replace(notes=(*mesh.notes, note))
    return found


def why_open(record: Record) -> str:
    """Return what an unresolved question may have ended at: a limit, or the end of its digits."""
    accuracy, stats = record["accuracy"], record["stats"]
    timeout = accuracy["timeout"]
    if stats["pops"] >= accuracy["max_iterations"] or (
        timeout is not None and stats["seconds"]["query"] >= timeout
    ):
        return "a limit was reached"
    return "a limit was reached or the digits of doubles ended"


def contained_rows(result: Record) -> list[tuple[str, str]]:
    """Return the row that says which body lies inside the other."""
    inner = result["contained"]
    if inner is None:
        return []
    outer = "A" if inner == "b" else "B"
    return [("contained", f"{inner.upper()}, or a part of it, lies inside {outer}")]


def cost_rows(stats: Record) -> list[tuple[str, str]]:
    """Return the rows that say what a question cost."""
    return [
        ("box tests", count(stats["box_tests"])),
        ("triangle tests", triangle_tests(stats)),
        *image_rows(stats),
        ("boxes built", f"{_built(stats, 'a')} of A, {_built(stats, 'b')} of B"),
        ("time", ", ".join(f"{k} {seconds(v)}" for k, v in stats["seconds"].items())),
    ]


def as_sampled(result: Record, *, by_boxes: bool) -> str:
    """Return what a sampled answer leaves open."""
    bound = length(result["error_bound"])
    if by_boxes:
        return f" of boxes as sampled: the surfaces are at most {bound} apart"
    off = f"paths at most {bound} off the true ones" if result["error_bound"] else "the true paths"
    return f" as sampled, on {off}"


def image_rows(stats: Record) -> list[tuple[str, str]]:
    """Return the row of a question that was answered along a common screw of the bodies."""
    images = stats["image_tests"]
    return [("image tests", f"{count(images)}, along a common screw")] if images else []


def triangle_tests(stats: Record) -> str:
    """Return how many triangles were tested, and how many of them in exact arithmetic."""
    text = count(stats["triangle_tests"])
    exact = stats["exact_triangle_tests"]
    return f"{text} ({count(exact)} in exact arithmetic)" if exact else text


def _built(stats: Record, side: str) -> str:
    built, possible = stats[f"nodes_built_{side}"], stats[f"nodes_possible_{side}"]
    return f"{count(built)} of {count(possible)}"
