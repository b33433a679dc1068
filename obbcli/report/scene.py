"""The record of `obbtree scene` and its tables."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING, NamedTuple

from obbcli.answers.status import Status
from obbcli.motion.body import Body
from obbcli.report.contacts import contact_part
from obbcli.report.record import (
    Source,
    body_part,
    document,
    note_rows,
    seconds_part,
)
from obbcli.report.rows import image_rows, triangle_tests
from obbcli.report.table import Table, count, point, seconds

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from obbcli.report.record import Record
    from obbcli.scene.bodies import Ignore
    from obbcli.scene.pairs import ScenePairs
    from obbcli.scene.results import SceneContact, SceneStats

_COLUMNS = ("A", "B", "time [s]", "triangle of A", "triangle of B", "feature", "point")
_FATES = {
    "static": "of static bodies",
    "ignored": "ignored",
    "apart_by_bounds": "apart by their bounds",
    "apart_by_trees": "apart by their trees",
    "in_contact": "in contact",
    "unresolved": "unresolved",
    "later": "left, as no answer needs them",
}


class Answer(NamedTuple):
    """What came out of a scene.

    Attributes:
        contacts: in order of time; those that are unresolved say up to when they are known.
        stats: what it took.
        is_complete: whether nothing that touches is missing.
        is_interrupted: whether Ctrl-C ended the search.
    """

    contacts: Sequence[SceneContact]
    stats: SceneStats
    is_complete: bool
    is_interrupted: bool


def scene_record(
    source: Source,
    meshes: Sequence[Source],
    asked: ScenePairs,
    ignore: Sequence[Ignore],
    answer: Answer,
    *,
    with_motion: bool,
) -> Record:
    """Return the record of a scene.

    Args:
        source: the scene file.
        meshes: the files of its bodies, each once.
        asked: what was asked about.
        ignore: what was not.
        answer: what came out.
        with_motion: whether to say where bodies are and how they move: centroids cost time.
    """
    places = {mesh.path: place for place, mesh in enumerate(meshes)}
    by_path = {mesh.path: mesh for mesh in meshes}
    files = {body.name: by_path.get(str(body.body.shape)) for body in asked.bodies}
    result = _result_part(asked, answer, files)
    stats = answer.stats._asdict() | {"seconds": seconds_part(answer.stats.seconds)}
    stats["bodies"] = [body._asdict() for body in answer.stats.bodies]
    return document(
        "scene",
        {"scene": source.part(), "meshes": [mesh.part() for mesh in meshes]},
        duration=asked.duration,
        bodies=bodies_part(asked, places, with_motion=with_motion),
        ignore=[dict(entry) for entry in ignore],
        accuracy=asked.accuracy.as_dict(),
        # What is not asked for is no key, so that documents without it are as they were.
        **({"solid": True} if asked.solid else {}),
        result=result,
        stats=stats,
    )


def mesh_paths(asked: ScenePairs) -> list[str]:
    """Return the files that bodies are made of, each once, in the order of the bodies."""
    shapes = [body.body.shape for body in asked.bodies]
    paths = [str(shape) for shape in shapes if isinstance(shape, (str, PathLike))]
    return list(dict.fromkeys(paths))


def bodies_part(asked: ScenePairs, places: dict[str, int], *, with_motion: bool) -> list[Record]:
    """Return what is said of the bodies, with the place of each one's file."""
    return [
        {
            "name": body.name,
            # Parts of the scene's own file are no paths, and then it is the only one.
            "mesh": places.get(str(body.body.shape), 0),
            "static": body.static,
            "group": body.group,
            **(body_part(Body(shape, body.body.pose, body.body.motion)) if with_motion else {}),
        }
        for body, shape in zip(asked.bodies, asked.shapes, strict=True)
    ]


def _contact_part(found: SceneContact, files: Mapping[str, Source | None]) -> Record:
    """Return what a result says of a contact; bodies that are parts of the scene have no file."""
    sources = [file for file in (files[found.body_a], files[found.body_b]) if file is not None]
    names = {"body_a": found.body_a, "body_b": found.body_b}
    return names | contact_part(found.contact, sources)


def _result_part(asked: ScenePairs, answer: Answer, files: Mapping[str, Source | None]) -> Record:
    touching = [found for found in answer.contacts if found.status is not Status.UNRESOLVED]
    unresolved = [found for found in answer.contacts if found.status is Status.UNRESOLVED]
    status = Status.SEPARATED if not touching else touching[0].status
    is_sampled = asked.accuracy.method == "sampled" and asked.duration > 0
    return {
        "status": (Status.UNRESOLVED if unresolved else status).value,
        "time": touching[0].time if touching else None,
        "approximate": any(found.contact.approximate for found in touching)
        or (is_sampled and answer.stats.apart_by_trees > 0),
        "contacts": [_contact_part(found, files) for found in touching],
        "contacts_complete": answer.is_complete,
        "unresolved": [
            {"body_a": found.body_a, "body_b": found.body_b, "time": found.time}
            for found in unresolved
        ],
        "interrupted": answer.is_interrupted,
    }


def scene_tables(record: Record) -> list[Table]:
    """Return the tables of a record: the answer, the contacts, and what was left open."""
    result, stats = record["result"], record["stats"]
    scene, meshes = record["inputs"]["scene"], record["inputs"]["meshes"]
    bodies = f"{count(len(record['bodies']))} of {count(len(meshes))} files"
    fates = [f"{count(stats[key])} {text}" for key, text in _FATES.items() if stats[key]]
    rows = [
        ("scene", scene["path"]),
        ("bodies", bodies),
        *note_rows((mesh["path"], mesh) for mesh in meshes),
        ("pairs", f"{count(stats['pairs'])}: " + ", ".join(fates) if fates else "none"),
        ("answer", _sentence(record)),
        ("box tests", count(stats["box_tests"])),
        ("triangle tests", triangle_tests(stats)),
        *image_rows(stats),
        ("time", ", ".join(f"{k} {seconds(v)}" for k, v in stats["seconds"].items())),
    ]
    tables = [Table(rows)]
    if result["contacts"]:
        tables.append(_contacts_table(result))
    if result["unresolved"]:
        tables.append(_unresolved_table(result))
    return tables


def explained_tables(record: Record) -> list[Table]:
    """Return the tables of a record, and one that says what of each body was used."""
    return [*scene_tables(record), used_table(record)]


def used_table(record: Record) -> Table:
    """Return the table that says what of each body was used."""
    rows = [
        (
            body["name"],
            record["inputs"]["meshes"][part["mesh"]]["path"],
            _of(body["triangles_loaded"], body["triangle_count"]),
            _of(body["nodes_built"], body["nodes_possible"]),
        )
        for part, body in zip(record["bodies"], record["stats"]["bodies"], strict=True)
    ]
    columns = ("body", "file", "triangles loaded", "boxes built")
    title = "what of each body was used; bodies of one file share it"
    stats = record["stats"]
    if "meshes_decoded" in stats:
        decoded = f"{count(stats['meshes_decoded'])} of {count(stats['meshes_possible'])}"
        title = f"what of each body was used; meshes decoded: {decoded}, which copies share"
    return Table(rows, columns, title, name_count=2)


def scene_bare(record: Record) -> str:
    """Return a line a contact: status, time and names; or that there is none."""
    result = record["result"]
    lines = [(one["status"], one) for one in result["contacts"]]
    lines += [("unresolved", one) for one in result["unresolved"]]
    if not lines:
        return f"{result['status']}\n"
    return "".join(
        f"{status} {one['time']!r} {one['body_a']} {one['body_b']}\n" for status, one in lines
    )


def _of(part: int, whole: int | None) -> str:
    return "-" if whole is None else f"{count(part)} of {count(whole)}"


def _sentence(record: Record) -> str:
    result = record["result"]
    contacts, unresolved = result["contacts"], result["unresolved"]
    sampled = " as sampled" if result["approximate"] and not contacts else ""
    if contacts:
        time = contacts[0]["time"]
        when = "at t = 0" if time == 0 else f"at t = {time!r} s"
        said = f"first contact {when}, of {contacts[0]['body_a']} and {contacts[0]['body_b']}"
    else:
        said = f"no contact in the whole duration{sampled}"
    if not unresolved:
        return said
    low = unresolved[0]["time"]
    why = "interrupted" if result["interrupted"] else "a limit was reached"
    left = f"{why}: what touches is known before t = {low!r} s"
    return f"{said}; {left}" if contacts and contacts[0]["time"] <= low else left


def _contacts_table(result: Record) -> Table:
    rows = [
        (
            contact["body_a"],
            contact["body_b"],
            repr(contact["time"]),
            *_triangles(contact),
            _inside(contact) or contact["feature"] or "",
            "" if contact["point"] is None else point(contact["point"]),
        )
        for contact in result["contacts"]
    ]
    more = "" if result["contacts_complete"] else "; there may be more"
    title = f"contacts: {count(len(rows))}, earliest first{more}"
    return Table(rows, _COLUMNS, title, name_count=2)


def _inside(contact: Record) -> str | None:
    """Return which body is inside the other, or a part of it; None where surfaces meet."""
    inner = contact["contained"]
    return None if inner is None else f"{inner.upper()} inside {'B' if inner == 'a' else 'A'}"


def _triangles(contact: Record) -> tuple[str, str]:
    """Return the rows of two triangles; boxes that stand for triangles have none."""
    ids = (contact["triangle_a"], contact["triangle_b"])
    a, b = ("-" if number is None else str(number) for number in ids)
    return a, b


def _unresolved_table(result: Record) -> Table:
    rows = [(one["body_a"], one["body_b"], repr(one["time"])) for one in result["unresolved"]]
    title = f"unresolved pairs: {count(len(rows))}"
    return Table(rows, ("A", "B", "known before [s]"), title, name_count=2)
