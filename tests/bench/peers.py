"""Those who are measured, behind one face: ours, python-fcl, coal and VTK, imported when asked for.

Peers get their best: models, requests and results are made once and reused, no contact data is
asked for where a yes or no will do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from contestant import MANY_CONTACTS, Contestant, Query, arrays_of, unique_pairs
from vtk_peer import Vtk

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from meshes.surfaces import Surface
    from numpy.typing import NDArray
    from scenes.pairs import Pair


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

        rotation, translation = arrays_of(pair)

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

        rotation, translation = arrays_of(pair)

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

        rotation, translation = arrays_of(pair)

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


CONTESTANTS: tuple[Contestant, ...] = (Obbtree(), Fcl(), Coal(), Vtk())
