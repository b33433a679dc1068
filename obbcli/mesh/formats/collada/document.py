"""A COLLADA document: its elements by id, its unit and its axes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.collada.values import Values
from obbcli.mesh.formats.safe_xml import document
from obbcli.mesh.formats.text import shown
from obbcli.mesh.units import UNITS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.safe_xml import Element
    from obbcli.mesh.source import Source

#: Lengths written with the digits of a float32 are those of the unit.
_DIGITS = 1e-6
_IN_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "um": 1e-6, "in": 0.0254, "ft": 0.3048}
assert _IN_METRES.keys() == UNITS.keys()
#: Rows of rotations to right, back and up along x, y and z, by the axis that is up (1.4.1, 5-18).
_TURNS = {
    "X_UP": ("X", [[0, -1, 0], [0, 0, -1], [1, 0, 0]]),
    "Y_UP": ("Y", [[1, 0, 0], [0, 0, -1], [0, 1, 0]]),
    "Z_UP": ("Z", None),
}
_VERSIONS = ("1.4", "1.5")


class Document:
    """Gives the elements of a document.

    Args:
        source: the file, which is told the unit.

    Attributes:
        root: the element `COLLADA`.
        values: takes numbers out of elements.
        world: (4, 4), from the document's coordinates to those of the mesh; None: the identity.

    Raises:
        MeshError: no whole XML, no COLLADA, another version, a unit or axis that is not known.
    """

    def __init__(self, source: Source) -> None:
        self.source = source
        self.values = Values(source)
        self.root = document(source)
        if self.root.name != "COLLADA":
            raise source.error("is XML, but no COLLADA document", "export it again")
        version = self.root.get("version")
        if version and version[:3] not in _VERSIONS:
            fault = f"is COLLADA {shown(version.encode())}, only 1.4 and 1.5 are read"
            raise self.values.error(self.root, fault, "convert it to COLLADA 1.4")
        self._by_id: dict[str, Element] = {}
        # Cameras and lights of real files often share one, to which nothing links that is read.
        self._shared: dict[str, Element] = {}
        for element in self.root.below():
            key = element.get("id")
            if key and self._by_id.setdefault(key, element) is not element:
                self._shared[key] = element
        self.world = self._world()

    def linked(self, element: Element, attribute: str, *names: str) -> Element:
        """Return the element that an attribute links to, which must have one of some names."""
        key = self.values.link(element, attribute)
        if key in self._shared:
            fault = f"two elements have the id '{_name(key)}'"
            raise self.values.error(self._shared[key], fault)
        found = self._by_id.get(key)
        if found is None or found.name not in names:
            is_what = "is not there" if found is None else f"is a <{found.name}>"
            fault = f"<{element.name}> links to the <{names[0]}> '{_name(key)}', which {is_what}"
            raise self.values.error(element, fault)
        return found

    def _world(self) -> NDArray[np.float64] | None:
        """State the unit, and return how the document is turned and scaled."""
        asset = self.root.first("asset")
        metres, up = self._stated(asset)
        metres = 1.0 if metres is None else metres
        up = "Y_UP" if up is None else up
        for other in self.root.below():
            if other.name == "asset" and other is not asset:
                theirs = self._stated(other)
                if theirs[0] not in (None, metres) or theirs[1] not in (None, up):
                    fault = "an <asset> inside states another unit or axis than the document"
                    raise self.values.error(other, fault, "export it in one unit, with one axis up")
        matrix = np.eye(4)
        axis, turn = _TURNS[up]
        if turn is not None:
            matrix[:3, :3] = turn
            self.source.note(f"turned from {axis} up to Z up")
        near = [unit for unit, is_long in _IN_METRES.items() if _is_near(metres, is_long)]
        self.source.state_unit(near[0] if near else "m")
        if not near:
            matrix[:3] *= metres
            self.source.note(f"from units of {metres:.12g} m to m: coordinates times that")
        return None if turn is None and near else matrix

    def _stated(self, asset: Element | None) -> tuple[float | None, str | None]:
        """Return the unit in metres and the axis that an asset states, each if it does."""
        unit = None if asset is None else asset.first("unit")
        up = None if asset is None else asset.first("up_axis")
        metres = None
        if unit is not None and unit.get("meter"):
            word = unit.get("meter").strip()
            try:
                metres = math.nan if "_" in word else float(word)
            except ValueError:
                metres = math.nan
            if not 0.0 < metres < math.inf:
                fault = f"the unit is '{_name(word)}' metres long, expected a number above 0"
                raise self.values.error(unit, fault)
        axis = None if up is None or not up.text.strip() else up.text.strip()
        if axis is not None and axis not in _TURNS:
            assert up is not None
            fault = f"the axis '{_name(axis)}' is up, expected one of {', '.join(_TURNS)}"
            raise self.values.error(up, fault)
        return metres, axis


def _is_near(metres: float, length: float) -> bool:
    return abs(metres - length) <= _DIGITS * length


def _name(text: str) -> str:
    return shown(text.encode())
