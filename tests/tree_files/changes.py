"""Trees as arrays, changed where no builder would."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from oracles import tree_files as tree_oracles
from oracles.tree_files import NODE

from obbcli import Mesh, ObbTree, TreeFileError
from obbcli.tree.whole import WholeTree

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from obbcli.tree.whole import TreeArrays


def arrays_of(surface: Any, **options: Any) -> TreeArrays:
    return ObbTree.build(Mesh(*surface), **options)._arrays


def _aligned(nodes: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return a copy that begins where the kernels want it to."""
    raw = np.empty(nodes.size + 64, np.uint8)
    start = -raw.ctypes.data % 64
    copy = raw[start : start + nodes.size].reshape(nodes.shape)
    copy[:] = nodes
    return copy


def with_nodes(arrays: TreeArrays, change: Callable[[Any], None]) -> TreeArrays:
    """Return the arrays with their boxes changed in a copy."""
    nodes = _aligned(arrays.nodes)
    change(nodes.view(NODE).reshape(-1))
    return replace(arrays, nodes=nodes)


def as_read(arrays: TreeArrays) -> tree_oracles.TreeFile:
    return tree_oracles.TreeFile(
        description={
            "leaf_size": arrays.description.leaf_size,
            "max_depth": arrays.description.max_depth,
        },
        scale_exponent=arrays.scale_exponent,
        nodes=arrays.nodes.view(NODE).reshape(-1),
        corners=arrays.corners,
        triangle_ids=arrays.triangle_ids,
        vertices=arrays.vertices,
    )


def refuses(arrays: TreeArrays, match: str) -> None:
    with pytest.raises(TreeFileError, match=match):
        ObbTree(WholeTree(arrays)).check()


def set_field(name: str, slot: int, value: Any) -> Callable[[Any], None]:
    def change(nodes: Any) -> None:
        nodes[name][slot] = value

    return change


def inner_slot(arrays: TreeArrays) -> int:
    """Return the slot of a box below the root with two boxes below it."""
    for visit in tree_oracles.walk(as_read(arrays)):
        if visit.slot and not visit.is_leaf:
            node = as_read(arrays).nodes[visit.slot]
            if visit.begin + 1 < node["split"] < visit.end - 1:
                return visit.slot
    raise AssertionError("no such box")
