"""Those who are measured, behind one face: ours, python-fcl, coal and VTK, imported when asked for.

Peers get their best: models, requests and results are made once and reused, no contact data is
asked for where a yes or no will do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from meshes.surfaces import Surface
    from numpy.typing import NDArray
    from scenes.pairs import Pair

# More contacts than any scene here has, as the peers want a limit.
MANY_CONTACTS = 10_000_000


@dataclass(frozen=True)
class Query:
    """A posed pair, ready to be asked.

    Attributes:
        collides: any contact?
        triangle_pairs: every intersecting pair, int64 (N, 2), sorted, each once.
        counts: what one yes-or-no cost in tests; the peers' Python faces do not say.
        moved: B is put where it is anew, from two arrays, and then: any contact? None where it was
            not written.
    """

    collides: Callable[[], bool]
    triangle_pairs: Callable[[], NDArray[np.int64]]
    counts: Callable[[], dict[str, object]]
    moved: Callable[[], bool] | None = None


class Contestant(Protocol):
    """A library that builds trees over surfaces and asks them."""

    name: str

    def build(self, surface: Surface) -> Any:
        """Return the whole tree of a surface."""
        ...

    def query(self, model_a: Any, model_b: Any, pair: Pair) -> Query:
        """Return the question of `pair` to two built models."""
        ...

    def nbytes(self, model: Any) -> int | None:
        """Return the memory the model says it takes, or None where it does not say."""
        ...

    def save(self, model: Any, path: Path) -> int | None:
        """Return the size of the model's file, or None where there is no such thing."""
        ...


def unique_pairs(found: Any) -> NDArray[np.int64]:
    """Return pairs sorted, each once."""
    pairs = np.array(list(found), dtype=np.int64).reshape(-1, 2)
    return np.unique(pairs, axis=0)


def _arrays(pair: Pair) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return where B is, as two contiguous arrays of doubles."""
    return (
        np.ascontiguousarray(pair.rotation, dtype=np.float64),
        np.ascontiguousarray(pair.translation, dtype=np.float64),
    )


class Obbtree:
    """The package in this repository."""

    name = "obbtree"

    def build(self, surface: Surface) -> Any:
        """Return a whole `ObbTree`; the mesh's own checks are part of it."""
        import obbcli

        mesh = obbcli.Mesh(surface.vertices, surface.faces)
        return obbcli.ObbTree.build(mesh, lazy=False)

    def query(self, model_a: Any, model_b: Any, pair: Pair) -> Query:
        """Ask `collide` and `triangle_pairs` of two bodies."""
        import obbcli

        pose = obbcli.Pose(rotation=pair.rotation, translation=pair.translation)
        a, b = obbcli.Body(model_a), obbcli.Body(model_b, pose=pose)

        rotation, translation = _arrays(pair)

        def moved() -> bool:
            there = obbcli.Body(model_b, obbcli.Pose(rotation, translation))
            return obbcli.collide(a, there).collides

        def counts() -> dict[str, object]:
            stats = obbcli.collide(a, b).stats
            return {"box tests": stats.box_tests, "triangle tests": stats.triangle_tests}

        return Query(
            collides=lambda: obbcli.collide(a, b).collides,
            triangle_pairs=lambda: obbcli.triangle_pairs(a, b),
            counts=counts,
            moved=moved,
        )

    def nbytes(self, model: Any) -> int | None:
        """Return what the tree and its triangles take."""
        return int(model.nbytes)

    def save(self, model: Any, path: Path) -> int | None:
        """Return the size of the tree file."""
        model.save(path)
        return path.stat().st_size


class Fcl:
    """python-fcl: an OBBRSS tree; its Python face tells neither memory nor counts."""

    name = "python-fcl"

    def build(self, surface: Surface) -> Any:
        """Return a `BVHModel`."""
        import fcl

        model = fcl.BVHModel()
        model.beginModel(len(surface.faces), len(surface.vertices))
        model.addSubModel(surface.vertices, surface.faces)
        model.endModel()
        return model

    def query(self, model_a: Any, model_b: Any, pair: Pair) -> Query:
        """Ask `fcl.collide`; contacts are the triangles' numbers only."""
        import fcl

        a = fcl.CollisionObject(model_a, fcl.Transform())
        b = fcl.CollisionObject(model_b, fcl.Transform(pair.rotation, pair.translation))
        one = fcl.CollisionRequest(num_max_contacts=1, enable_contact=False)
        many = fcl.CollisionRequest(num_max_contacts=MANY_CONTACTS, enable_contact=False)

        def triangle_pairs() -> NDArray[np.int64]:
            result = fcl.CollisionResult()
            fcl.collide(a, b, many, result)
            return unique_pairs((contact.b1, contact.b2) for contact in result.contacts)

        rotation, translation = _arrays(pair)

        def moved() -> bool:
            b.setTransform(fcl.Transform(rotation, translation))
            return bool(fcl.collide(a, b, one, fcl.CollisionResult()) > 0)

        return Query(
            collides=lambda: fcl.collide(a, b, one, fcl.CollisionResult()) > 0,
            triangle_pairs=triangle_pairs,
            counts=dict,
            moved=moved,
        )

    def nbytes(self, model: Any) -> int | None:  # noqa: ARG002
        """Return None: it does not say."""
        return None

    def save(self, model: Any, path: Path) -> int | None:  # noqa: ARG002
        """Return None: no files."""
        return None


class Coal:
    """coal, formerly hpp-fcl: an OBB tree."""

    name = "coal"

    model = "BVHModelOBB"

    def build(self, surface: Surface) -> Any:
        """Return such a model."""
        import coal

        model = getattr(coal, self.model)()
        model.beginModel(len(surface.faces), len(surface.vertices))
        model.addVertices(surface.vertices)
        model.addTriangles(surface.faces)
        model.endModel()
        return model

    def query(self, model_a: Any, model_b: Any, pair: Pair) -> Query:
        """Ask `coal.collide`."""
        import coal

        rest = coal.Transform3s()
        posed = coal.Transform3s(pair.rotation, pair.translation)
        one, many = coal.CollisionRequest(), coal.CollisionRequest()
        one.num_max_contacts, many.num_max_contacts = 1, MANY_CONTACTS
        one.enable_contact = many.enable_contact = False
        result = coal.CollisionResult()

        def ask(request: Any) -> bool:
            result.clear()
            return bool(coal.collide(model_a, rest, model_b, posed, request, result) > 0)

        def triangle_pairs() -> NDArray[np.int64]:
            ask(many)
            contacts = map(result.getContact, range(result.numContacts()))
            return unique_pairs((contact.b1, contact.b2) for contact in contacts)

        rotation, translation = _arrays(pair)

        def moved() -> bool:
            result.clear()
            there = coal.Transform3s(rotation, translation)
            return bool(coal.collide(model_a, rest, model_b, there, one, result) > 0)

        return Query(
            collides=lambda: ask(one), triangle_pairs=triangle_pairs, counts=dict, moved=moved
        )

    def nbytes(self, model: Any) -> int | None:
        """Return what the model reports."""
        return int(model.memUsage(False))

    def save(self, model: Any, path: Path) -> int | None:
        """Return the size of its binary file."""
        model.saveToBinary(str(path))
        return path.stat().st_size


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


CONTESTANTS: tuple[Contestant, ...] = (Obbtree(), Fcl(), Coal(), Vtk())
