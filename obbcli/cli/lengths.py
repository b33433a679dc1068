"""What options on lengths make of a mesh: unit, scale, weld, sag. Imported where one is given."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from obbcli.cli.boundary import UsageError
from obbcli.errors import MeshError
from obbcli.files import file_of

if TYPE_CHECKING:
    from typing import TypeAlias

    from obbcli.mesh import Mesh
    from obbcli.tree.tree import ObbTree

    _Pair: TypeAlias = "tuple[Lengths | None, Lengths | None]"


class Lengths(NamedTuple):
    """What becomes of a mesh's coordinates before anything is asked.

    Attributes:
        unit: that they are scaled to; None: of no matter.
        scale: by which they are multiplied, whatever unit the file states; None: by none.
        weld: the distance within which vertices become one, before they are scaled; None: none do.
        sag: how far triangles may be from exact surfaces, in the file's unit; None: the default.
        remarks: what is said of the file beside the notes of its mesh.
    """

    unit: str | None
    scale: float | None
    weld: float | None = None
    sag: float | None = None
    remarks: tuple[str, ...] = ()

    def measured(self, shape: Mesh | ObbTree, name: str) -> Mesh | ObbTree:
        """Return a shape welded, then in the unit or by the scale that is asked for.

        Raises:
            MeshError: a tree file is of another unit or sag, or would be scaled or welded, which
                its boxes do not allow; a coordinate leaves the range of double; vertices cannot be
                welded.
        """
        from obbcli.mesh import Mesh

        unit, scale, weld, sag, _ = self
        if isinstance(shape, Mesh):
            try:
                if weld is not None:
                    shape = shape.welded(weld)
                if scale is not None:
                    return shape.scaled(scale, unit)
                return shape if unit is None else shape.in_unit(unit)
            except MeshError as fault:
                raise MeshError(name, f"{fault.where}: {fault.fault}", fault.remedy) from fault
        source = shape.source or "MESH"
        if sag is not None and sag != shape.sag:
            remedy = f"build one: obbtree build {source} --sag {sag!r} -o FILE"
            found = "which was built of triangles" if shape.sag is None else f"of sag {shape.sag!r}"
            raise MeshError(name, f"is a tree file, {found}", remedy)
        if weld is not None:
            remedy = f"build one: obbtree build {source} --weld {weld!r} -o FILE"
            raise MeshError(name, "is a tree file, which is not welded", remedy)
        if scale is not None:
            remedy = f"build one: obbtree build {source} --scale {scale!r} -o FILE"
            raise MeshError(name, "is a tree file, which is not scaled", remedy)
        if unit is not None and shape.unit not in (None, unit):
            remedy = f"build one: obbtree build {source} --unit {unit} -o FILE"
            raise MeshError(name, f"is a tree in {shape.unit}, not {unit}", remedy)
        return shape


def shared_sag(names: tuple[str, str], lengths: _Pair) -> _Pair:
    """Return what becomes of A and B; one without exact surfaces is told so, and takes no sag.

    Raises:
        UsageError: a sag is given, and neither has.
        ObbError: one cannot be read.
    """
    a, b = lengths
    if a is None or b is None or a.sag is None:
        return lengths
    takes = tuple(map(_takes_sag, names))
    if not any(takes):
        fault = "cuts exact surfaces (STEP), and neither A nor B has any"
        raise UsageError("--sag", fault, "leave it out")
    note = f"has no exact surfaces, which --sag {a.sag!r} would cut"
    told_a, told_b = (own._replace(sag=None, remarks=(note,)) for own in (a, b))
    return a if takes[0] else told_a, b if takes[1] else told_b


def _takes_sag(name: str) -> bool:
    """Return whether a mesh file has exact surfaces, or a tree file was built of such.

    What a pipe brings is not known before it is read, and may.
    """
    from obbcli.mesh.sag import has_exact_surfaces
    from obbcli.tree.head import TreeHead
    from obbcli.tree.tree import begins_as_tree

    path = Path(file_of(name))
    if not path.is_file():
        return True
    if begins_as_tree(path):
        return TreeHead(path, verify=False).sag is not None
    return has_exact_surfaces(name)
