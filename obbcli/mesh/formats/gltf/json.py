"""Values of a glTF document, looked at before they are used, and the error that names a place."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from typing import TypeGuard

    from numpy.typing import NDArray

Json = dict[str, Any]


class NotAsExpectedError(Exception):
    """Something in the document is not what glTF says.

    Args:
        place: where, as JSON names it: `nodes[3].rotation`.
        fault: what was found and what was wanted.
        remedy: what to do about it.
    """

    def __init__(self, place: str, fault: str, remedy: str = "export it again") -> None:
        super().__init__(place, fault, remedy)
        self.place = place
        self.fault = fault
        self.remedy = remedy


def is_count(value: object) -> TypeGuard[int]:
    """Return whether a JSON value is a whole number that can count or index."""
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 2**53


def count_in(item: Json, key: str, place: str, default: int | None = None) -> int:
    """Return a count in a JSON object."""
    value = item.get(key, default)
    if not is_count(value):
        shown = "missing" if value is None else words_of(value)
        raise NotAsExpectedError(f"{place}.{key}", f"is {shown}, expected a whole number")
    return value


def list_in(item: Json, key: str, place: str) -> list[Any]:
    """Return a list in a JSON object, empty where there is none."""
    value = item.get(key, [])
    if not isinstance(value, list):
        raise NotAsExpectedError(f"{place}.{key}", "is no list")
    return value


def object_in(item: Json, key: str, place: str) -> Json:
    """Return an object in a JSON object, empty where there is none."""
    value = item.get(key, {})
    if not isinstance(value, dict):
        raise NotAsExpectedError(f"{place}.{key}", "is no object")
    return value


def numbers_in(
    item: Json, key: str, place: str, default: list[float], *, any_length: bool = False
) -> NDArray[np.float64]:
    """Return a list of finite numbers in a JSON object, as many as `default` has.

    Args:
        item: the object.
        key: of the list in it.
        place: of the object.
        default: what is returned where there is no such key.
        any_length: whether another number of numbers is taken as well.
    """
    value = item.get(key, default)
    if (
        not isinstance(value, list)
        or not (any_length or len(value) == len(default))
        or not all(isinstance(x, (int, float)) and not isinstance(x, bool) for x in value)
        or not all(abs(x) < 1e308 for x in value)
    ):
        count = "" if any_length else f"{len(default)} "
        raise NotAsExpectedError(f"{place}.{key}", f"expected {count}finite numbers")
    return np.array(value, dtype=np.float64)


def extension_of(item: Json, names: tuple[str, ...], place: str) -> tuple[str, Json] | None:
    """Return name and content of the first of these extensions that an object has."""
    extensions = object_in(item, "extensions", place)
    for name in names:
        if name in extensions:
            return name, object_in(extensions, name, f"{place}.extensions")
    return None


def words_of(value: object) -> str:
    """Return a JSON value as errors show it: of a long one, the kind."""
    if isinstance(value, dict | list):
        return "an object" if isinstance(value, dict) else "a list"
    text = f"'{value}'" if isinstance(value, str) else str(value)
    if isinstance(value, bool) or value is None:
        text = {True: "true", False: "false", None: "null"}[value]
    return text if len(text) <= 40 else f"{text[:40]}..."
