"""Which parts of a file a pattern selects, and what it says where that is none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, TypeVar

from obbcli.errors import MeshError
from obbcli.mesh.parts.pattern import Pattern, escaped

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from obbcli.mesh.parts.placed import PlacedPart


class _HasPath(Protocol):
    @property
    def path(self) -> str: ...


_Named = TypeVar("_Named", bound=_HasPath)

#: Parts that a file may have; instances multiply what it holds.
MOST_PARTS = 1 << 20
# More would hide what they are listed for; and of more, nearest names take seconds.
_MOST_LISTED = 8
_MOST_COMPARED = 5000


def listed_parts(parts: Iterable[PlacedPart], place: str) -> list[PlacedPart]:
    """Return the parts of a file.

    Raises:
        MeshError: there are none, or more than a million; `place` is the file's.
    """
    found = []
    for part in parts:
        found.append(part)
        if len(found) > MOST_PARTS:
            raise MeshError(place, f"has more than {MOST_PARTS} parts", "split the file")
    if not found:
        raise MeshError(place, "has no faces", "a mesh is a surface of triangles")
    return found


def selected(parts: Sequence[_Named], text: str, place: str) -> list[_Named]:
    """Return the parts that a pattern selects, in their order.

    Raises:
        MeshError: it selects none; the nearest names are told.
    """
    pattern = Pattern(text)
    found = [part for part in parts if pattern.takes(part.path)]
    if found:
        return found
    paths = [part.path for part in parts]
    raise MeshError(f"{place}#{text}", _fault(paths), _nearest(text, paths))


def _fault(paths: list[str]) -> str:
    if not any(paths):
        return "matches no part: the parts of this file have no names"
    return f"matches none of {len(paths)} parts"


def _nearest(text: str, paths: list[str]) -> str:
    """Return the names that may have been meant."""
    from difflib import get_close_matches

    below = [path for path in paths if Pattern(f"**/{text}").takes(path)]
    near = below[:_MOST_LISTED]
    words = "nearest are"
    if below:
        words = f"'**/{text}' matches"
    else:
        few = list(dict.fromkeys(filter(None, paths)))[:_MOST_COMPARED]
        by_name = {path.rpartition("/")[2]: path for path in reversed(few)}
        near = get_close_matches(text, few, n=_MOST_LISTED)
        names = get_close_matches(text.rpartition("/")[2], by_name, n=_MOST_LISTED)
        near = list(dict.fromkeys([*near, *(by_name[name] for name in names)]))[:_MOST_LISTED]
        if not near:
            near, words = few[:_MOST_LISTED], "the first are" if len(few) > 1 else "there is"
    if not near:
        return "leave out '#' and what follows, or write '#**' for all"
    more = f" and {len(below) - len(near)} more" if len(below) > len(near) else ""
    return f"{words} " + ", ".join(f"'{escaped(path)}'" for path in near) + more
