"""STEP (AP203, AP214, AP242), through Open CASCADE (the package `OCP`) in a process of its own.

Its other light package, cascadio, gives float32 in metres, copies of the mesh for each instance,
and an empty file in silence.
"""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.gltf.nodes import composed
from obbcli.mesh.formats.step.process import StepProcess
from obbcli.mesh.formats.text import counted
from obbcli.mesh.parts.placed import PlacedPart, UniquePaths, joined

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.formats.step.process import Cut
    from obbcli.mesh.source import MeshArrays, Source

_END = re.compile(rb"END-ISO-10303-21\s*;")
#: What may follow the end: white space, and signatures of the third edition.
_TAIL_BYTES = 1 << 16


def read_step(source: Source) -> MeshArrays:
    """Return vertices and triangles of what a STEP file places, in the file's unit.

    Instances are taken depth first in the file's order, of each product its faces in order. Faces
    are cut so that triangles are within `source.sag` of them; None for 1e-3 of each product's size.

    Raises:
        MeshError: the package is missing, the file is damaged or has no faces, something of it
            would be lost, a face cannot be cut within the sag.
    """
    return joined((part.placed() for part in parts_step(source)), source, "instances")


def parts_step(source: Source) -> Iterator[PlacedPart]:
    """Yield the instances of products with faces, by their names from the root down.

    Raises:
        MeshError: as `read_step`; what is wrong with a product's faces, when it is decoded.
    """
    if not _END.search(source.data, max(0, len(source.data) - _TAIL_BYTES)):
        fault = "does not end with END-ISO-10303-21: it was cut short"
        raise source.error(fault, "copy or download it again")
    products = _Products(source)
    about = products.about
    if about["unit"] is not None:
        source.state_unit(about["unit"])
    for note in about["notes"]:
        source.note(note)
    paths = UniquePaths()
    # Of assemblies, which a part without a name may have.
    unused: set[str | None] = set()
    outer: list[tuple[str | None, NDArray[np.float64] | None]] = [(None, None)]
    for depth, name, product, numbers in about["nodes"]:
        del outer[depth + 1 :]
        path, matrix = outer[depth]
        if name or (product is not None and path not in unused):
            path = paths.take("/".join(filter(None, (path, name))))
        inner = None if numbers is None else np.array(numbers).reshape(4, 4)
        placed = composed(matrix, inner)
        if product is not None:
            unused.discard(path)
            yield PlacedPart(path or "", product, partial(products.decode, product), placed)
        else:
            unused.add(path)
            outer.append((path, placed))


class _Products:
    """Gives the products of a file, each cut once, and tells of them."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._process = StepProcess(source)
        self.about = self._process.about
        self._cuts: dict[int, Cut] = {}
        self._told: set[int] = set()
        self._note = ""

    def decode(self, product: int) -> MeshArrays:
        """Return the vertices and triangles of a product."""
        if product not in self._cuts:
            self._cuts[product] = self._process.cut(product)
        self._tell(product)
        return self._cuts[product].arrays

    def _tell(self, product: int) -> None:
        """Keep one note on all that was cut since the notes of the file were set back."""
        notes = self._source.notes
        if self._note in notes:
            notes.remove(self._note)
        else:
            self._told.clear()
        self._told.add(product)
        cuts = [self._cuts[each] for each in self._told]
        sag = max(cut.sag for cut in cuts)
        faces = counted(sum(cut.face_count for cut in cuts), "exact face")
        count = counted(sum(len(cut.arrays[1]) for cut in cuts), "triangle")
        unit = f" {self._source.unit}" if self._source.unit else ""
        self._note = f"{faces} cut into {count} that are within {sag!r}{unit} of them (the sag)"
        notes.append(self._note)
        self._source.state_sag(sag)
        loose = sum(cut.open_edge_count for cut in cuts)
        if loose:
            self._source.note(f"its solids do not close at {counted(loose, 'edge')}")
