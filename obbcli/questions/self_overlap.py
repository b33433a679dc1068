"""Does a closed surface wind about any space more than once, or the other way: `self_overlap`."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from obbcli import kernels
from obbcli.motion.pose import Pose
from obbcli.questions.border import refused
from obbcli.tree.tree import ObbTree

if TYPE_CHECKING:
    from obbcli.mesh import Mesh

    Bounds = tuple[float, float]

ROUNDING = 1e-9
"""Of the volume: a surface whose excess is proven to be less counts as that of a simple solid."""
# Pairs of nodes between two looks at signals: some milliseconds.
_POPS_A_SLICE = 4096


class SelfOverlap(NamedTuple):
    """How much of the space a closed surface winds about otherwise than once.

    With w the number of times that it winds about a place, turned so that the volume is positive.

    Attributes:
        overlaps_itself: whether the surface is proven to wind about some space more than once, or
            the other way. False: about less than 1e-9 of its volume, by proof. None: rounding
            leaves it open.
        volume: the integral of w, mesh units to the third power, as a proven bracket; negative
            where the surface is turned inward.
        excess: the integral of w^2 - w, a proven bracket. At most half as much space is wound about
            otherwise than once.
    """

    overlaps_itself: bool | None
    volume: Bounds
    excess: Bounds


def self_overlap(shape: Mesh | ObbTree) -> SelfOverlap:
    """Return whether a closed surface overlaps itself, and its volume.

    Sums over pairs of its triangles that lie over each other along an axis: about half a second for
    100,000 triangles.

    Args:
        shape: a watertight mesh, or the tree of one.

    Raises:
        TreeFileError: a tree file is damaged.
    """
    tree = shape if isinstance(shape, ObbTree) else ObbTree.build(shape)
    try:
        query = kernels.SelfOverlap(tree.kernel, Pose().kernel)
        while not query.advance(_POPS_A_SLICE):
            pass
    except kernels.TreeError as fault:
        raise refused((tree, tree), fault) from fault
    return SelfOverlap(_verdict(query.volume, query.excess), query.volume, query.excess)


def _verdict(volume: Bounds, excess: Bounds) -> bool | None:
    """Return whether there is an excess; None where rounding leaves it open."""
    if excess[0] > 0:
        return True
    least = max(volume[0], -volume[1], 0.0)
    return False if excess[1] <= ROUNDING * least else None
