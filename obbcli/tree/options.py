"""How trees are built, with defaults and checks, and what a tree says of how it was made."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from obbcli.errors import MeshError

if TYPE_CHECKING:
    from obbcli.mesh import PartRows

Fit: TypeAlias = Literal["triangles", "points", "hull", "min-volume", "axis-aligned"]
Split: TypeAlias = Literal["median", "center", "compact"]

FITS: dict[Fit, str] = {
    "triangles": "by the triangles' areas",
    "points": "by their corners",
    "hull": "by their hull's area",
    "min-volume": "for the least volume",
    "axis-aligned": "not at all",
}
"""How each orients a box, as help says it; by the names of the kernels' `Fit`."""
SPLITS: dict[Split, str] = {
    "median": "at the median triangle",
    "center": "at the center",
    "compact": "into the smallest parts",
}
"""How each parts a box; by the names of the kernels' `Split`."""
_HULL_FITS: tuple[Fit, ...] = ("hull", "min-volume")
# What kernels take for no limit.
_NO_LIMIT = 2**32 - 1


class BuildOptions(NamedTuple):
    """How a tree is built, as `ObbTree.build` takes it.

    Attributes:
        fit: how boxes are oriented.
        split: how they are parted.
        leaf_size: a node of so many triangles is not split.
        max_depth: nodes this deep are not split; the root's depth is 0. None: no limit.
    """

    fit: Fit = "triangles"
    split: Split = "compact"
    leaf_size: int = 1
    max_depth: int | None = None

    @property
    def needs_hulls(self) -> bool:
        """Return whether each box takes a convex hull: several times the time and memory."""
        return self.fit in _HULL_FITS

    def checked(self) -> BuildOptions:
        """Return the options as plain Python has them; NumPy's integers are welcome.

        Raises:
            MeshError: one of them is of the wrong type or out of range.
        """
        _one_of("fit", self.fit, tuple(FITS))
        _one_of("split", self.split, tuple(SPLITS))
        depth = None if self.max_depth is None else _whole("max_depth", self.max_depth, 0)
        size = _whole("leaf_size", self.leaf_size, 1)
        return self._replace(leaf_size=size, max_depth=depth)


DEFAULT_BUILD = BuildOptions()
"""The tree of every question whose body comes as a mesh."""


@dataclass(frozen=True, kw_only=True)
class Description:
    """How a tree was made, and from what.

    Attributes:
        fit: how boxes were oriented.
        split: how nodes were parted.
        leaf_size: a node of so many triangles is a leaf.
        max_depth: the depth at which a node is a leaf; None: no limit.
        source: name of the mesh file; None for a mesh made in code.
        source_sha256: SHA-256 of the mesh file's bytes, hexadecimal; None for a
            mesh made in code.
        tool_version: the obbtree that built it.
        notes: what of the mesh file was taken with a change, a sentence each.
        unit: the length of 1 that the mesh file states; None where it states none.
        parts: the parts of the mesh file that were selected; empty where all was taken.
        sag: how far triangles are at most from exact surfaces of the mesh file, mesh units; None
            where it holds triangles.
        spacing: how far apart the mesh file's coordinates were, in mesh units since, where they
            were scaled; else None.
    """

    fit: Fit
    split: Split
    leaf_size: int
    max_depth: int | None
    source: str | None
    source_sha256: str | None
    tool_version: str
    notes: tuple[str, ...] = ()
    unit: str | None = None
    parts: tuple[PartRows, ...] = ()
    sag: float | None = None
    spacing: float | None = None


def kernel_limits(leaf_size: int, max_depth: int | None) -> tuple[int, int]:
    """Return when nodes are leaves, in numbers that kernels can hold."""
    depth = _NO_LIMIT if max_depth is None else max_depth
    return min(leaf_size, _NO_LIMIT), min(depth, _NO_LIMIT)


def _one_of(name: str, value: object, words: tuple[str, ...]) -> None:
    if not isinstance(value, str) or value not in words:
        raise MeshError(name, f"is {value!r}", "use one of " + ", ".join(words))


def _whole(name: str, value: object, least: int) -> int:
    try:
        number = operator.index(value)  # type: ignore[arg-type]  # whatever is no integer raises here
    except TypeError:
        number = least - 1
    if isinstance(value, bool) or number < least:
        raise MeshError(name, f"is {value!r}", f"use a whole number of at least {least}")
    return number
