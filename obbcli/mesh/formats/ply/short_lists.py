"""Lists of a binary PLY whose lengths are a byte each: faces of all kinds in one go."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.ply.header import Element

    #: Values end to end, the length of each list, and where the last one ends.
    Lists = tuple[NDArray[Any], NDArray[np.int64], int]


def short_lists(data: bytes, element: Element, position: int) -> Lists | None:
    """Return the lists of an element that has nothing else; None where its reader must look.

    Args:
        data: the file.
        element: with rows.
        position: where its first list begins.
    """
    prop = element.properties[0]
    if len(element.properties) > 1 or prop.count_kind is None or prop.count_kind.itemsize > 1:
        return None
    size = prop.kind.itemsize
    starts, end = [], position
    try:
        for _ in range(element.count):
            starts.append(end)
            end += 1 + size * data[end]
    except IndexError:
        return None
    if end > len(data):
        return None
    found = np.frombuffer(data, np.uint8, end - position, position)
    places = np.array(starts) - position
    lengths = found[places].astype(np.int64)
    if prop.count_kind.kind == "i" and lengths.max() > 127:
        return None  # a negative one
    is_value = np.ones(len(found), bool)
    is_value[places] = False
    return found[is_value].view(prop.kind), lengths, end
