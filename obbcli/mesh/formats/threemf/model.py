"""A model part of a 3MF archive: its objects, and what its build places."""

from __future__ import annotations

import re
from array import array
from dataclasses import dataclass, field
from functools import cached_property
from math import isfinite
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.source import MeshArrays

MICROSOFT = "http://schemas.microsoft.com/3dmanufacturing/"
CORE = MICROSOFT + "core/2015/02"
PRODUCTION = MICROSOFT + "production/2015/06"
SLICES = MICROSOFT + "slice/2015/07"
TRIANGLE_SETS = MICROSOFT + "trianglesets/2021/07"
#: Extensions that add no surface, or that are read: materials, production, and those whose
#: elements are refused where they make surface.
READ = frozenset(
    [
        *(CORE, PRODUCTION, SLICES, TRIANGLE_SETS, MICROSOFT + "material/2015/02"),
        *(MICROSOFT + "beamlattice/2017/02", MICROSOFT + "beamlattice/balls/2020/07"),
    ]
)
#: Units of the core specification, 3.4, by our names.
UNIT_NAMES = {
    "micron": "um",
    "millimeter": "mm",
    "centimeter": "cm",
    "inch": "in",
    "foot": "ft",
    "meter": "m",
}
#: What may stand in what, of the core specification.
INSIDE = {
    "": {"model"},
    "model": {"metadata", "resources", "build"},
    "resources": {"object", "basematerials"},
    "basematerials": {"base"},
    "object": {"mesh", "components", "metadatagroup"},
    "metadatagroup": {"metadata"},
    "mesh": {"vertices", "triangles"},
    "vertices": {"vertex"},
    "triangles": {"triangle"},
    "components": {"component"},
    "build": {"item"},
    "item": {"metadatagroup"},
}
_NUMBER = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*", re.ASCII)
_INDEX = re.compile(r"\s*\+?0*\d{1,10}\s*", re.ASCII)


class NoNumberError(ValueError):
    """A word spells no number; the argument tells of it."""


class Placement(NamedTuple):
    """Places an object: an item of the build, or a component.

    Attributes:
        object_id: of the object.
        part: the model part that holds it; empty for the same one.
        matrix: (4, 4), applied to columns; None for the identity.
        line: where it stands.
    """

    object_id: str
    part: str
    matrix: NDArray[np.float64] | None
    line: int


@dataclass
class Object:
    """Holds an object: a mesh or components.

    Attributes:
        name: as people call it; may be empty.
        kind: what it is for; "model" where nothing else is said.
        line: where it stands.
        components: what it is made of.
        numbers: coordinates of its vertices, end to end.
        corners: of its triangles, end to end.
        unread: an element of it that may make surface and is not read, and its line.
    """

    name: str
    kind: str
    line: int
    components: list[Placement] = field(default_factory=list)
    numbers: array[float] = field(default_factory=lambda: array("d"))
    corners: array[int] = field(default_factory=lambda: array("q"))
    unread: tuple[str, int] | None = None

    @cached_property
    def arrays(self) -> MeshArrays:
        """Vertices (V, 3) and triangles (F, 3)."""
        vertices = np.array(self.numbers, dtype=np.float64).reshape(-1, 3)
        return vertices, np.array(self.corners, dtype=np.int64).reshape(-1, 3)

    def decode(self) -> MeshArrays:
        """Return vertices and triangles, made once."""
        return self.arrays


@dataclass
class Model:
    """Holds a model part.

    Attributes:
        part: its name in the archive.
        unit: of length, by our names.
        objects: by their ids.
        items: what the build places, in order.
    """

    part: str
    unit: str = "mm"
    objects: dict[str, Object] = field(default_factory=dict)
    items: list[Placement] = field(default_factory=list)


def number(word: str) -> float:
    """Return the finite number that a word spells.

    Raises:
        NoNumberError: it spells none.
    """
    value = float(word) if _NUMBER.fullmatch(word) else np.nan
    if not isfinite(value):
        raise NoNumberError(f"'{shown(word.encode())}' is not a number")
    return value


def index(word: str, count: int) -> int:
    """Return the number of a vertex, of which there are so many.

    Raises:
        NoNumberError: it spells no number of a vertex.
    """
    if not _INDEX.fullmatch(word):
        raise NoNumberError(f"'{shown(word.encode())}' is not the number of a vertex")
    value = int(word.strip().lstrip("+0") or "0")
    if value >= count:
        raise NoNumberError(f"a triangle names vertex {value}, the last one is {count - 1}")
    return value


def matrix_of(text: str | None) -> NDArray[np.float64] | None:
    """Return the matrix (4, 4) of a `transform`, which lists four rows applied to rows of points.

    Raises:
        NoNumberError: not twelve numbers.
    """
    if text is None:
        return None
    values = [number(word) for word in text.split()]
    if len(values) != 12:
        raise NoNumberError(f"a transform has {len(values)} numbers, expected 12")
    matrix = np.eye(4)
    matrix[:3] = np.array(values).reshape(4, 3).T
    return matrix
