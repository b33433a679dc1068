"""VTK behind the face of a contestant."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from contestant import Query, unique_pairs

if TYPE_CHECKING:
    from pathlib import Path

    from meshes.surfaces import Surface
    from numpy.typing import NDArray
    from scenes.pairs import Pair


class Vtk:
    """VTK's collision filter over its OBB trees: it makes these anew, when it is first asked."""

    name = "VTK"

    def build(self, surface: Surface) -> Any:
        """Return the `vtkPolyData`, and the `vtkOBBTree` over it that the filter makes as well."""
        from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
        from vtkmodules.vtkCommonCore import vtkPoints
        from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
        from vtkmodules.vtkFiltersGeneral import vtkOBBTree

        points, cells, data = vtkPoints(), vtkCellArray(), vtkPolyData()
        points.SetData(numpy_to_vtk(np.ascontiguousarray(surface.vertices), deep=True))
        rows = np.ascontiguousarray(surface.faces, dtype=np.int64).ravel()
        cells.SetData(3, numpy_to_vtkIdTypeArray(rows, deep=True))
        data.SetPoints(points)
        data.SetPolys(cells)
        tree = vtkOBBTree()
        tree.SetDataSet(data)
        tree.BuildLocator()
        return data, tree

    def query(self, model_a: Any, model_b: Any, pair: Pair) -> Query:
        """Ask a `vtkCollisionDetectionFilter`, to the first contact or to all."""
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonMath import vtkMatrix4x4
        from vtkmodules.vtkFiltersModeling import vtkCollisionDetectionFilter

        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = pair.rotation, pair.translation
        placed = vtkMatrix4x4()
        placed.DeepCopy(pose.ravel().tolist())
        one, many = vtkCollisionDetectionFilter(), vtkCollisionDetectionFilter()
        for question in (one, many):
            question.SetInputData(0, model_a[0])
            question.SetInputData(1, model_b[0])
            question.SetMatrix(0, vtkMatrix4x4())
            question.SetMatrix(1, placed)
            question.GenerateScalarsOff()
        one.SetCollisionModeToFirstContact()
        many.SetCollisionModeToAllContacts()

        def ask(question: Any) -> int:
            question.Modified()
            question.Update()
            return int(question.GetNumberOfContacts())

        def triangle_pairs() -> NDArray[np.int64]:
            if ask(many) == 0:
                return unique_pairs(())
            return unique_pairs(
                np.column_stack([vtk_to_numpy(many.GetContactCells(i)) for i in (0, 1)])
            )

        def counts() -> dict[str, object]:
            ask(one)
            return {"box tests": one.GetNumberOfBoxTests()}

        return Query(collides=lambda: ask(one) > 0, triangle_pairs=triangle_pairs, counts=counts)

    def nbytes(self, model: Any) -> int | None:  # noqa: ARG002
        """Return None: it does not say."""
        return None

    def save(self, model: Any, path: Path) -> int | None:  # noqa: ARG002
        """Return None: no files."""
        return None
