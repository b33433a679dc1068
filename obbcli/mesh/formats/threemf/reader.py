"""3MF, read by a reader of our own from the specification (core 1.3, production 1.1).

trimesh takes objects of the production extension twice where components name them. Only what makes
and places surface is read: materials, textures and thumbnails are passed over.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from obbcli.mesh.formats.gltf.nodes import composed
from obbcli.mesh.formats.safe_xml import XmlStream
from obbcli.mesh.formats.text import counted, shown
from obbcli.mesh.formats.threemf.archive import Archive
from obbcli.mesh.formats.threemf.walk import walked
from obbcli.mesh.parts.placed import PlacedPart, UniquePaths, joined
from obbcli.mesh.parts.selection import MOST_PARTS

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from obbcli.mesh.formats.threemf.model import Model, Object, Placement
    from obbcli.mesh.source import MeshArrays, Source

_LINKS = "_rels/.rels"
_USUAL = "3D/3dmodel.model"
_MODEL = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
#: Components that stand in one another.
_DEEPEST = 100


def read_threemf(source: Source) -> MeshArrays:
    """Return vertices and triangles of what the build places, items in the file's order.

    Components are taken depth first in their order, each object's rows as they stand; matrices are
    applied in double precision, and a mirrored object's triangles are turned over. Objects that no
    item places are no part of the file's shape; supports are.

    Raises:
        MeshError: no whole archive, no whole XML, a required extension that is not read, objects
            that are missing or hold themselves, indices out of range, words that are no numbers.
    """
    return joined((part.placed() for part in parts_threemf(source)), source, "items")


def parts_threemf(source: Source) -> Iterator[PlacedPart]:
    """Yield what the build places: each mesh, by the names of the objects from the item down.

    Raises:
        MeshError: as `read_threemf`.
    """
    package = _Package(source)
    root = package.model(package.root(), "")
    source.state_unit(root.unit)
    shown_objects: set[int] = set()
    paths = UniquePaths()
    pending = [_Visit(root, item, None, None, 1) for item in reversed(root.items)]
    visits = 0
    while pending:
        visit = pending.pop()
        visits += 1
        if visits > MOST_PARTS:
            raise source.error(f"places more than {MOST_PARTS} objects", "split the file")
        model, found = package.object(visit)
        shown_objects.add(id(found))
        path = _path(found, visit.outer)
        matrix = composed(visit.matrix, visit.placement.matrix)
        if found.name or found.corners:
            path = paths.take(path or "")
        if found.corners:
            yield PlacedPart(path or "", id(found), found.decode, matrix)
        outer = path if found.name else visit.outer
        pending += [
            _Visit(model, each, matrix, outer, visit.depth + 1)
            for each in reversed(found.components)
        ]
    package.tell(shown_objects)


def _path(found: Object, outer: str | None) -> str | None:
    """Return the names from the item down; an object of components without a name adds none."""
    if outer is None or not (found.name or found.corners):
        return found.name if outer is None else outer
    return f"{outer}/{found.name}"


class _Visit(NamedTuple):
    """One placement on the way from an item down to a mesh."""

    model: Model
    placement: Placement
    matrix: NDArray[np.float64] | None
    outer: str | None
    depth: int


class _Package:
    """Gives the models of a package, each walked once."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._archive = Archive(source)
        self._models: dict[str, Model] = {}

    def root(self) -> str:
        """Return the name of the model part that the package shows."""
        if _LINKS not in self._archive:
            if _USUAL not in self._archive:
                fault = "is a zip archive, not a mesh"
                raise self._source.error(fault, "unpack it and name the mesh inside")
            self._source.note(f"says not which model it shows: {_USUAL} is taken")
            return _USUAL
        targets: list[str] = []

        def start(_: str, attributes: dict[str, str]) -> None:
            if attributes.get("Type") == _MODEL:
                targets.append(attributes.get("Target", ""))

        stream = XmlStream(self._source, _LINKS)
        stream.run(self._archive.pieces(_LINKS), start, lambda _: None)
        if len(targets) != 1:
            fault = f"names {counted(len(targets), 'model')}, expected one"
            raise self._source.error(fault, "export it again", at=_LINKS)
        return self._archive.name_of(targets[0], _LINKS)

    def model(self, part: str, at: str) -> Model:
        """Return a model part; all parts must have one unit."""
        key = part.lower()
        if key not in self._models:
            model = walked(self._source, self._archive, part, at)
            first = next(iter(self._models.values()), model)
            if model.unit != first.unit:
                fault = f"is in {model.unit}, but {first.part} in {first.unit}"
                raise self._source.error(fault, "export it in one unit", at=part)
            self._models[key] = model
        return self._models[key]

    def object(self, visit: _Visit) -> tuple[Model, Object]:
        """Return the object that is placed, and the model that holds it."""
        placement = visit.placement
        at = f"{visit.model.part}, line {placement.line}"
        model = self.model(placement.part, at) if placement.part else visit.model
        found = model.objects.get(placement.object_id)
        name = f"object {shown(placement.object_id.encode())}"
        if found is None:
            raise self._source.error(f"places {name}, which is not there", "export it again", at=at)
        if visit.depth > _DEEPEST:
            fault = f"{name} holds itself, or components nest deeper than {_DEEPEST}"
            raise self._source.error(fault, "export it again", at=at)
        if found.unread is not None:
            fault, line = f"{name} has a <{shown(found.unread[0].encode())}>", found.unread[1]
            remedy = "which is not read: export plain meshes"
            raise self._source.error(fault, remedy, at=f"{model.part}, line {line}")
        if visit.depth == 1 and found.kind == "other":
            fault = f"places {name}, whose type 'other' is not to be placed"
            raise self._source.error(fault, "export it again", at=at)
        if not found.corners and not found.components:
            fault = f"{name} has neither triangles nor components"
            raise self._source.error(
                fault, "export it again", at=f"{model.part}, line {found.line}"
            )
        if found.kind in ("support", "solidsupport"):
            self._source.note("objects that are supports are taken as well")
        return model, found

    def tell(self, taken: set[int]) -> None:
        """Note how many objects nothing places."""
        every = [id(each) for model in self._models.values() for each in model.objects.values()]
        left = sum(each not in taken for each in every)
        if left:
            self._source.note(f"{left} of {len(every)} objects stand in no item of the build")
