"""What a scene is made of: bodies with names, and which of them are not asked about each other."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from obbcli.errors import SceneError
from obbcli.mesh.parts.placed import UniquePaths
from obbcli.motion.assembly import Assembly
from obbcli.motion.body import Body, Shape, as_body
from obbcli.spelling import known_keys, nearest

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy

# `{"bodies": [a, b]}`, `{"groups": [g]}` (within one group) or `{"groups": [g, h]}` (between two).
Ignore: TypeAlias = Mapping[str, Sequence[str]]
Bodies: TypeAlias = Mapping[str, Body | Shape] | Iterable["SceneBody"] | Assembly


@dataclass(frozen=True, init=False, eq=False)
class SceneBody:
    """A body of a scene.

    Args:
        name: what contacts call it; no other body of the scene has it.
        body: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        static: whether it stands still and is never asked about others that do.
        group: what `ignore` may call it together with others; None: it belongs to none.

    Raises:
        SceneError: a name is empty or no text, or a static body moves.
        MotionError: `body` is of another kind.
    """

    name: str
    body: Body
    static: bool
    group: str | None

    def __init__(
        self, name: str, body: Body | Shape, static: bool = False, group: str | None = None
    ) -> None:
        if not isinstance(name, str) or not name:
            raise SceneError("name", f"is {name!r}", "give each body a name")
        if not isinstance(static, bool):
            raise SceneError(f"body {name!r}: static", f"is {static!r}", "use true or false")
        if group is not None and (not isinstance(group, str) or not group):
            raise SceneError(f"body {name!r}: group", f"is {group!r}", "use a name")
        made = as_body(body)
        if static and not made.motion.is_at_rest:
            raise SceneError(
                f"body {name!r}", "is static and has a motion", "leave out one of the two"
            )
        put = object.__setattr__  # the dataclass is frozen to everybody else
        put(self, "name", name)
        put(self, "body", made)
        put(self, "static", static)
        put(self, "group", group)


class SceneParts(NamedTuple):
    """What a scene consists of.

    Attributes:
        bodies: in order, each of a name of its own.
        ignore: which of them are not asked about each other.
        duration: s; None in a file that leaves it to the default.
        accuracy: what is asked of each answer.
        solid: whether a body inside another at t = 0 is in contact with it.
    """

    bodies: tuple[SceneBody, ...]
    ignore: tuple[Ignore, ...]
    duration: float | None
    accuracy: Accuracy
    solid: bool = False


def as_bodies(bodies: Bodies) -> tuple[SceneBody, ...]:
    """Return the bodies of a scene.

    Raises:
        SceneError: there are none, two have one name, or one is no `SceneBody`.
        MotionError: one of a mapping is no body or shape.
    """
    if isinstance(bodies, Assembly):
        bodies = _parts_by_name(bodies)
    if isinstance(bodies, Mapping):
        made = tuple(SceneBody(name, body) for name, body in bodies.items())
    else:
        made = tuple(bodies)
    places: dict[str, int] = {}
    for place, body in enumerate(made):
        if not isinstance(body, SceneBody):
            raise SceneError(
                f"body[{place}]", f"is of type {type(body).__name__}", "pass SceneBody objects"
            )
        if body.name in places:
            raise SceneError(
                f"body[{place}]",
                f"is called {body.name!r} like body[{places[body.name]}]",
                "give each body a name of its own",
            )
        places[body.name] = place
    if not made:
        raise SceneError("scene", "has no bodies", "add some: [[body]] with name and mesh")
    return made


def _parts_by_name(assembly: Assembly) -> dict[str, Body | Shape]:
    """Return the parts of a file by their paths; one without is called as the file."""
    nameless = Path(assembly.source or "part").stem or "part"
    paths = UniquePaths()
    return {paths.take(part.path or nameless): part.body for part in assembly}


def as_ignored(ignore: Iterable[Ignore], bodies: tuple[SceneBody, ...]) -> tuple[Ignore, ...]:
    """Return what a scene ignores, checked.

    Raises:
        SceneError: an entry is not of the kinds that `Ignore` lists, or names what is not there.
    """
    names = {"bodies": [body.name for body in bodies]}
    names["groups"] = list(dict.fromkeys(body.group for body in bodies if body.group is not None))
    checked = []
    for place, entry in enumerate(ignore):
        where = f"ignore[{place}]"
        if not isinstance(entry, Mapping):
            raise SceneError(where, f"is {entry!r}", "name two bodies, or one or two groups")
        known_keys(entry, ("bodies", "groups"), where)
        if len(entry) != 1:
            raise SceneError(where, "names neither or both", "name two bodies, or groups")
        ((kind, words),) = entry.items()
        checked.append({kind: _ignored(words, kind, names[kind], f"{where}.{kind}")})
    return tuple(checked)


def _ignored(words: object, kind: str, names: list[str], where: str) -> list[str]:
    """Return the names of an entry."""
    wanted = "two bodies" if kind == "bodies" else "one group or two"
    is_list = isinstance(words, Sequence) and not isinstance(words, (str, bytes))
    if not is_list or not all(isinstance(word, str) for word in words):  # type: ignore[attr-defined]
        raise SceneError(where, f"is {words!r}", f"list {wanted} by name")
    found: list[str] = list(words)  # type: ignore[call-overload]
    if len(found) not in ((2,) if kind == "bodies" else (1, 2)) or len(set(found)) != len(found):
        raise SceneError(where, f"is {found!r}", f"list {wanted}")
    for word in found:
        if word not in names:
            fault = f"no body of the scene is {'called' if kind == 'bodies' else 'in group'} "
            raise SceneError(where, fault + repr(word), nearest(word, names))
    return found
