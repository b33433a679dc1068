"""What of a STEP file the library did not read or translate: named, never passed over in silence.

Open CASCADE goes on after most faults, and leaves out what it could not make.
"""

from __future__ import annotations

import re
from collections import defaultdict
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.step.refusal import StepError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

_LONGEST = 120
_AGAIN = "export it again, or as STL"
#: Packages of the library whose entities make, place or measure surface.
_SHAPING = ("StepShape_", "StepGeom_", "StepRepr_", "StepBasic_")
#: What of those packages says nothing about shape: dates, people, versions, properties.
_ADMINISTRATION = re.compile(
    r"StepBasic_(?!Product|.*Unit|.*Measure|Dimensional)"
    r"|StepBasic_Product.*(Category|Context)"
    r"|StepRepr_.*(Property|Material|Tolerance|ShapeAspect|Measure|Descriptive|Value)"
    r"|StepShape_.*(Dimension|Tolerance|Qualif|Limits|Precision|Qualifier)"
)
_FACE = re.compile(r"StepShape_(AdvancedFace|FaceSurface|Face)")
#: Entities that surface is made of and that translation binds to a shape each.
_SURFACE = re.compile(
    _FACE.pattern + r"|StepShape_(EdgeLoop|PolyLoop|ManifoldSolidBrep|BrepWithVoids|FacetedBrep\w*"
    r"|ShellBasedSurfaceModel|FaceBasedSurfaceModel|Csg\w+|\w+Solid|BooleanResult|Block|Sphere"
    r"|Torus|RightCircularC\w+|RightAngularWedge|SolidReplica|SolidModel)"
)
_SOLID = re.compile(r"StepShape_(ManifoldSolidBrep|BrepWithVoids|FacetedBrep\w*)")
_OTHER_SURFACE = re.compile(r"StepVisual_.*(Tessellated|Triangulated).*|StepShape_GeometricSet")
_SCALING = "StepGeom_CartesianTransformationOperator3d"
PLACED = "StepRepr_NextAssemblyUsageOccurrence"
#: A string, a comment, or a number of an entity with what may follow it.
_NUMBERS = re.compile(rb"'[^']*'|/\*.*?\*/|#(\d+)[ \t\r\n]*(=)?", re.DOTALL)
_ROOTS = re.compile(
    rb"=\s*\(?\s*(\w*SHAPE_REPRESENTATION|SHAPE_DEFINITION_REPRESENTATION"
    rb"|NEXT_ASSEMBLY_USAGE_OCCURRENCE)\b",
    re.IGNORECASE,
)


def makes_surface(entities: Iterable[Any]) -> bool:
    """Return whether any entity of a file is of a class that makes surface."""
    names = {entity.DynamicType().Name() for entity in entities}
    return any(_SURFACE.fullmatch(name) or _OTHER_SURFACE.fullmatch(name) for name in names)


def _scales(operator: Any) -> bool:
    """Return whether an operator does more than turn and shift."""
    if operator.HasScale() and operator.Scale() != 1.0:
        return True
    axes = [operator.Axis1(), operator.Axis2(), operator.Axis3()]
    if any(axis is None or axis.NbDirectionRatios() != 3 for axis in axes):
        return False  # what is left out completes a right-handed system
    x, y, z = ([axis.DirectionRatiosValue(k) for k in (1, 2, 3)] for axis in axes)
    return bool(np.dot(np.cross(x, y), z) < 0.0)


def is_solid(entity: Any) -> bool:
    """Return whether an entity is a solid with faces of its own."""
    return bool(_SOLID.fullmatch(entity.DynamicType().Name()))


def refuse_unread(model: Any, entities: Sequence[Any], data: bytes) -> None:
    """Refuse a file in which an entity that makes, places or measures surface was not understood.

    Raises:
        StepError: there is one.
    """
    for place, entity in enumerate(entities):
        name = entity.DynamicType().Name()
        if name == _SCALING and _scales(entity) and _used(data, len(entities), [place]):
            fault = "scales or mirrors a shape, which Open CASCADE does not do rightly"
            raise StepError(f"{_words(name)} {fault}", _AGAIN, _label(data, len(entities), place))
        if not model.IsErrorEntity(place + 1):
            continue
        if name.startswith(_SHAPING) and not _ADMINISTRATION.fullmatch(name):
            check = model.ReportEntity(place + 1).Check()
            why = str(check.CFail(1)) if check.NbFails() else "it is damaged"
            fault = f"holds {_words(name)} that cannot be read: {_printable(why)}"
            raise StepError(fault, _AGAIN, _label(data, len(entities), place))


def refuse_losses(process: Any, entities: Sequence[Any], data: bytes) -> int:
    """Refuse a file of which a face, loop, solid or instance became no shape.

    Args:
        process: of the translation.
        entities: of the file, in its order.
        data: the file.

    Returns:
        How many entities became faces.

    Raises:
        StepError: there is one that some representation uses.
    """
    places = {id(entity): place for place, entity in enumerate(entities)}
    made = set()
    for k in range(1, process.NbMapped() + 1):
        mapped, binder = process.Mapped(k), process.MapItem(k)
        place = places.get(id(mapped))
        if place is None or binder is None or not binder.HasResult():
            continue
        made.add(place)
    lost = [
        place
        for place, entity in enumerate(entities)
        if place not in made and _is_bound(entity.DynamicType().Name())
    ]
    used = _used(data, len(entities), lost) if lost else []
    if used:
        name = _words(entities[used[0]].DynamicType().Name())
        count = "" if len(used) == 1 else f", the first of {len(used):,}"
        fault = f"{name} cannot be made{count}: it would be lost"
        raise StepError(fault, _AGAIN, _label(data, len(entities), used[0]))
    return sum(bool(_FACE.fullmatch(entities[place].DynamicType().Name())) for place in made)


def _is_bound(name: str) -> bool:
    """Return whether translation gives every entity of a class a shape or a place."""
    return name == PLACED or ("Oriented" not in name and bool(_SURFACE.fullmatch(name)))


def _words(name: str) -> str:
    """Return the name of the library's class as the standard spells that of the entity."""
    bare = name.partition("_")[2]
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[a-z])(?=[23]d$)", "_", bare).upper()


def _printable(text: str) -> str:
    """Return what the library says of an entity, in short."""
    text = re.sub(r"n0\.(?=\d)", "", text)
    return "".join(letter if letter.isprintable() else "?" for letter in text)[:_LONGEST]


def _ids(data: bytes) -> list[bytes]:
    """Return the numbers of the entities, in the file's order."""
    return [found[1] for found in _NUMBERS.finditer(data) if found[2]]


def _label(data: bytes, count: int, place: int) -> str:
    """Return what the file calls an entity; empty where its numbers do not tell."""
    ids = _ids(data)
    return f"#{ids[place].decode()}" if len(ids) == count else ""


def _used(data: bytes, count: int, places: Iterable[int]) -> list[int]:
    """Return which entities some shape representation or assembly leads to.

    All of them where the numbers of the file do not tell.
    """
    places = list(places)
    ids = _ids(data)
    if len(ids) != count or len(set(ids)) != count:
        return places
    users = defaultdict(list)
    roots = set()
    current = b""
    for found in _NUMBERS.finditer(data):
        if found[2]:
            current = found[1]
            if _ROOTS.match(data, found.end() - 1):
                roots.add(current)
        elif found[1]:
            users[found[1]].append(current)
    return [place for place in places if _leads_to(ids[place], users, roots)]


def _leads_to(entity: bytes, users: dict[bytes, list[bytes]], roots: set[bytes]) -> bool:
    seen, pending = {entity}, [entity]
    while pending:
        here = pending.pop()
        if here in roots:
            return True
        for user in users.get(here, ()):
            if user not in seen:
                seen.add(user)
                pending.append(user)
    return False
