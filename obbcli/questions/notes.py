"""`notes`: what of two shapes was taken with a change, and what of their units may be mistaken."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from obbcli.mesh import Mesh
from obbcli.motion.body import as_body
from obbcli.questions.pair_question import check_units, surface_of

if TYPE_CHECKING:
    from obbcli.motion.body import Body, Shape
    from obbcli.tree.tree import ObbTree

    Measured: TypeAlias = Mesh | ObbTree

#: Sizes that are further apart are more often a mistake of units than meant.
ODD_SIZES = 500.0
# Of a quotient of sizes, whose roundings are some 2^-50.
_ROUNDING = 1.0 + 2.0**-40
_REMEDY = "Mesh.in_unit, Mesh.scaled"


def notes(a: Body | Shape, b: Body | Shape) -> tuple[str, ...]:
    """Return what is to be known of two shapes before answers about them are trusted.

    That is what of their files was taken with a change (`Mesh.notes`), that one states a unit of
    length and the other none, and that their sizes are more than 500 apart: as the notes of the
    command line's tables. A question itself does not look for them, which would cost more than
    many an answer; shapes that state different units it refuses.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.

    Returns:
        a sentence each, after the name of the shape that it is about: `"A: ..."`. Sizes are those
        of the shapes as they are, whatever their poses.

    Raises:
        MeshError: a mesh cannot be read or is refused, or the two state different units.
        MotionError: a shape is of another kind.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.

    Example:
        >>> notes("sample_meshes/gear.stl", "sample_meshes/gripper_palm.glb")
        ('A: states no unit of length, B is in m: see Mesh.in_unit, Mesh.scaled',)
    """
    shapes = surface_of(as_body(a).shape), surface_of(as_body(b).shape)
    check_units({"A": shapes[0].unit, "B": shapes[1].unit})
    more = unit_notes(shapes, _REMEDY)
    return tuple(
        f"{name}: {text}"
        for name, shape, own in zip("AB", shapes, more, strict=True)
        for text in (*shape.notes, *own)
    )


def unit_notes(
    shapes: tuple[Measured, Measured], remedy: str
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return what of the units of A and B may be mistaken, a sentence each.

    Args:
        shapes: A and B.
        remedy: what to look at, which is not the same on the command line and in Python.
    """
    told: tuple[list[str], list[str]] = ([], [])
    a, b = shapes
    if (a.unit is None) != (b.unit is None):
        unit, place = a.unit or b.unit, 0 if a.unit is None else 1
        other = "BA"[place]
        told[place].append(f"states no unit of length, {other} is in {unit}: see {remedy}")
    if not _are_of_like_size(shapes):
        sizes = [a.size, b.size]
        small, large = min(sizes), max(sizes)
        if small > 0 and large / small > ODD_SIZES:
            place = sizes.index(large)
            times = f"{large / small:,.0f} times the size of {'BA'[place]}"
            told[place].append(f"is {times}: is one of them in another unit? See {remedy}")
    return tuple(told[0]), tuple(told[1])


def _are_of_like_size(shapes: tuple[Measured, Measured]) -> bool:
    """Return whether sizes are proven to be near each other, without a pass over the surfaces."""
    bounds = [
        (shape.size, shape.size) if isinstance(shape, Mesh) else shape.size_bounds()
        for shape in shapes
    ]
    least, most = min(low for low, _ in bounds), max(high for _, high in bounds)
    return most * _ROUNDING <= ODD_SIZES * least
