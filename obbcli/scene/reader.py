"""Scene files: TOML or JSON, all keys known, all values of their kinds, or one clear error.

`duration`, `solid`, `unit`, `accuracy = {..}` with the fields of `Accuracy`, `[[body]]` with
`name`, `mesh` (a path from the file's folder on), `unit`, `scale`, `weld`, `static`, `group`,
`pose = {rotation, translation}`, `motion = {linear_velocity, angular_velocity, pivot}` or `{times,
poses}`, and `[[ignore]]` with `bodies` or `groups`.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from obbcli.accuracy import Accuracy
from obbcli.errors import ObbError, SceneError
from obbcli.mesh.measured_file import MeasuredFile
from obbcli.mesh.units import checked_unit
from obbcli.motion.body import Body
from obbcli.motion.motion import Motion
from obbcli.motion.pose import Pose
from obbcli.scene.bodies import SceneBody, SceneParts, as_ignored
from obbcli.scene.values import above_zero, finite_number, shown
from obbcli.spelling import known_keys

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable


T = TypeVar("T")

# Some 300,000 bodies. To find out that something longer is no scene would take minutes.
_MOST_BYTES = 64 << 20
_LONG_NUMBER = "a number has too many digits"
_KEYS = ("duration", "accuracy", "solid", "unit", "body", "ignore")
_BODY_KEYS = ("name", "mesh", "unit", "scale", "weld", "sag", "pose", "motion", "static", "group")
_CONSTANT_KEYS = ("linear_velocity", "angular_velocity", "pivot")
_PATH_KEYS = ("times", "poses")
_ACCURACY_KEYS = tuple(Accuracy().as_dict())


def read_scene(path: str | os.PathLike[str]) -> SceneParts:
    """Return what stands in a scene file.

    Raises:
        SceneError: it cannot be read or is refused; the message names line or key.
    """
    place = str(path)
    data = read_bytes(Path(path), place)
    return parse_scene(data, place, Path(path).parent, is_json=place.lower().endswith(".json"))


def parse_scene(data: bytes, place: str, folder: Path, *, is_json: bool = False) -> SceneParts:
    """Return what stands in the bytes of a scene file.

    Args:
        data: the bytes.
        place: what errors call them.
        folder: where the paths of meshes begin.
        is_json: whether it is known to be JSON; else that shows by its first letter.

    Raises:
        SceneError: it is refused; the message names line or key.
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        line = data.count(b"\n", 0, fault.start) + 1
        raise SceneError(f"{place}:{line}", "is no text in UTF-8", "name a scene file") from fault
    parse = _parse_json if is_json or text.lstrip()[:1] == "{" else _parse_toml
    try:
        tree = parse(text, place)
    except RecursionError as fault:
        raise SceneError(place, "is nested too deeply", "a scene needs a few levels") from fault
    return _Reader(place, folder).scene(tree)


def read_bytes(path: Path, place: str) -> bytes:
    """Return a scene file's bytes.

    Raises:
        SceneError: it cannot be read, or is too long for a scene; `place` is the place named.
    """
    try:
        if path.is_dir():
            raise SceneError(place, "is a folder", "name a scene file")
        if path.is_file() and path.stat().st_size > _MOST_BYTES:
            raise _too_long(place, path.stat().st_size)
        with path.open("rb") as file:
            data = file.read(_MOST_BYTES + 1)
    except FileNotFoundError as fault:
        raise SceneError(place, "no such file", "check the path") from fault
    except OSError as fault:
        reason = fault.strerror or str(fault)
        raise SceneError(place, f"cannot be read: {reason}", "check the path") from fault
    if len(data) > _MOST_BYTES:
        raise _too_long(place, len(data))
    return data


def _too_long(place: str, size: int) -> SceneError:
    fault = f"is {size} bytes or more, a scene file has at most {_MOST_BYTES}"
    return SceneError(place, fault, "split it, or build the scene in Python")


def _parse_toml(text: str, place: str) -> dict[str, Any]:
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    try:
        tree: dict[str, Any] = tomllib.loads(text)
    except tomllib.TOMLDecodeError as fault:
        found = re.fullmatch(
            r"(.*) \(at (?:line (\d+), column \d+|(end of document))\)", str(fault)
        )
        if found is None:
            raise SceneError(place, f"is no TOML: {fault}") from fault
        line = found[2] or text.count("\n") + 1
        raise SceneError(f"{place}:{line}", f"is no TOML: {found[1]}") from fault
    except ValueError as fault:  # Python reads no whole number of so many digits
        raise SceneError(place, f"is no TOML: {_LONG_NUMBER}") from fault
    return tree


def _parse_json(text: str, place: str) -> dict[str, Any]:
    import json

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        made = dict(pairs)
        if len(made) < len(pairs):
            keys = [key for key, _ in pairs]
            twice = next(key for key in keys if keys.count(key) > 1)
            raise SceneError(place, f"has the key {twice!r} twice in one object", "keep one")
        return made

    try:
        tree = json.loads(text, object_pairs_hook=unique)
    except json.JSONDecodeError as fault:
        words = f"is no JSON from column {fault.colno} on"
        raise SceneError(f"{place}:{fault.lineno}", words) from fault
    except ObbError:
        raise
    except ValueError as fault:
        raise SceneError(place, f"is no JSON: {_LONG_NUMBER}") from fault
    if not isinstance(tree, dict):
        raise SceneError(place, "is no JSON object", 'begin with {"body": [..]}')
    return tree


class _Reader:
    """Makes bodies of what a parser made of a file.

    Args:
        place: of the file.
        folder: where the paths of meshes begin.
    """

    def __init__(self, place: str, folder: Path) -> None:
        self._place = place
        self._folder = folder
        self._unit: str | None = None

    def scene(self, tree: dict[str, Any]) -> SceneParts:
        known_keys(tree, _KEYS, self._place)
        self._unit = self._named("", checked_unit, tree["unit"]) if "unit" in tree else None
        bodies = self._bodies(self._tables(tree, "body"))
        ignore = self._tables(tree, "ignore")
        accuracy = tree.get("accuracy", {})
        where = self._at("accuracy")
        self._table(accuracy, _ACCURACY_KEYS, where)
        duration, solid = tree.get("duration"), tree.get("solid", False)
        if not isinstance(solid, bool):
            raise SceneError(self._at("solid"), f"is {shown(solid)}", "use true or false")
        return SceneParts(
            bodies,
            self._named("", as_ignored, ignore, bodies),
            None if duration is None else finite_number(duration, self._at("duration"), least=0),
            self._named("accuracy.", Accuracy, **accuracy),
            solid,
        )

    def _bodies(self, tables: list[dict[str, Any]]) -> tuple[SceneBody, ...]:
        from obbcli.scene.bodies import as_bodies

        bodies = [self._body(table, f"body[{place}]") for place, table in enumerate(tables)]
        return self._named("", as_bodies, bodies)

    def _body(self, table: dict[str, Any], key: str) -> SceneBody:
        name = table.get("name")
        if isinstance(name, str):
            key = f"{key} {name!r}"
        self._table(table, _BODY_KEYS, self._at(key))
        for needed in ("name", "mesh"):
            if not isinstance(table.get(needed), str) or not table[needed]:
                found = f"is {table[needed]!r}" if needed in table else "is missing"
                raise SceneError(self._at(f"{key}.{needed}"), found, f"give each body a {needed}")
        if "\0" in table["mesh"]:
            raise SceneError(self._at(f"{key}.mesh"), "holds a zero byte", "give a path")
        mesh = self._folder / table["mesh"]
        if mesh.suffix.lower() in (".toml", ".json"):
            fault = f"is {table['mesh']!r}, no mesh or tree file"
            raise SceneError(self._at(f"{key}.mesh"), fault, "scenes do not hold scenes")
        pose = self._pose(table.get("pose", {}), f"{key}.pose")
        motion = self._motion(table.get("motion", {}), f"{key}.motion")
        shape = self._measured(str(mesh), table, key)
        body = self._named(f"{key}.", Body, shape, pose, motion)
        return self._named(
            "", SceneBody, name, body, table.get("static", False), table.get("group")
        )

    def _measured(self, mesh: str, table: dict[str, Any], key: str) -> MeasuredFile | str:
        """Return a body's file, and how its coordinates are taken."""
        own = table.get("unit")
        if "unit" in table:
            self._named(f"{key}.", checked_unit, own)
        scale, weld, sag = (
            above_zero(table[name], self._at(f"{key}.{name}")) if name in table else None
            for name in ("scale", "weld", "sag")
        )
        if scale is not None and own is not None:
            fault = "has unit and scale, of which the second takes the place of the first"
            raise SceneError(self._at(key), fault, "keep one")
        measures = (self._unit, own, scale, weld, sag)
        return mesh if measures == (None,) * 5 else MeasuredFile(mesh, *measures)

    def _pose(self, table: Any, key: str) -> Pose:
        self._table(table, ("rotation", "translation"), self._at(key))
        parts = {name: self._vector(value, f"{key}.{name}") for name, value in table.items()}
        return self._named(f"{key}.", Pose, **parts)

    def _motion(self, table: Any, key: str) -> Motion:
        self._table(table, (*_CONSTANT_KEYS, *_PATH_KEYS), self._at(key))
        path = [name for name in _PATH_KEYS if name in table]
        if not path:
            parts = {name: self._vector(value, f"{key}.{name}") for name, value in table.items()}
            return self._named(f"{key}.", Motion, **parts)
        other = [name for name in _CONSTANT_KEYS if name in table]
        if other or len(path) == 1:
            fault = f"has {path[0]} " + (f"and {other[0]}" if other else "alone")
            raise SceneError(self._at(key), fault, "give times and poses, or velocities")
        times, poses = table["times"], table["poses"]
        if not isinstance(times, list) or not isinstance(poses, list):
            raise SceneError(self._at(key), "times and poses are no lists", "list as many of both")
        numbers = [
            finite_number(time, self._at(f"{key}.times[{k}]")) for k, time in enumerate(times)
        ]
        made = [self._pose(pose, f"{key}.poses[{k}]") for k, pose in enumerate(poses)]
        return self._named(f"{key}.", Motion.through, numbers, made)

    def _vector(self, value: Any, key: str) -> list[float]:
        where = self._at(key)
        if not isinstance(value, list) or len(value) != 3:
            raise SceneError(where, f"is {shown(value)}", "list three numbers")
        return [finite_number(number, f"{where}[{k}]") for k, number in enumerate(value)]

    def _tables(self, tree: dict[str, Any], key: str) -> list[dict[str, Any]]:
        """Return an array of tables."""
        tables = tree.get(key, [])
        if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
            raise SceneError(self._at(key), f"is {shown(tables)}", f"write [[{key}]]")
        return tables

    @staticmethod
    def _table(value: Any, keys: Iterable[str], where: str) -> None:
        """Refuse what is no table, and keys that are not known."""
        if not isinstance(value, dict):
            raise SceneError(where, f"is {shown(value)}", "write a table: { key = value }")
        known_keys(value, tuple(keys), where)

    def _at(self, key: str) -> str:
        return f"{self._place}: {key}"

    def _named(self, key: str, make: Callable[..., T], *values: Any, **parts: Any) -> T:
        """Return what `make` makes; its errors name the file and the key."""
        try:
            return make(*values, **parts)
        except ObbError as fault:
            where = self._at(f"{key}{fault.where}")
            raise SceneError(where, fault.fault, fault.remedy) from fault
