"""What releases of Open CASCADE's Python package (OCP 7.8 to 8.0) call by different names.

Imported in the worker process alone, as all modules that import OCP are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_AttributeIterator, TDF_ChildIterator
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

as_face: Any = getattr(TopoDS, "Face_s", None) or TopoDS.Face
as_edge: Any = getattr(TopoDS, "Edge_s", None) or TopoDS.Edge


def children(label: Any) -> Iterator[Any]:
    """Yield the labels directly below a label, in their order."""
    each = TDF_ChildIterator(label)
    while each.More():
        yield each.Value()
        each.Next()


def shapes_in(shape: Any, kind: Any) -> Iterator[Any]:
    """Yield the shapes of a kind in a shape, in its order, once for each place."""
    each = TopExp_Explorer(shape, kind)
    while each.More():
        yield each.Current()
        each.Next()


def name_of(label: Any) -> str:
    """Return the name of a label; empty where it has none that shows.

    Its attributes are looked at one by one: to look for a name that is not there is a fault of
    memory in OCP.
    """
    each = TDF_AttributeIterator(label)
    while each.More():
        attribute = each.Value()
        if isinstance(attribute, TDataStd_Name):
            return str(attribute.Get().ToExtString()).strip()
        each.Next()
    return ""


def matrix_of(location: Any) -> NDArray[np.float64] | None:
    """Return a location as a matrix (4, 4) applied to columns; None for the identity."""
    if location.IsIdentity():
        return None
    placed = location.Transformation()
    matrix = np.eye(4)
    for row in range(3):
        for column in range(4):
            matrix[row, column] = placed.Value(row + 1, column + 1)
    return matrix
