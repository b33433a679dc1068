"""Positions of a COLLADA mesh: arrays of numbers and the accessors that read them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.collada.document import Document
    from obbcli.mesh.formats.safe_xml import Element


def positions(document: Document, vertices: Element) -> NDArray[np.float64]:
    """Return the positions (V, 3) of an element `vertices`.

    Raises:
        MeshError: no positions, counts that do not fit, numbers that are none.
    """
    found = [each for each in vertices.named("input") if each.get("semantic") == "POSITION"]
    if len(found) != 1:
        fault = f"<vertices> has {len(found)} inputs of positions, expected one"
        raise document.values.error(vertices, fault)
    return _accessed(document, document.linked(found[0], "source", "source"))


def _accessed(document: Document, source: Element) -> NDArray[np.float64]:
    """Return the three columns that a source's accessor names."""
    values = document.values
    technique = source.first("technique_common")
    accessor = None if technique is None else technique.first("accessor")
    if accessor is None:
        raise values.error(source, "<source> has no <accessor>")
    array = document.linked(accessor, "source", "float_array")
    numbers = values.numbers(array)
    claimed = values.count(array, "count", len(numbers))
    if claimed != len(numbers):
        fault = f"<float_array> claims {claimed} numbers, and has {len(numbers)}"
        raise values.error(array, fault)
    count = values.count(accessor, "count")
    stride = values.count(accessor, "stride", 1)
    offset = values.count(accessor, "offset", 0)
    columns = _columns(document, accessor)
    if stride < 1 or max(columns) >= stride:
        fault = f"<accessor> has stride {stride}, less than the {max(columns) + 1} that it names"
        raise values.error(accessor, fault)
    if count and offset + (count - 1) * stride + max(columns) >= len(numbers):
        fault = f"<accessor> claims {count} points, more than the {len(numbers)} numbers hold"
        raise values.error(accessor, fault)
    starts = offset + stride * np.arange(count, dtype=np.int64)
    return np.asarray(numbers[starts[:, np.newaxis] + np.array(columns)])


def _columns(document: Document, accessor: Element) -> list[int]:
    """Return which numbers of each row are x, y and z; those without a name are passed over."""
    names = [each.get("name").upper() for each in accessor.named("param")]
    if {"X", "Y", "Z"} <= set(names):
        return [names.index(axis) for axis in "XYZ"]
    named = [place for place, name in enumerate(names) if name]
    if not any(names) and len(names) in (0, 3):
        return [0, 1, 2]
    if len(named) != 3:
        fault = f"<accessor> names {len(named)} numbers a point, expected 3"
        raise document.values.error(accessor, fault)
    return named
