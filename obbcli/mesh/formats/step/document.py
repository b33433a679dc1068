"""A STEP file as Open CASCADE reads it: its products, where they are placed, and what was lost."""

from __future__ import annotations

import io
from math import nextafter
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

import numpy as np
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.STEPConstruct import STEPConstruct_ExternRefs
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE, TopAbs_SOLID
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from obbcli.mesh.formats.step.losses import (
    PLACED,
    is_solid,
    makes_surface,
    refuse_losses,
    refuse_unread,
)
from obbcli.mesh.formats.step.occ import children, matrix_of, name_of, shapes_in
from obbcli.mesh.formats.step.refusal import StepError
from obbcli.mesh.formats.step.units import length_of
from obbcli.mesh.parts.selection import MOST_PARTS

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.formats.step.units import Length

#: Tessellations that files carry beside exact surfaces are not read a second time.
_TESSELLATED = "read.step.tessellated", "OnNoBRep"
#: Assemblies that stand in one another.
_DEEPEST = 100
#: Documents that products refer to and that hold no shape.
_PAPERS = (".pdf", ".doc", ".docx", ".txt", ".xls", ".xlsx", ".csv", ".html", ".png", ".jpg")
_MOST_LISTED = 8
_HEAD_BYTES = 1 << 16


class Node(NamedTuple):
    """A product where the file places it: a part, or an assembly of those that follow deeper.

    Attributes:
        depth: 0 at the root.
        name: of the instance, of the product where that has none; empty where neither has.
        product: the number of the product among those that have faces; None for an assembly.
        matrix: (4, 4), from the product to the assembly that it is in; None for the identity.
    """

    depth: int
    name: str
    product: int | None
    matrix: NDArray[Any] | None


class StepDocument:
    """Holds the products of a file that have faces.

    Args:
        data: the file.

    Attributes:
        length: the unit of its coordinates.
        nodes: what the file places, depth first in its order.
        shapes: the exact shape of each product that has faces.
        names: of each of them.
        notes: what is taken with a change.

    Raises:
        StepError: it is no whole STEP file, no product has a face, or something was lost.
    """

    def __init__(self, data: bytes) -> None:
        reader = STEPCAFControl_Reader()
        Interface_Static.SetCVal_s(*_TESSELLATED)
        if reader.ReadStream("STEP", io.BytesIO(data)) != IFSelect_RetDone:
            raise StepError("is no whole STEP file", "export it again")
        basic = reader.ChangeReader()
        model = basic.StepModel()
        entities = [model.Value(k + 1) for k in range(model.NbEntities())]
        _refuse_other_files(basic.WS())
        if not makes_surface(entities):
            _refuse_empty(data)
        refuse_unread(model, entities, data)
        self.length: Length = length_of(entities)
        document = _empty_document(self.length.asked)
        if not reader.Transfer(document):
            raise StepError("cannot be translated", "export it again, or as STL")
        made = refuse_losses(basic.WS().TransferReader().TransientProcess(), entities, data)
        self._owners = document, reader  # of what labels and shapes are parts of
        self.shapes: list[Any] = []
        self.names: list[str] = []
        self._numbers: dict[int, int | None] = {}
        self._ids = _ids_for_names(entities)
        self.nodes = list(self._roots(XCAFDoc_DocumentTool.ShapeTool_s(document.Main())))
        if not self.shapes:
            _refuse_empty(data)
        kept = sum(1 for shape in self.shapes for _ in shapes_in(shape, TopAbs_FACE))
        if kept < made:
            fault = f"has {made:,} faces, of which the products have {kept:,}: some would be lost"
            raise StepError(fault, "export it again, or as STL")
        self.notes = (*self.length.notes, *self._of_solids(entities))

    def _of_solids(self, entities: Iterable[Any]) -> Iterator[str]:
        """Yield a note where the library makes shells of what the file calls solids."""
        told = sum(is_solid(entity) for entity in entities)
        found = sum(1 for shape in self.shapes for _ in shapes_in(shape, TopAbs_SOLID))
        if found < told:
            yield f"solids that do not close, taken as surfaces: {told - found} of {told}"

    def _roots(self, tool: Any) -> Iterator[Node]:
        visits = 0
        for label in children(tool.Label()):
            if XCAFDoc_ShapeTool.IsShape_s(label) and XCAFDoc_ShapeTool.IsFree_s(label):
                for node in self._below(label, Node(0, name_of(label), None, None)):
                    visits += 1
                    if visits > MOST_PARTS:
                        raise StepError(f"places more than {MOST_PARTS} products", "split the file")
                    yield node

    def _below(self, label: Any, node: Node) -> Iterator[Node]:
        """Yield a product where it is placed, and what it is assembled of."""
        if not XCAFDoc_ShapeTool.IsAssembly_s(label):
            number = self._product(label)
            if number is not None:
                yield node._replace(product=number)
            return
        if node.depth > _DEEPEST:
            raise StepError(f"nests assemblies more than {_DEEPEST} deep", "split the file")
        yield node
        for component in children(label):
            if not XCAFDoc_ShapeTool.IsComponent_s(component):
                continue
            product = TDF_Label()
            XCAFDoc_ShapeTool.GetReferredShape_s(component, product)
            name = name_of(component)
            if not name or name in self._ids:
                name = name_of(product)
            matrix = matrix_of(XCAFDoc_ShapeTool.GetLocation_s(component))
            if matrix is not None:
                matrix[:3, 3] = np.ldexp(matrix[:3, 3], -self.length.exponent)
            yield from self._below(product, Node(node.depth + 1, name, None, matrix))

    def _product(self, label: Any) -> int | None:
        """Return the number of a product; None where it has no faces."""
        tag = label.Tag()
        if tag not in self._numbers:
            shape = XCAFDoc_ShapeTool.GetShape_s(label)
            has_faces = not shape.IsNull() and any(True for _ in shapes_in(shape, TopAbs_FACE))
            self._numbers[tag] = len(self.shapes) if has_faces else None
            if has_faces:
                self.shapes.append(shape)
                self.names.append(name_of(label))
        return self._numbers[tag]


def _ids_for_names(entities: Iterable[Any]) -> set[str]:
    """Return what the library calls instances that have no name: their ids, such as `NAUO1`."""
    names: set[str] = set()
    ids: set[str] = set()
    for entity in entities:
        if entity.DynamicType().Name() == PLACED:
            name = str(entity.Name().ToCString()).strip() if entity.Name() is not None else ""
            (names if name else ids).add(name or str(entity.Id().ToCString()))
    return ids - names


def _empty_document(millimetres: float) -> Any:
    """Return a document in a unit of length, so that coordinates in that unit are not rounded."""
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    XCAFDoc_ShapeTool.SetAutoNaming_s(False)
    metres = millimetres / 1000.0
    near = (metres, nextafter(metres, 0.0), nextafter(metres, 1.0))
    exact = next((length for length in near if length * 1000.0 == millimetres), metres)
    XCAFDoc_DocumentTool.SetLengthUnit_s(document, exact)
    return document


def _refuse_other_files(session: Any) -> None:
    """Refuse a file whose products lie in other files, which are not opened."""
    references = STEPConstruct_ExternRefs(session)
    references.LoadExternRefs()
    names = [str(references.FileName(k + 1)) for k in range(references.NbExternRefs())]
    shapes = [name for name in names if name and not name.lower().endswith(_PAPERS)]
    if shapes:
        listed = ", ".join(dict.fromkeys(shapes[:_MOST_LISTED]))
        more = " and more" if len(shapes) > _MOST_LISTED else ""
        remedy = "export the assembly into one file, or name the files of its parts"
        raise StepError(f"has parts in other files, which are not read: {listed}{more}", remedy)


def _refuse_empty(data: bytes) -> NoReturn:
    """Refuse a file none of whose products has a face."""
    if b"STRUCTURAL_ANALYSIS" in data[:_HEAD_BYTES].upper():
        fault = "is a finite element model (AP209), which has no solid or face"
        raise StepError(fault, "export its shape as AP214 or AP242")
    remedy = "export solids or surfaces: wires, points and drawings have none"
    raise StepError("has no faces: no product has a surface", remedy)
