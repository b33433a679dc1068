"""The parts that every record shares: schema, inputs, motion, accuracy, stats, errors.

A record is a dict of plain values in a fixed order; JSON and tables are both made from it alone.
"""

from __future__ import annotations

import math
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from obbcli.errors import ObbError
from obbcli.files import stamp_of
from obbcli.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from obbcli.accuracy import Accuracy
    from obbcli.answers.clearance import LeastClearance
    from obbcli.answers.collision import Collision
    from obbcli.answers.contact import Contact
    from obbcli.answers.counts import QueryStats
    from obbcli.answers.distance import Distance
    from obbcli.answers.overlap import OverlapStats
    from obbcli.mesh import Mesh, PartRows
    from obbcli.motion.body import Body
    from obbcli.tree.head import TreeHead
    from obbcli.tree.tree import ObbTree

Record: TypeAlias = dict[str, Any]

SCHEMA_VERSION = 1
_CHUNK = 1 << 20


class Source(NamedTuple):
    """A file that was asked about.

    Attributes:
        path: as the user wrote it; `-` for standard input.
        sha256: of the file's bytes, in hexadecimal; None where it was not asked for.
        triangle_count: how many triangles it holds; None where it could not be read.
        notes: what of it was taken with a change, a sentence each.
        parts: those that a pattern selected, with their rows.
        unit: the length of 1, as it was asked for or as the file states it.
        sag: how far triangles are from exact surfaces of the file at most, mesh units.
    """

    path: str
    sha256: str | None
    triangle_count: int | None
    notes: tuple[str, ...] = ()
    parts: tuple[PartRows, ...] = ()
    unit: str | None = None
    sag: float | None = None

    @classmethod
    def of(cls, path: str, sha256: str | None, shape: Mesh | ObbTree | TreeHead) -> Source:
        """Return what is told of a file that holds `shape`."""
        from obbcli.mesh import Mesh

        count = len(shape.triangles) if isinstance(shape, Mesh) else shape.triangle_count
        return cls(path, sha256, count, shape.notes, shape.parts, shape.unit, shape.sag)

    def part(self) -> Record:
        """Return what a record says of it."""
        said = self._asdict() | {"notes": list(self.notes)}
        del said["parts"]
        for name in ("unit", "sag"):
            if said[name] is None:
                del said[name]
        return said | ({"parts": [rows._asdict() for rows in self.parts]} if self.parts else {})


class Setting(NamedTuple):
    """What a question about two bodies was asked with.

    Attributes:
        sources: the files of A and B.
        motion: as `motion_part` gives it.
        accuracy: as used.
        solid: whether closed surfaces were to hold what is inside them; None where nobody may ask.
    """

    sources: Sequence[Source]
    motion: Record
    accuracy: Accuracy
    solid: bool | None = None


def document(command: str, inputs: Any, **parts: Any) -> Record:
    """Return a record of one command, its parts in the order given."""
    return _head(command) | {"inputs": inputs} | parts


def _head(name: str) -> Record:
    """Return how every document begins."""
    return {"schema": f"obbtree/{name}/{SCHEMA_VERSION}", "tool_version": __version__}


def answer_document(
    command: str, setting: Setting, result: Record, stats: QueryStats | OverlapStats
) -> Record:
    """Return the record of an answer about two bodies."""
    a, b = setting.sources
    return document(
        command,
        {"a": a.part(), "b": b.part()},
        motion=setting.motion,
        accuracy=setting.accuracy.as_dict(),
        **({} if setting.solid is None else {"solid": setting.solid}),
        result=result,
        stats=stats_part(stats),
    )


def part_names(
    answer: Collision | Contact | Distance | LeastClearance, sources: Iterable[Source]
) -> Record:
    """Return the selected parts that an answer names; no keys where no part was selected.

    Args:
        answer: which names them.
        sources: the files of A and B.
    """
    if not any(source.parts for source in sources):
        return {}
    return {"part_a": answer.part_a, "part_b": answer.part_b}


def motion_part(bodies: tuple[Body, Body], duration: float) -> Record:
    """Return the motion as understood: poses and pivots in world coordinates, or paths.

    Args:
        bodies: A and B; their shapes are trees or meshes.
        duration: s, as resolved.
    """
    a, b = bodies
    return {"duration": duration, "a": body_part(a), "b": body_part(b)}


def shown_motion(bodies: tuple[Body, Body], duration: float, *, in_document: bool) -> Record:
    """Return what a record says of the motion, in a document or for a table.

    A table shows the pivots of the bodies that turn. Those of others, which documents tell, would
    cost a pass over their surfaces.
    """
    if in_document:
        return motion_part(bodies, duration)
    told = {
        name: body_part(body)
        for name, body in zip("ab", bodies, strict=True)
        if body.motion.is_turning and not body.motion.places_mesh
    }
    return {"duration": duration, **told}


def body_part(body: Body) -> Record:
    """Return pose and motion as understood; the shape is a tree or a mesh."""
    from obbcli.motion.body import pivot_of

    pose, motion = body.pose, body.motion
    if motion.places_mesh:
        return motion.told(pose, None)
    assert not isinstance(body.shape, (str, PathLike))
    return motion.told(pose, pivot_of(body, body.shape))


def stats_part(stats: QueryStats | OverlapStats) -> Record:
    """Return what a question cost."""
    part = stats._asdict()
    part["seconds"] = seconds_part(stats.seconds)
    return part


def seconds_part(seconds: Mapping[str, float]) -> dict[str, float]:
    """Return wall times by stage, in s."""
    return {stage: float(value) for stage, value in seconds.items()}


def note_rows(sources: Iterable[tuple[str, Record]]) -> list[tuple[str, str]]:
    """Return the rows of a table that say what of its inputs was taken with a change.

    Args:
        sources: what the table calls each input, and what the record says of it.
    """
    return [("note", f"{name}: {text}") for name, source in sources for text in source["notes"]]


def error_document(error: ObbError, code: int, trace: str | None = None) -> Record:
    """Return an error as its document.

    Args:
        error: what is told.
        code: the exit code.
        trace: the traceback, which stands in the document where it was asked for.
    """
    return _head("error") | {
        "error": error.fault,
        "kind": type(error).__name__,
        "code": code,
        "where": error.where or None,
        "remedy": error.remedy or None,
        **({} if trace is None else {"traceback": trace}),
    }


def finite(value: float) -> float | None:
    """Return a number that JSON can hold: None where it lies beyond the largest double."""
    return float(value) if math.isfinite(value) else None


def file_sha256(path: str | Path, as_of: tuple[int, ...] | None = None) -> str:
    """Return the SHA-256 of a file's bytes, in hexadecimal.

    Args:
        path: the file.
        as_of: `stamp_of` it, taken before it was read; None where that does not matter.

    Raises:
        ObbError: it is no longer the file that was read.
        OSError: the file cannot be read.
    """
    import hashlib

    digest = hashlib.sha256()
    with Path(path).open("rb") as file:
        while chunk := file.read(_CHUNK):
            digest.update(chunk)
    if as_of is not None and stamp_of(path) != as_of:
        raise ObbError(str(path), "changed while it was read", "ask again")
    return digest.hexdigest()
