"""What a COLLADA document's scene shows: geometries by the names and places of nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from obbcli.mesh.formats.collada.transforms import local_matrix
from obbcli.mesh.formats.gltf.nodes import composed
from obbcli.mesh.parts.placed import UniquePaths
from obbcli.mesh.parts.selection import MOST_PARTS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.mesh.formats.collada.document import Document
    from obbcli.mesh.formats.collada.transforms import Matrix
    from obbcli.mesh.formats.safe_xml import Element

#: Instances of nodes that stand in one another.
_DEEPEST = 100


class Shown(NamedTuple):
    """Holds a geometry that is shown.

    Attributes:
        geometry: the element.
        path: names of the nodes from the root down.
        matrix: from the geometry's coordinates, or the skin's, to the world's.
        skin: the element, where it is shown through one.
    """

    geometry: Element
    path: str
    matrix: Matrix
    skin: Element | None = None


class _Visit(NamedTuple):
    """A node on the way from the scene down: where its parent stands, and how that is called."""

    node: Element
    outer: Matrix
    path: str | None
    instances: int


def shown_parts(document: Document) -> Iterator[Shown]:
    """Yield what the scene shows; a document without visual scenes shows its geometries.

    Raises:
        MeshError: links that lead nowhere, nodes that hold themselves, transforms that are none.
    """
    paths = UniquePaths()
    scene = _scene(document)
    if scene is None:
        document.source.note("has no scene: its geometries are taken where they were modelled")
        for library in document.root.named("library_geometries"):
            for geometry in library.named("geometry"):
                yield Shown(geometry, paths.take(_name(geometry)), document.world)
        return
    left = MOST_PARTS
    pending = [
        _Visit(node, document.world, None, 0) for node in reversed(list(scene.named("node")))
    ]
    while pending:
        visit = pending.pop()
        left -= 1
        if left < 0:
            raise document.source.error(f"shows more than {MOST_PARTS} nodes", "split the file")
        matrix = composed(visit.outer, local_matrix(document.values, visit.node))
        shown = list(_instances(document, visit.node, matrix))
        name = _name(visit.node)
        if not name and shown:
            name = _name(shown[0].geometry)
        path = visit.path
        if name or shown:
            joined = name if visit.path is None else f"{visit.path}/{name}"
            path = paths.take(joined)
            for number, each in enumerate(shown):
                yield each._replace(path=path if number == 0 else paths.take(joined))
        inner = path if name else visit.path
        pending += reversed(list(_inside(document, visit, matrix, inner)))


def _inside(
    document: Document, visit: _Visit, matrix: Matrix, path: str | None
) -> Iterator[_Visit]:
    """Yield the nodes in a node, and those that it has instances of."""
    for each in visit.node.named("node", "instance_node"):
        if each.name == "node":
            yield _Visit(each, matrix, path, visit.instances)
            continue
        if visit.instances >= _DEEPEST:
            fault = f"a node holds itself, or instances nest deeper than {_DEEPEST}"
            raise document.values.error(each, fault)
        node = document.linked(each, "url", "node")
        yield _Visit(node, matrix, path, visit.instances + 1)


def _scene(document: Document) -> Element | None:
    """Return the visual scene that counts, None where there is none."""
    scene = document.root.first("scene")
    instance = None if scene is None else scene.first("instance_visual_scene")
    if instance is not None:
        return document.linked(instance, "url", "visual_scene")
    libraries = document.root.named("library_visual_scenes")
    scenes = [each for library in libraries for each in library.named("visual_scene")]
    if len(scenes) > 1:
        fault = f"has {len(scenes)} visual scenes, and no <scene> that says which is shown"
        raise document.source.error(fault, "name one in <scene>")
    if scenes:
        document.source.note("has no <scene>: its one visual scene is taken")
    return scenes[0] if scenes else None


def _instances(document: Document, node: Element, matrix: Matrix) -> Iterator[Shown]:
    """Yield the geometries that a node shows itself."""
    for each in node.named("instance_geometry", "instance_controller"):
        if each.name == "instance_geometry":
            yield Shown(document.linked(each, "url", "geometry"), "", matrix)
        else:
            controller = document.linked(each, "url", "controller")
            yield _controlled(document, controller, matrix)


def _controlled(document: Document, controller: Element, matrix: Matrix) -> Shown:
    """Return the geometry that a controller moves: a skin in its bind shape, a morph at rest."""
    skin, morph = controller.first("skin"), controller.first("morph")
    if skin is not None:
        # The joints place a skin, and not its node.
        document.source.note("skins stand in their bind shape: their joints are not applied")
        found = document.linked(skin, "source", "geometry", "controller")
        if found.name == "controller":
            found = _rested(document, found)
        return Shown(found, "", document.world, skin)
    if morph is None:
        raise document.values.error(controller, "<controller> has neither <skin> nor <morph>")
    return Shown(_rested(document, controller), "", matrix)


def _rested(document: Document, controller: Element) -> Element:
    """Return the geometry of a morph whose weights are all zero."""
    morph = controller.first("morph")
    if morph is None:
        raise document.values.error(controller, "<controller> moves another skin")
    targets = morph.first("targets")
    for each in () if targets is None else targets.named("input"):
        if each.get("semantic") != "MORPH_WEIGHT":
            continue
        weights = document.linked(each, "source", "source").first("float_array")
        if weights is None or document.values.numbers(weights).any():
            remedy = "apply the morph on export"
            raise document.values.error(morph, "<morph> has weights, which is not read", remedy)
    return document.linked(morph, "source", "geometry")


def _name(element: Element) -> str:
    """Return how an element is called: its name, else its id."""
    return element.get("name") or element.get("id")
